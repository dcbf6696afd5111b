//! Rooted points follow the head. \[Chen2011\] says nothing of them; a point of inverse mass 0 is what its §4.1 allows.

use strandline_base::par::prelude::*;
use strandline_body::Pose;

use super::Scratch;
use crate::{Model, State};
use strandline_base::vec3x8::{Rigid, Vec3x8, load, splat};

/// Carries the rooted points to where the head is at the end of the step; their velocity is what
/// takes them there. Writes the predicted positions and the velocities of rooted points only.
pub fn pose_roots(model: &Model, state: &mut State, scratch: &mut Scratch, world_from_head: &Pose) {
    let points = model.points_per_strand;
    let rigid = Rigid::new(world_from_head);
    let rate = splat(1.0 / model.settings.time_step);
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks(points))
        .enumerate()
        .with_min_len(16)
        .for_each(|(block, ((predicted, velocities), positions))| {
            for point in 0..points {
                let index = block * points + point;
                let rooted = load(&model.inverse_mass[index]).simd_eq(splat(0.0));
                if !rooted.any() {
                    continue;
                }
                let end = rigid.points(Vec3x8::load(&model.positions[index]));
                let velocity = (end - Vec3x8::load(&positions[point])) * rate;
                end.or(rooted, Vec3x8::load(&predicted[point])).store(&mut predicted[point]);
                velocity.or(rooted, Vec3x8::load(&velocities[point])).store(&mut velocities[point]);
            }
        });
}
