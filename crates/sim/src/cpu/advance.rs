//! Commits the step, x <- x*, and measures it: stretch, penetration, speed, non-finite points.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::BodyFrame;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::Scratch;
use crate::contact::Obstacles;
use crate::contact::contacts::Solids;
use crate::contact::planes::Plane;
use crate::{Model, State};
use strandline_base::vec3x8::{Vec3x8, load, splat};

/// Measures of a step over the strands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Sum of length / rest length - 1 over the segments that can stretch.
    pub stretch_sum: f64,
    /// Number of segments that can stretch.
    pub segment_count: usize,
    /// Largest length / rest length - 1; not a number where one of them is none.
    pub stretch_max: f32,
    /// Deepest free point inside a solid \[m\].
    pub penetration_max: f32,
    /// Sum over all points of the speed \[m/s\] of what moved.
    pub speed_sum: f64,
    /// Largest of them.
    pub speed_max: f32,
    /// Points that were not finite.
    pub non_finite: NonFinite,
}

/// Points whose position or velocity was not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NonFinite {
    /// Number of strands.
    pub count: usize,
    /// The first strand that has one.
    pub first_strand: Option<usize>,
}

impl NonFinite {
    /// Both together.
    pub fn with(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            first_strand: self.first_strand.into_iter().chain(other.first_strand).min(),
        }
    }
}

/// Makes the predicted positions the positions, and measures them.
pub fn advance(model: &Model, state: &mut State, scratch: &mut Scratch, obstacles: &Obstacles) -> Outcome {
    let points = model.points_per_strand;
    let solids = Solids::new(obstacles, points);
    std::mem::swap(&mut state.positions, &mut state.previous_positions);
    std::mem::swap(&mut state.positions, &mut scratch.predicted);
    state.body = obstacles.end.clone();
    state.time += f64::from(model.settings.time_step);
    let (lengths, contacts) = (&state.lengths.stretch, &state.contacts.blocks);
    let speeds = state.velocities.par_chunks_mut(points).zip(state.corrections.par_chunks_mut(points));
    let outcomes: Vec<Outcome> = state
        .positions
        .par_chunks_mut(points)
        .zip(state.previous_positions.par_chunks_mut(points))
        .zip(speeds)
        .enumerate()
        .with_min_len(16)
        .map(|(block, ((positions, previous), (velocities, corrections)))| {
            let hair = Block { positions: &mut *positions, previous, velocities, corrections };
            let non_finite = recover(model, &obstacles.end, block, hair);
            let lengths = &lengths[block * points..(block + 1) * points];
            let live = model.live_lanes(block);
            let mut outcome = Outcome { non_finite, ..Outcome::default() };
            let (mut stretches, mut speeds) = (Numbers::default(), Numbers::default());
            let there = splat(live as f32).simd_gt(f32x8::from(NUMBERED));
            let inverse_mass = &model.inverse_mass[block * points..(block + 1) * points];
            for point in 1..points {
                let pair = [Vec3x8::load(&positions[point - 1]), Vec3x8::load(&positions[point])];
                let free = load(&inverse_mass[point - 1]) + load(&inverse_mass[point]);
                let stretch = (pair[1] - pair[0]).length() / load(&lengths[point - 1]) - splat(1.0);
                stretches.add(stretch, free.simd_gt(splat(0.0)) & there);
            }
            for (now, before) in positions.iter().zip(&*previous) {
                let moved = (Vec3x8::load(now) - Vec3x8::load(before)).length();
                speeds.add(moved * splat(1.0 / model.settings.time_step), there);
            }
            outcome.take(&stretches, &speeds);
            outcome.penetration_max = deepest(&solids, positions, &contacts[block], inverse_mass, live);
            outcome
        })
        .collect();
    outcomes.iter().fold(Outcome::default(), |sum, outcome| sum.with(outcome))
}

impl Outcome {
    fn take(&mut self, stretches: &Numbers, speeds: &Numbers) {
        self.stretch_sum += stretches.sum();
        self.segment_count += stretches.count;
        self.stretch_max = larger(self.stretch_max, stretches.most());
        self.speed_sum += speeds.sum();
        self.speed_max = self.speed_max.max(speeds.most());
    }

    fn with(self, other: &Self) -> Self {
        Self {
            speed_sum: self.speed_sum + other.speed_sum,
            speed_max: self.speed_max.max(other.speed_max),
            stretch_sum: self.stretch_sum + other.stretch_sum,
            segment_count: self.segment_count + other.segment_count,
            stretch_max: larger(self.stretch_max, other.stretch_max),
            penetration_max: self.penetration_max.max(other.penetration_max),
            non_finite: self.non_finite.with(other.non_finite),
        }
    }

    /// Mean of length / rest length - 1.
    pub fn stretch_mean(&self) -> f32 {
        (self.stretch_sum / self.segment_count.max(1) as f64) as f32
    }
}

/// The numbers of the lanes.
const NUMBERED: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Numbers of a block that are counted, lane by lane.
#[derive(Default)]
struct Numbers {
    sum: f32x8,
    /// The largest above 0; not a number where one is none.
    most: f32x8,
    count: usize,
}

impl Numbers {
    #[inline]
    fn add(&mut self, numbers: f32x8, counted: f32x8) {
        let numbers = numbers & counted;
        self.sum += numbers;
        let stays = numbers.simd_le(self.most) | self.most.is_nan();
        self.most = stays.bitselect(self.most, numbers);
        self.count += counted.to_bitmask().count_ones() as usize;
    }

    fn sum(&self) -> f64 {
        self.sum.to_array().map(f64::from).iter().sum()
    }

    fn most(&self) -> f32 {
        self.most.to_array().into_iter().fold(0.0, larger)
    }
}

/// The larger of two numbers; what is no number is kept, where a maximum would pass over it.
fn larger(one: f32, other: f32) -> f32 {
    if other > one || other.is_nan() { other } else { one }
}

/// Depth \[m\] of the deepest free point of a block inside the solids.
fn deepest(
    solids: &Solids,
    positions: &[Vec3Lanes],
    planes: &[Plane],
    inverse_mass: &[Lanes],
    live: usize,
) -> f32 {
    if solids.is_empty() {
        return 0.0;
    }
    let depth = |(index, (position, inverse_mass)): (usize, (&Vec3Lanes, &Lanes))| {
        let is_counted = |lane: usize| lane < live && inverse_mass.0[lane] > 0.0;
        solids.depth(Vec3x8::load(position), (planes, index), is_counted)
    };
    positions.iter().zip(inverse_mass).enumerate().map(depth).fold(0.0, f32::max)
}

/// The changing state of a block of strands, shape `[point]` of lanes, world space.
pub(crate) struct Block<'a> {
    /// Positions at the end of the step \[m\].
    pub positions: &'a mut [Vec3Lanes],
    /// Positions at its start \[m\].
    pub previous: &'a mut [Vec3Lanes],
    /// Velocities \[m/s\].
    pub velocities: &'a mut [Vec3Lanes],
    /// Additions of the next prediction \[m/s\].
    pub corrections: &'a mut [Vec3Lanes],
}

/// Puts strands that hold a number which is not finite back to rest and finds their bad points,
/// so that one bad strand never spreads. They have been there one step ago too, so that no picture
/// between the two steps shows the way back.
pub(crate) fn recover(model: &Model, body: &BodyFrame, block: usize, hair: Block) -> NonFinite {
    let Block { positions, previous, velocities, corrections } = hair;
    let mut nothing = splat(0.0);
    for point in 0..positions.len() {
        for vector in [&positions[point], &velocities[point], &corrections[point]] {
            let vector = Vec3x8::load(vector);
            // 0 for finite numbers, else not a number.
            nothing += (vector.x + vector.y + vector.z) * splat(0.0);
        }
    }
    let bad = nothing.is_nan().to_bitmask();
    if bad == 0 {
        return NonFinite::default();
    }
    let live = model.live_lanes(block);
    let mut found = NonFinite::default();
    let roots = model.roots(body, block);
    for lane in (0..LANES).filter(|lane| bad & (1 << lane) != 0) {
        for point in 0..positions.len() {
            let finite = [&positions[point], &velocities[point], &corrections[point]]
                .iter()
                .all(|vectors| vectors.get(lane).is_finite());
            if !finite && lane < live {
                found = found.with(NonFinite { count: 1, first_strand: Some(block * LANES + lane) });
            }
            let home = roots[lane].point(model.positions[block * positions.len() + point].get(lane));
            positions[point].set(lane, home);
            previous[point].set(lane, home);
            velocities[point].set(lane, Vec3::ZERO);
            corrections[point].set(lane, Vec3::ZERO);
        }
    }
    found
}
