//! Rods of a step in blocks of strands: what takes them through a part of it.

use strandline_groom::{LANES, Lanes, RestShape, Vec3Lanes};
use wide::f32x8;

use super::length_pass::Follow;
use super::rod_air::{Around, of_lanes, shares};
use super::rod_parts::{Parts, Ride};
use crate::contact::planes::Plane;
use crate::grab::Pinned;
use crate::masses::Masses;
use crate::strands::rods::model::Rods;
use crate::strands::rods::real::{Real, Vector};
use crate::strands::rods::rod::{Node, Solved, StepSettings};
use crate::strands::rods::workspace::Workspace;
use crate::{MOST_SPIN, Model, RodReport};

/// Rounds of the projection onto lengths.
const LENGTH_ROUNDS: u32 = 2;
/// Depth \[m\] that points of a strand which a solid presses hard may stay in it, half the radius of a hair: until their
/// forces are found they are not put out, which would turn the last segment aside.
const SINKS: f32 = 2e-5;
/// Most of its speed that slow hair loses to hairs that rub \[1/s\]: contacts of hairs give way before they slip, so
/// that a small swing is damped and not held.
const RUBBING_RATE: f64 = 4.0;

/// All strands in a step.
pub(super) struct Hair<'a> {
    pub(super) model: &'a Model,
    pub(super) rods: &'a Rods,
    pub(super) parts: &'a Parts<'a>,
    pub(super) nodes: &'a [Node<f32x8>],
    pub(super) lengths: &'a RestShape,
    pub(super) masses: &'a Masses,
    /// Velocity of the air at each point \[m/s\]; empty where it is the wind.
    pub(super) flow: &'a [Vec3Lanes],
}

impl<'a> Hair<'a> {
    /// Nodes of a block.
    pub(super) fn nodes(&self, block: usize) -> &'a [Node<f32x8>] {
        &self.nodes[block * self.model.points_per_strand..(block + 1) * self.model.points_per_strand]
    }

    /// A block of them.
    pub(super) fn strands(&self, block: usize) -> Strands<'a> {
        let (model, parts) = (self.model, self.parts);
        let range = block * model.points_per_strand..(block + 1) * model.points_per_strand;
        let traits = &self.rods.traits[block * LANES..];
        Strands {
            model,
            parts,
            nodes: self.nodes(block),
            lengths: &self.lengths.stretch[range.clone()],
            inverse_mass: &self.masses.inverse_mass[range.clone()],
            rest: &model.positions[range.clone()],
            clearance: &model.rest_clearance[range.clone()],
            rest_sections: &self.rods.sections[range.clone()],
            flow: self.flow.get(range).unwrap_or_default(),
            viscous: parts.viscous(traits),
            crowding: of_lanes(traits, |traits| traits.crowding),
            air: parts.air.of(traits),
            driven: parts.driven(model, block),
            block,
            live: model.live_lanes(block),
        }
    }
}

/// One block of strands.
pub(super) struct Strands<'a> {
    pub(super) model: &'a Model,
    pub(super) parts: &'a Parts<'a>,
    pub(super) nodes: &'a [Node<f32x8>],
    pub(super) lengths: &'a [Lanes],
    pub(super) inverse_mass: &'a [Lanes],
    rest: &'a [Vec3Lanes],
    pub(super) clearance: &'a [Lanes],
    rest_sections: &'a [Vec3Lanes],
    /// Relaxation time of bends and twists over the length of a part.
    viscous: f32x8,
    /// Share of each strand beside which others pass.
    pub(super) crowding: f32x8,
    /// Air about the strands, and its velocity at each point \[m/s\]; empty where it is the wind.
    air: Around,
    flow: &'a [Vec3Lanes],
    /// Mask of the strands whose root frames move.
    driven: f32x8,
    block: usize,
    /// Lanes that hold strands.
    live: usize,
}

impl Strands<'_> {
    pub(super) fn solve(&self, space: &mut Workspace, planes: &mut [Plane], pinned: &[Pinned]) {
        self.begin(space);
        for part in 0..self.parts.count {
            let settings = self.begin_part(space, planes, pinned, part);
            let solved = space.solve(self.nodes, &settings);
            self.end_part(space, planes, &solved);
        }
    }

    /// Numbers of the strands in the scratch.
    pub(super) fn begin(&self, space: &mut Workspace) {
        for point in 0..self.nodes.len() {
            space.inverse_mass[point] = f32x8::new(self.inverse_mass[point].0);
            space.length[point] = f32x8::new(self.lengths[point].0);
        }
        shares(&space.length, &mut space.share);
        (space.bad, space.report) = (f32x8::ZERO, RodReport::default());
    }

    /// Finds the places to which forces, head and hand would take the strands in a part, and the shape where Newton's method begins.
    pub(super) fn begin_part(
        &self,
        space: &mut Workspace,
        planes: &mut [Plane],
        pinned: &[Pinned],
        part: u32,
    ) -> StepSettings<f32x8> {
        let own = self.parts.has_roots().then(|| self.parts.ride(self.model, self.block, part));
        self.want(space, own.as_ref().unwrap_or(&self.parts.head[part as usize]));
        self.find_pulls(space, planes, pinned, part);
        self.guess(space);
        let Workspace { carried, remainders, sections, work, .. } = space;
        let edge =
            |index: usize| carried[index + 1] - carried[index] + (remainders[index + 1] - remainders[index]);
        work.begin(edge, |index| sections[index]);
        StepSettings {
            time_step: self.parts.time_step,
            newton_steps: self.parts.settings.newton_steps,
            tolerance: f64::from(self.parts.settings.tolerance),
            viscous: self.viscous,
        }
    }

    /// Places to which forces alone would take the points, and the shape that the root frame carries along.
    fn want(&self, space: &mut Workspace, Ride { world_from_root, moved }: &Ride) {
        let step = f32x8::of(self.parts.time_step);
        let rubbing = step * step * f32x8::splat(self.parts.settings.rubbing);
        let last = self.nodes.len() - 1;
        for point in 0..=last {
            let free = self.nodes[point].free;
            let held = world_from_root.point(Vector::load(&self.rest[point]));
            let here = space.points[point];
            let rides = moved.as_ref().map_or(here, |moved| moved.point(here));
            let carried = Vector::choose(free, rides, held);
            // Numbers that differ little: not a bit is lost where nothing moves.
            let back = here - carried;
            space.carried[point] = carried;
            let remainder = space.remainders[point];
            let remainder = moved.as_ref().map_or(remainder, |moved| moved.direction(remainder));
            space.remainders[point] = remainder * free;
            if let Some(moved) = moved
                && space.loaded.any_positive()
            {
                space.loads[point] = moved.direction(space.loads[point]);
            }
            let tangent = space.points[last.min(point + 1)] - space.points[point.saturating_sub(1)];
            if self.parts.air.blows() {
                let wind = self.flow.get(point).map_or(self.parts.air.wind, Vector::load);
                self.air.blow(space, point, back, wind);
            }
            let fallen = self.parts.fall.weighted(space.velocities[point], tangent);
            let coast = space.velocities[point] * step + back;
            space.coast[point] = coast;
            let wanted = fallen * step + back - coast * self.rubbed(rubbing / coast.length());
            space.wanted[point] = wanted;
            let [x, y, z] = wanted.array();
            space.work.want(point, [x, y, z, space.spins[point] * step]);
            if let Some(moved) = moved {
                space.sections[point] = moved.direction(space.sections[point]);
            }
            let turns = self.nodes[point].free_angle;
            let section = world_from_root.direction(Vector::load(&self.rest_sections[point]));
            space.sections[point] =
                Vector::choose(turns * sound(space.sections[point]), space.sections[point], section);
        }
    }

    /// Share of a motion that hairs which rub take, from their speed \[m\] over that of the motion: beside others all of
    /// what is slow, else a share.
    #[inline(always)]
    fn rubbed(&self, rubs: f32x8) -> f32x8 {
        let alone = f32x8::of(1.0) - self.crowding;
        let yields = (rubs * alone).or_less(f32x8::of(RUBBING_RATE * self.parts.time_step));
        (rubs * self.crowding + yields).or_less(f32x8::of(1.0))
    }

    /// Newton's method begins with hair that keeps its velocity beside its root; where there are solids, at the shape
    /// carried along: the first Newton step judges contacts and friction by the place where it begins.
    fn guess(&self, space: &mut Workspace) {
        if !self.parts.solids.is_empty() {
            return;
        }
        let step = f32x8::of(self.parts.time_step);
        let (first, second) = (self.nodes[0].free, self.nodes[1].free);
        let held = Vector::choose(second, space.coast[0], space.coast[1]);
        let root = Vector::choose(first, self.pushed_back(space), held);
        for (point, node) in self.nodes.iter().enumerate() {
            let [x, y, z] = ((space.coast[point] - root) * node.free).array();
            space.work.guess(point, [x, y, z, space.spins[point] * step * node.free_angle]);
        }
    }

    /// Way of a free strand that forces take from it on the whole \[m\], which Newton's method would find to a hundredth.
    fn pushed_back(&self, space: &Workspace) -> Vector<f32x8> {
        let (mut pushed, mut mass) = (Vector::zero(), f32x8::ZERO);
        let square = f32x8::of(self.parts.time_step * self.parts.time_step);
        for (point, node) in self.nodes.iter().enumerate() {
            let (air, blows) = space.work.blown(point);
            let (free, blown) = (node.mass * node.free, blows * square * node.free);
            let coast = space.coast[point];
            pushed += (coast - space.wanted[point]) * free + (coast - air) * blown;
            mass += free + blown;
        }
        pushed * (f32x8::of(1.0) / mass)
    }

    /// Exact lengths outside the solids, and the new state.
    pub(super) fn end_part(&self, space: &mut Workspace, planes: &mut [Plane], solved: &Solved<f32x8>) {
        for (point, moved) in space.moved.iter_mut().enumerate() {
            let [x, y, z, _] = space.work.moved[point];
            *moved = space.remainders[point] + Vector::new(x, y, z);
        }
        let Workspace { carried, moved, inverse_mass, length, .. } = space;
        space.project.project(carried, moved, inverse_mass, length, LENGTH_ROUNDS);
        self.place(space, planes);
        self.take(space, solved);
    }

    /// Lengths to the last bit, from root to tip, outside the solids.
    fn place(&self, space: &mut Workspace, planes: &mut [Plane]) {
        let mut last_rooted = [-1.0_f32; LANES];
        for (point, inverse_mass) in self.inverse_mass.iter().enumerate() {
            for (last, _) in
                last_rooted.iter_mut().zip(&inverse_mass.0).filter(|(_, inverse)| **inverse == 0.0)
            {
                *last = point as f32;
            }
        }
        let follow = Follow {
            lengths: self.lengths,
            margins: &space.margins,
            sinks: space.loaded.choose(f32x8::splat(SINKS), f32x8::ZERO),
            last_rooted: f32x8::from(last_rooted),
            solids: &self.parts.solids,
        };
        follow.place_moved(&space.carried, &mut space.moved, planes);
    }

    /// The new state: velocities are what takes the points there; strands at rest stay.
    fn take(&self, space: &mut Workspace, solved: &Solved<f32x8>) {
        let last = self.nodes.len() - 1;
        let per_step = f32x8::of(1.0 / self.parts.time_step);
        let most_spin = f32x8::splat(MOST_SPIN);
        let (moving, bad) = self.moving(space, solved.pressed);
        space.bad |= bad;
        // 1 where the strand moves.
        let moves = moving.bitselect(f32x8::of(1.0), f32x8::ZERO);
        let none = bad.bitselect(f32x8::splat(f32::NAN), f32x8::ZERO);
        let moves = self.driven.bitselect(f32x8::of(1.0), moves);
        for point in 0..=last {
            let moved = space.way(point);
            let velocity = Vector::choose(moves, moved * per_step, Vector::zero());
            // Of a strand that began with what is no number nothing is kept: it goes back to rest, and is counted.
            space.velocities[point] = velocity + Vector::new(none, none, none);
            let (place, remainder) = sum_and_remainder(space.carried[point], space.moved[point]);
            space.points[point] = Vector::choose(moves, place, space.points[point]);
            space.remainders[point] = Vector::choose(moves, remainder, space.remainders[point]);
            let [.., angle] = space.work.moved[point];
            let spin = (angle * per_step).fast_min(most_spin).fast_max(-most_spin);
            space.spins[point] = moves.choose(spin, f32x8::ZERO);
            if point < last {
                let section = space.work.segments[point].across;
                space.sections[point] = Vector::choose(moves, section, space.sections[point]);
            }
            // A strand that goes back to rest has the sections of its rest, which the next step finds.
            space.sections[point] = keep(space.bad, space.sections[point]);
            space.spins[point] = space.bad.bitselect(f32x8::ZERO, space.spins[point]);
        }
        self.count(space, solved, moves);
    }

    fn count(&self, space: &mut Workspace, solved: &Solved<f32x8>, moves: f32x8) {
        let count = |mask: f32x8| (mask.to_bitmask() & ((1 << self.live) - 1)).count_ones() as usize;
        let residual =
            solved.residual.to_array()[..self.live].iter().fold(0.0, |most: f32, one| most.max(*one));
        let report = &mut space.report;
        report.residual = report.residual.max(residual);
        report.unsolved = report.unsolved.max(count(solved.unsolved.simd_gt(f32x8::ZERO)));
        report.resting = count(moves.simd_eq(f32x8::ZERO));
    }
}

/// The sum of a vector and a smaller one in single precision, and what rounding leaves out of it.
#[inline(always)]
fn sum_and_remainder(large: Vector<f32x8>, small: Vector<f32x8>) -> (Vector<f32x8>, Vector<f32x8>) {
    let sum = large + small;
    let taken = sum - large;
    (sum, (large - (sum - taken)) + (small - taken))
}

/// A vector, zero in the lanes of a mask.
#[inline(always)]
fn keep(bad: f32x8, vector: Vector<f32x8>) -> Vector<f32x8> {
    let kept = |value: f32x8| bad.bitselect(f32x8::ZERO, value);
    Vector::new(kept(vector.x), kept(vector.y), kept(vector.z))
}

/// 1 for unit vectors, 0 for what a strand left that was put back to rest.
#[inline(always)]
fn sound(vector: Vector<f32x8>) -> f32x8 {
    let size = vector.dot(vector);
    let unit = size.simd_gt(f32x8::of(0.5)) & size.simd_lt(f32x8::of(2.0));
    unit.bitselect(f32x8::of(1.0), f32x8::ZERO)
}
