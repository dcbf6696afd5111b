//! Lengths of strands that are held at more than their root. Between two holds a walk from the root would leave the whole
//! error of the lengths to the last segment.
//!
//! The strand goes to the nearest place, by mass, of its prediction where its segments have their
//! lengths: 1/2 sum m |x - y|^2 is least under |x_i+1 - x_i| = l_i. Alternating directions take turns
//! between the directions of the segments, which are free of one another, and all points at once, a
//! tridiagonal system [Overby2017]; Newton steps on the lengths alone end it [Goldenthal2007]. The tension that they find for the place where the strand
//! was lets a strand at rest stay, whatever the step; a strand that is too short is stretched evenly.

use strandline_groom::{Lanes, Vec3Lanes};
use wide::f32x8;

use crate::contact::touch::Touch;
use strandline_base::vec3x8::{Vec3x8, load, splat};

/// Number of turns between directions and points. A rope of 62 segments, its ends 0.95 lengths apart, then keeps
/// lengths to 1e-4.
const TURNS: usize = 32;
/// Newton steps after them: strands in motion are left 3e-3 off by the turns alone.
const NEWTON_STEPS: usize = 5;
/// Share of its length from which a span is taut.
const TAUT_FROM: f32 = 1.0 - 1e-4;
/// Stiffness of a segment over mean mass and mean length, at least: the turns are quick from 10 to 1,000.
const STIFFNESS: f32 = 100.0;
/// Stiffness of a segment over tension and length, at least, so that the turns converge on a taut strand.
const TAUT: f32 = 4.0;
/// Compliance of constraints in the guess of the tension, as a share: a strand that is too short has no finite
/// tension.
const GIVES_WAY: f32 = 1e-5;

/// Stiffness of a touch over that of a segment: stiffer, points stick to where they touched first.
const PUSH: f32 = 0.1;

/// One block of strands between holds.
pub struct Spans {
    /// 1 over the mass \[1/kg\], 0 at a hold, shape `[point]`.
    weights: Vec<f32x8>,
    /// Lanes of strands that are held behind a free point.
    pub held_behind: f32x8,
    /// Last rooted point of each strand, -1 without one.
    pub last_rooted: f32x8,
    /// The prediction \[m\], from the first point on.
    goals: Vec<Vec3x8>,
    positions: Vec<Vec3x8>,
    /// Errors of the directions \[m\]: tension over stiffness.
    offsets: Vec<Vec3x8>,
    /// Result of the elimination: share of the next point.
    shares: Vec<f32x8>,
    /// Pull along each segment, over the time step squared \[kg m\].
    pulls: Vec<f32x8>,
    /// Compliance of each segment: length over pull \[1/kg\].
    gives_way: f32x8,
    /// Depth of each touch \[m\], 0 or less.
    depths: Vec<f32x8>,
}

impl Spans {
    pub fn new(points: usize) -> Self {
        let (numbers, vectors) = (vec![f32x8::ZERO; points], vec![Vec3x8::ZERO; points]);
        Self {
            weights: numbers.clone(),
            held_behind: f32x8::ZERO,
            last_rooted: splat(-1.0),
            goals: vectors.clone(),
            positions: vectors.clone(),
            offsets: vectors,
            shares: numbers.clone(),
            pulls: numbers.clone(),
            gives_way: f32x8::ZERO,
            depths: numbers,
        }
    }

    /// Finds the holds of a block: rooted points and those in a hand, `pinned` as (lane, point).
    pub fn find(&mut self, inverse_mass: &[Lanes], pinned: impl Iterator<Item = (usize, usize)>) {
        let mut free_before = f32x8::ZERO;
        (self.held_behind, self.last_rooted) = (f32x8::ZERO, splat(-1.0));
        for (point, (weight, inverse_mass)) in self.weights.iter_mut().zip(inverse_mass).enumerate() {
            *weight = load(inverse_mass);
            let held = weight.simd_eq(splat(0.0));
            self.held_behind |= held & free_before;
            self.last_rooted = held.bitselect(splat(point as f32), self.last_rooted);
            free_before |= weight.simd_gt(splat(0.0));
        }
        for (lane, point) in pinned {
            let mut weight = self.weights[point].to_array();
            weight[lane] = 0.0;
            self.weights[point] = f32x8::from(weight);
            let mut mask = [0.0; 8];
            mask[lane] = 1.0;
            self.held_behind |= f32x8::from(mask).simd_gt(splat(0.0));
        }
    }

    /// Moves the points of the strands that are held behind a free point from their prediction to
    /// where their segments have their lengths, outside what they touch; `start` is where they were.
    pub fn solve(
        &mut self,
        lengths: &[Lanes],
        start: &[Vec3Lanes],
        touches: &[Option<Touch>],
        predicted: &mut [Vec3Lanes],
    ) {
        let origin = Vec3x8::load(&predicted[0]);
        for (point, predicted) in predicted.iter().enumerate() {
            self.goals[point] = Vec3x8::load(predicted) - origin;
        }
        self.positions.copy_from_slice(&self.goals);
        self.depths.fill(f32x8::ZERO);
        let stiffness = self.guess(lengths, start);
        for turn in 0..TURNS {
            self.turn(turn == 0, stiffness, lengths, start, (origin, touches));
        }
        self.sharpen(lengths);
        for (point, touch) in touches.iter().enumerate() {
            let Some(touch) = touch else { continue };
            let height = touch.height(self.positions[point] + origin).fast_min(splat(0.0));
            let free = self.weights[point].simd_gt(splat(0.0));
            let out = self.positions[point] - touch.normal * height;
            self.positions[point] = out.or(free, self.positions[point]);
        }
        for (position, predicted) in self.positions.iter().zip(&mut *predicted) {
            let placed = *position + origin;
            placed.or(self.held_behind, Vec3x8::load(predicted)).store(predicted);
        }
        for (lane, _) in
            self.held_behind.to_array().iter().enumerate().filter(|(_, held)| held.to_bits() != 0)
        {
            self.straighten(lane, lengths, predicted);
        }
    }

    /// The tension that would keep the lengths in the directions that segments had, as offsets; the
    /// stiffness of a segment times its length.
    fn guess(&mut self, lengths: &[Lanes], start: &[Vec3Lanes]) -> f32x8 {
        let (mut mass, mut count, mut total) = (f32x8::ZERO, f32x8::ZERO, f32x8::ZERO);
        let segments = start.len() - 1;
        for (weight, length) in self.weights.iter().zip(lengths) {
            let free = weight.simd_gt(splat(0.0));
            mass += free & (splat(1.0) / weight.fast_max(splat(1e-30)));
            count += free & splat(1.0);
            total += load(length);
        }
        let mass = mass / count.fast_max(splat(1.0));
        let gives_way = splat(GIVES_WAY) / mass.fast_max(splat(1e-30));
        for (offset, ends) in self.offsets.iter_mut().zip(start.windows(2)) {
            *offset = unit(Vec3x8::load(&ends[1]) - Vec3x8::load(&ends[0]));
        }
        self.pull(lengths, gives_way);
        let mut largest = f32x8::ZERO;
        for ((offset, pull), length) in self.offsets[..segments].iter_mut().zip(&self.pulls).zip(lengths) {
            // Hair pushes back by bending aside, not along itself.
            let pull = pull.fast_max(splat(0.0));
            largest = largest.fast_max(pull);
            *offset = *offset * (pull * load(length));
        }
        let mean_length = total * splat(1.0 / segments as f32);
        let stiffness = (splat(STIFFNESS) * mass * mean_length).fast_max(splat(TAUT) * largest);
        let soft = splat(1.0) / stiffness.fast_max(splat(1e-30));
        self.offsets[..segments].iter_mut().for_each(|offset| *offset = *offset * soft);
        self.gives_way = gives_way;
        stiffness
    }

    /// Corrects the lengths that the turns leave, to the last bit, by Newton steps [Goldenthal2007].
    fn sharpen(&mut self, lengths: &[Lanes]) {
        for _ in 0..NEWTON_STEPS {
            self.goals.copy_from_slice(&self.positions);
            for (offset, ends) in self.offsets.iter_mut().zip(self.positions.windows(2)) {
                *offset = unit(ends[1] - ends[0]);
            }
            self.pull(lengths, self.gives_way);
            for segment in 0..self.positions.len() - 1 {
                let pull = self.offsets[segment] * self.pulls[segment];
                self.positions[segment] += pull * self.weights[segment];
                self.positions[segment + 1] += pull * -self.weights[segment + 1];
            }
        }
    }

    /// Puts the points of a taut span on the line between its two holds, evenly by length: the lengths alone do not
    /// determine how far a point lies beside that line.
    fn straighten(&self, lane: usize, lengths: &[Lanes], positions: &mut [Vec3Lanes]) {
        let (mut hold, mut reach): (Option<usize>, f32) = (None, 0.0);
        for point in 0..positions.len() {
            if self.weights[point].to_array()[lane] == 0.0 {
                if let Some(first) = hold {
                    lay(lane, &lengths[first..point], reach, &mut positions[first..=point]);
                }
                (hold, reach) = (Some(point), 0.0);
            }
            reach += lengths[point].0[lane];
        }
    }

    /// The pulls along the segments that bring the goals to their lengths, to first order; `offsets` are
    /// the directions of the segments.
    fn pull(&mut self, lengths: &[Lanes], gives_way: f32x8) {
        let segments = self.pulls.len() - 1;
        let (mut lower, mut right) = (f32x8::ZERO, f32x8::ZERO);
        for (segment, length) in lengths[..segments].iter().enumerate() {
            let (below, above) = (self.weights[segment], self.weights[segment + 1]);
            let moves = (below + above).simd_gt(splat(0.0));
            let here = self.offsets[segment];
            let excess = (self.goals[segment + 1] - self.goals[segment]).dot(here) - load(length);
            let share = if segment > 0 { self.shares[segment - 1] } else { f32x8::ZERO };
            let pivot = splat(1.0) / (below + above + gives_way - lower * share);
            right = ((moves & excess) - lower * right) * pivot;
            let next = if segment + 1 < segments { self.offsets[segment + 1] } else { Vec3x8::ZERO };
            lower = -above * here.dot(next);
            self.shares[segment] = lower * pivot;
            self.pulls[segment] = right;
        }
        for segment in (0..segments - 1).rev() {
            let behind = self.pulls[segment + 1];
            self.pulls[segment] -= self.shares[segment] * behind;
        }
    }

    /// Gives every segment its length in its direction, then every point its place among them.
    fn turn(
        &mut self,
        first: bool,
        stiffness: f32x8,
        lengths: &[Lanes],
        start: &[Vec3Lanes],
        (origin, touches): (Vec3x8, &[Option<Touch>]),
    ) {
        let last = start.len() - 1;
        let (mut before, mut spring_before, mut wanted_before) = (Vec3x8::ZERO, f32x8::ZERO, Vec3x8::ZERO);
        for point in 0..=last {
            let (here, weight) = (self.positions[point], self.weights[point]);
            let (mut spring, mut wanted) = (f32x8::ZERO, Vec3x8::ZERO);
            if point < last {
                let length = load(&lengths[point]);
                spring = stiffness / length;
                let across = if first {
                    Vec3x8::load(&start[point + 1]) - Vec3x8::load(&start[point])
                } else {
                    self.positions[point + 1] - here + self.offsets[point]
                };
                let exact = across * (length / across.length());
                if !first {
                    self.offsets[point] = across - exact;
                }
                wanted = exact - self.offsets[point];
            }
            let mass = splat(1.0) / weight.fast_max(splat(1e-30));
            let share = if point > 0 { self.shares[point - 1] } else { f32x8::ZERO };
            let mut sum = mass + spring + spring_before * (splat(1.0) - share);
            let mut right =
                self.goals[point] * mass + (wanted_before + before) * spring_before - wanted * spring;
            if let Some(touch) = &touches[point] {
                let depth = &mut self.depths[point];
                let height =
                    if first { f32x8::ZERO } else { touch.height(here + origin).fast_min(splat(1.0)) };
                *depth = (*depth + height).fast_min(splat(0.0));
                let push = (spring.fast_max(spring_before) * splat(PUSH)) & depth.simd_lt(splat(0.0));
                sum += push;
                right += (here - touch.normal * (height + *depth)) * push;
            }
            let free = weight.simd_gt(splat(0.0));
            let pivot = splat(1.0) / sum;
            self.shares[point] = free & (spring * pivot);
            before = (right * pivot).or(free, here);
            // Points behind still need the old position: the new one is stored on the way back.
            self.positions[point] = before;
            (spring_before, wanted_before) = (spring, wanted);
        }
        for point in (0..last).rev() {
            let along = self.positions[point + 1] * self.shares[point];
            self.positions[point] += along;
        }
    }
}

/// The direction of a segment.
#[inline(always)]
fn unit(across: Vec3x8) -> Vec3x8 {
    across * (splat(1.0) / across.length())
}

/// Lays the points between two holds on the line between them, if that is as long as all their segments.
fn lay(lane: usize, lengths: &[Lanes], reach: f32, positions: &mut [Vec3Lanes]) {
    let last = positions.len() - 1;
    let start = positions[0].get(lane);
    let across = positions[last].get(lane) - start;
    if across.length() < TAUT_FROM * reach {
        return;
    }
    let mut way = 0.0;
    for (length, position) in lengths.iter().zip(&mut positions[1..last]) {
        way += length.0[lane];
        position.set(lane, start + across * (way / reach));
    }
}
