//! Rooted points follow the skin. \[Chen2011\] says nothing of them; its §4.1 allows points of inverse mass 0.

use strandline_base::par::prelude::*;
use strandline_body::BodyFrame;

use super::Scratch;
use crate::{Model, State};
use strandline_base::vec3x8::{Rigid, RigidLanes, Vec3x8, load, splat};

/// Carries the rooted points to the root frames at the end of the step, with the velocity that leads there.
/// Writes the predicted positions and the velocities of rooted points only.
pub fn pose_roots(model: &Model, state: &mut State, scratch: &mut Scratch, body: &BodyFrame) {
    let points = model.points_per_strand;
    let head = RigidLanes::from(Rigid::new(&body.world_from_head()));
    let rate = splat(1.0 / model.settings.time_step);
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks(points))
        .enumerate()
        .with_min_len(16)
        .for_each(|(block, ((predicted, velocities), positions))| {
            let own = body.roots().map(|_| RigidLanes::new(&model.roots(body, block)));
            let world_from_root = own.as_ref().unwrap_or(&head);
            for point in 0..points {
                let index = block * points + point;
                let rooted = load(&model.inverse_mass[index]).simd_eq(splat(0.0));
                if !rooted.any() {
                    continue;
                }
                let end = world_from_root.points(Vec3x8::load(&model.positions[index]));
                let velocity = (end - Vec3x8::load(&positions[point])) * rate;
                end.or(rooted, Vec3x8::load(&predicted[point])).store(&mut predicted[point]);
                velocity.or(rooted, Vec3x8::load(&velocities[point])).store(&mut velocities[point]);
            }
        });
}
