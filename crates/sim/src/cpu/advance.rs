//! x <- x*, and what the step was worth.

use rayon::prelude::*;
use strandline_body::Pose;
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use super::Obstacles;
use super::constrain::live_lanes;
use super::contacts::{Plane, Solids};
use super::vec3x8::{Vec3x8, load, splat};
use crate::{Solver, State};

/// What a step did to the strands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Sum of length / rest length - 1 over the segments that can stretch.
    pub stretch_sum: f64,
    /// Number of segments that can stretch.
    pub segment_count: usize,
    /// Largest length / rest length - 1.
    pub stretch_max: f32,
    /// Deepest free point inside a solid \[m\].
    pub penetration_max: f32,
    /// Points that were not finite.
    pub non_finite: usize,
}

/// Makes the predicted positions the positions, and measures them.
pub fn advance(solver: &Solver, state: &mut State, obstacles: &Obstacles) -> Outcome {
    let points = solver.points_per_strand;
    let solids = Solids::new(obstacles, points);
    std::mem::swap(&mut state.positions, &mut state.previous_positions);
    std::mem::swap(&mut state.positions, &mut state.scratch.predicted);
    state.world_from_head = obstacles.end;
    state.time += f64::from(solver.settings.time_step);
    let lengths = &state.scratch.lengths.stretch;
    let outcomes: Vec<Outcome> = state
        .positions
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.scratch.contacts.blocks.par_iter_mut())
        .enumerate()
        .with_min_len(16)
        .map(|(block, ((positions, velocities), planes))| {
            let non_finite = recover(solver, &obstacles.end, block, positions, velocities);
            let lengths = &lengths[block * points..(block + 1) * points];
            let live = live_lanes(solver, block);
            let mut outcome = Outcome { non_finite, ..Outcome::default() };
            let inverse_mass = &solver.inverse_mass[block * points..(block + 1) * points];
            for point in 1..points {
                let pair = [Vec3x8::load(&positions[point - 1]), Vec3x8::load(&positions[point])];
                let free = load(&inverse_mass[point - 1]) + load(&inverse_mass[point]);
                let stretch = (pair[1] - pair[0]).length() / load(&lengths[point - 1]) - splat(1.0);
                outcome.add_stretch(stretch, free.simd_gt(splat(0.0)), live);
            }
            outcome.penetration_max = deepest(&solids, positions, planes, inverse_mass, live);
            outcome
        })
        .collect();
    outcomes.iter().fold(Outcome::default(), |sum, outcome| sum.with(outcome))
}

impl Outcome {
    fn add_stretch(&mut self, stretch: f32x8, counted: f32x8, live: usize) {
        let mask = counted.to_bitmask();
        for (lane, stretch) in stretch.to_array().into_iter().take(live).enumerate() {
            if mask & (1 << lane) != 0 {
                self.stretch_sum += f64::from(stretch);
                self.segment_count += 1;
                self.stretch_max = self.stretch_max.max(stretch);
            }
        }
    }

    fn with(self, other: &Self) -> Self {
        Self {
            stretch_sum: self.stretch_sum + other.stretch_sum,
            segment_count: self.segment_count + other.segment_count,
            stretch_max: self.stretch_max.max(other.stretch_max),
            penetration_max: self.penetration_max.max(other.penetration_max),
            non_finite: self.non_finite + other.non_finite,
        }
    }

    /// Mean of length / rest length - 1.
    pub fn stretch_mean(&self) -> f32 {
        (self.stretch_sum / self.segment_count.max(1) as f64) as f32
    }
}

fn deepest(
    solids: &Solids,
    positions: &[Vec3Lanes],
    planes: &mut [Plane],
    inverse_mass: &[strandline_groom::Lanes],
    live: usize,
) -> f32 {
    let mut deepest = splat(0.0);
    if !solids.is_empty() {
        for (point, position) in positions.iter().enumerate() {
            let free = load(&inverse_mass[point]).simd_gt(splat(0.0));
            let depth = solids.depth(planes, point, Vec3x8::load(position));
            deepest = deepest.fast_max(depth & free);
        }
    }
    deepest.to_array().into_iter().take(live).fold(0.0, f32::max)
}

/// Puts strands that hold a number which is not finite back to rest and counts their bad points,
/// so that one bad strand never spreads.
pub(crate) fn recover(
    solver: &Solver,
    world_from_head: &Pose,
    block: usize,
    positions: &mut [Vec3Lanes],
    velocities: &mut [Vec3Lanes],
) -> usize {
    let mut nothing = splat(0.0);
    for (position, velocity) in positions.iter().zip(velocities.iter()) {
        let (x, v) = (Vec3x8::load(position), Vec3x8::load(velocity));
        // 0 for finite numbers, else not a number.
        nothing += (x.x + x.y + x.z + v.x + v.y + v.z) * splat(0.0);
    }
    let bad = nothing.is_nan().to_bitmask();
    if bad == 0 {
        return 0;
    }
    let live = live_lanes(solver, block);
    let mut count = 0;
    for lane in (0..LANES).filter(|lane| bad & (1 << lane) != 0) {
        for point in 0..positions.len() {
            let finite = positions[point].get(lane).is_finite() && velocities[point].get(lane).is_finite();
            count += usize::from(!finite && lane < live);
            let rest = solver.positions[block * positions.len() + point].get(lane);
            positions[point].set(lane, world_from_head.point(rest));
            velocities[point].set(lane, glam::Vec3::ZERO);
        }
    }
    count
}
