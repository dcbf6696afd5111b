//! Forces, then a prediction: v* = v + dt a, x* = x + dt (v* + c), with c the length pass's correction.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::Vec3x8;

use super::Scratch;
use super::fall::Fall;
use crate::strands::constrain::springs::{Elastic, Strand};
use crate::{Model, State};

/// Applies gravity, drag and the pull of springs to the velocities of free points and predicts their positions. `wind` is
/// the velocity of the air \[m/s\], world space.
pub fn integrate(model: &Model, state: &mut State, scratch: &mut Scratch, wind: Vec3) {
    let points = model.points_per_strand;
    let (lengths, masses) = (&state.lengths, &scratch.masses);
    let settings = &model.settings;
    let springs = Elastic::new(&settings.strands.constrain.springs, lengths, settings.time_step);
    let fall = Fall::new(model, wind);
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks(points).zip(state.corrections.par_chunks(points)))
        .enumerate()
        .with_min_len(16)
        .for_each_init(
            || vec![Vec3x8::ZERO; points],
            |kicks, (block, ((predicted, velocities), (positions, corrections)))| {
                let range = block * points..(block + 1) * points;
                let inverse_mass = &masses.inverse_mass[range.clone()];
                kicks.fill(Vec3x8::ZERO);
                springs.pull(&Strand { positions, velocities, inverse_mass }, range, kicks);
                fall.predict(positions, corrections, inverse_mass, kicks, velocities, predicted);
            },
        );
}
