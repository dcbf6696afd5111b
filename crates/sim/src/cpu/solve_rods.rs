//! The stage: rods of all strands through a step, in parts, then outside the solids at exact lengths.

use glam::Vec3;
use rayon::prelude::*;
use strandline_body::Pose;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::Obstacles;
use super::advance::{Block, NonFinite, recover};
use super::constrain::live_lanes;
use super::contacts::{Care, Plane, Query, Solids};
use super::integrate::Fall;
use super::length_pass::Follow;
use super::vec3x8::{self, Vec3x8};
use crate::grab::Pinned;
use crate::strands::rods::model::{all, load, store, with_lengths};
use crate::strands::rods::real::{Real, Vector};
use crate::strands::rods::rod::{Node, Pull, Solved, StepSettings};
use crate::strands::rods::settings::RodSettings;
use crate::strands::rods::workspace::{Carry, Workspace};
use crate::{RodReport, Solver, State};

/// Stiffness of a contact or a pin over the mass of its point and the square of the step: what rests on a
/// solid sinks in by a thousandth of its fall in a step.
const STIFF: f64 = 1e3;
/// Rounds of the projection onto lengths.
const LENGTH_ROUNDS: u32 = 2;
/// A strand is solved when a Newton step turns none of its segments farther \[rad\].
const TOLERANCE: f64 = 1e-4;
/// Most that a point of a strand at rest moves in a part of a step \[m\], squared: what two thousandths of gravity
/// take it, but a few roundings of single precision a metre away. Below, the strand stays where it is to the bit.
fn still(time_step: f64) -> f32 {
    let way = (0.02 * time_step * time_step).clamp(1e-7, 5e-7);
    (way * way) as f32
}

/// Forces, elasticity, lengths and solids: writes the predicted positions, the sections and the
/// velocities. Returns the points that were not finite, whose strands are back at rest, and how the
/// strands were solved. Without rods nothing is done.
pub fn solve_rods(
    solver: &Solver,
    state: &mut State,
    obstacles: &Obstacles,
    wind: Vec3,
) -> (NonFinite, RodReport) {
    let Some(rods) = &solver.rods else { return Default::default() };
    let points = solver.points_per_strand;
    let parts = Parts::new(solver, &solver.settings.strands.rods, obstacles, wind);
    let (scratch, grab) = (&mut state.scratch, &state.grab);
    let (lengths, masses) = (&scratch.lengths.stretch, &scratch.masses);
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks_mut(points))
        .zip(scratch.contacts.blocks.par_iter_mut())
        .zip(state.sections.par_chunks_mut(points))
        .zip(state.spins.par_chunks_mut(points))
        .zip(state.corrections.par_chunks_mut(points))
        .zip(&state.length_scale)
        .enumerate()
        .with_min_len(8)
        .map_init(
            || Workspace::new(points),
            |work,
             (
                block,
                (((((((predicted, velocities), start), planes), sections), spins), corrections), scale),
            )| {
                let range = block * points..(block + 1) * points;
                work.load(start, velocities, sections, spins);
                let mut nodes = std::mem::take(&mut work.nodes);
                let is_scaled = scale.0.iter().any(|scale| *scale != 1.0);
                if is_scaled {
                    let rest = &solver.rest.stretch[range.clone()];
                    let (lengths, mass) = (&lengths[range.clone()], &masses.mass[range.clone()]);
                    with_lengths(&rods.nodes[range.clone()], rest, lengths, mass, &mut nodes);
                }
                let strands = Strands {
                    solver,
                    parts: &parts,
                    nodes: if is_scaled { &nodes } else { &rods.nodes[range.clone()] },
                    lengths: &lengths[range.clone()],
                    inverse_mass: &masses.inverse_mass[range.clone()],
                    rest: &solver.positions[range.clone()],
                    clearance: &solver.rest_clearance[range.clone()],
                    rest_sections: &rods.sections[range],
                    live: live_lanes(solver, block),
                };
                let pinned: Vec<Pinned> =
                    grab.pinned(block, predicted, strands.lengths, strands.inverse_mass).collect();
                strands.solve(work, planes, &pinned);
                work.nodes = nodes;
                work.store(predicted, velocities, sections, spins);
                corrections.fill(Vec3Lanes::default());
                let hair = Block { positions: predicted, previous: start, velocities, corrections };
                (recover(solver, &obstacles.end, block, hair), work.report)
            },
        )
        .reduce(Default::default, |one, other| (one.0.with(other.0), one.1.with(other.1)))
}

/// What all strands share in a step.
struct Parts<'a> {
    settings: &'a RodSettings,
    count: u32,
    time_step: f64,
    fall: Fall,
    solids: Solids<'a>,
    /// Pose of the head at the end of each part, and what carries the head there from the part before.
    poses: Vec<(Pose, Pose)>,
    moved: bool,
}

impl<'a> Parts<'a> {
    fn new(solver: &'a Solver, settings: &'a RodSettings, obstacles: &Obstacles<'a>, wind: Vec3) -> Self {
        let count = settings.substeps;
        let time_step = solver.settings.time_step / count as f32;
        let pose = |part: u32| obstacles.start.toward(&obstacles.end, part as f32 / count as f32);
        let poses = (0..count)
            .map(|part| {
                let (before, after) = (pose(part), pose(part + 1));
                let inverse = before.inverse();
                let moved = Pose {
                    rotation: after.rotation * inverse.rotation,
                    translation: after.point(inverse.translation),
                };
                (after, if before == after { Pose::IDENTITY } else { moved })
            })
            .collect();
        Self {
            settings,
            count,
            time_step: f64::from(time_step),
            fall: Fall::for_time(solver, time_step, wind),
            solids: Solids::new(obstacles, solver.points_per_strand),
            poses,
            moved: obstacles.start != obstacles.end,
        }
    }
}

/// One block of strands.
struct Strands<'a> {
    solver: &'a Solver,
    parts: &'a Parts<'a>,
    nodes: &'a [Node<f32x8>],
    lengths: &'a [Lanes],
    inverse_mass: &'a [Lanes],
    rest: &'a [Vec3Lanes],
    clearance: &'a [Lanes],
    rest_sections: &'a [Vec3Lanes],
    /// Lanes that hold strands.
    live: usize,
}

impl Strands<'_> {
    fn solve(&self, space: &mut Workspace, planes: &mut [Plane], pinned: &[Pinned]) {
        for point in 0..self.nodes.len() {
            space.inverse_mass[point] = f32x8::new(self.inverse_mass[point].0);
            space.length[point] = f32x8::new(self.lengths[point].0);
        }
        (space.bad, space.report) = (f32x8::ZERO, RodReport::default());
        for part in 0..self.parts.count {
            let (pose, moved) = &self.parts.poses[part as usize];
            self.want(space, &Carry::new(pose), moved);
            self.find_pulls(space, planes, pinned, part);
            self.solve_part(space, planes);
        }
    }

    /// Where forces alone would take the points, and the shape that the head carries along.
    fn want(&self, space: &mut Workspace, world_from_head: &Carry, moved: &Pose) {
        let step = f32x8::of(self.parts.time_step);
        let carry = Carry::new(moved);
        let last = self.nodes.len() - 1;
        for point in 0..=last {
            let free = self.nodes[point].free;
            let held = world_from_head.point(load(&self.rest[point]));
            let here = space.points[point];
            let rides = if *moved == Pose::IDENTITY { here } else { carry.point(here) };
            space.carried[point] = Vector::choose(free, rides, held);
            let tangent = space.points[last.min(point + 1)] - space.points[point.saturating_sub(1)];
            let fallen = self.parts.fall.weighted(pass(space.velocities[point]), pass(tangent));
            let wanted = here + Vector::new(fallen.x, fallen.y, fallen.z) * step - space.carried[point];
            space.wanted[point] = wanted;
            let [x, y, z] = wanted.array();
            space.work.want(point, [x, y, z, space.spins[point] * step]);
            if *moved != Pose::IDENTITY {
                space.sections[point] = carry.direction(space.sections[point]);
            }
            let turns = self.nodes[point].free_angle;
            let section = world_from_head.direction(load(&self.rest_sections[point]));
            space.sections[point] =
                Vector::choose(turns * sound(space.sections[point]), space.sections[point], section);
        }
    }

    /// Planes near the points and what a hand holds, as stiff springs.
    fn find_pulls(&self, space: &mut Workspace, planes: &mut [Plane], pinned: &[Pinned], part: u32) {
        space.pulls.clear();
        let stiff = f32x8::of(STIFF / (self.parts.time_step * self.parts.time_step));
        let most = f32x8::splat(self.solver.settings.collision_margin);
        for point in 0..self.nodes.len() {
            let node = &self.nodes[point];
            let margin = most.fast_min(f32x8::new(self.clearance[point].0)).fast_max(f32x8::ZERO);
            space.margins[point] = margin;
            let free = node.free.simd_gt(f32x8::ZERO);
            if free.any() && !self.parts.solids.is_empty() {
                let position = pass(space.carried[point] + space.wanted[point]);
                let query = Query {
                    position,
                    start: Some(pass(space.points[point])),
                    margin,
                    free,
                    care: Care::ROUGH,
                };
                if let Some(touch) = self.parts.solids.touch(planes, point, query) {
                    let height = touch.height(pass(space.carried[point]));
                    let near = height.simd_lt(f32x8::splat(1.0));
                    // What the head carries has gone where it is already.
                    let stays = touch.stuck.x.simd_eq(space.points[point].x)
                        & touch.stuck.y.simd_eq(space.points[point].y)
                        & touch.stuck.z.simd_eq(space.points[point].z);
                    let stays = stays.bitselect(f32x8::of(1.0), f32x8::ZERO);
                    let back = space.points[point] - space.carried[point];
                    space.pulls.push(Pull {
                        node: point,
                        normal: Vector::new(touch.normal.x, touch.normal.y, touch.normal.z),
                        reach: near.bitselect(-height, f32x8::splat(-1.0)),
                        stiffness: (node.mass * stiff) & near,
                        one_sided: true,
                        friction: touch.friction,
                        stuck: Vector::choose(stays, back, Vector::zero()),
                    });
                }
            }
            self.pull_pins(space, pinned, point, node.mass * stiff, part);
        }
    }

    fn pull_pins(&self, space: &mut Workspace, pinned: &[Pinned], point: usize, stiffness: f32x8, part: u32) {
        let mut goals = Vec3Lanes::default();
        let mut held = [0.0; LANES];
        for pin in pinned.iter().filter(|pin| pin.point == point) {
            let mut here = Vec3Lanes::default();
            store(space.points[point], &mut here);
            let share = 1.0 / (self.parts.count - part) as f32;
            goals.set(pin.lane, here.get(pin.lane).lerp(pin.goal, share));
            held[pin.lane] = 1.0;
        }
        if held.iter().all(|held| *held == 0.0) {
            return;
        }
        let stiffness = stiffness * f32x8::from(held);
        let missing = (load(&goals) - space.carried[point]).array();
        for (axis, reach) in missing.into_iter().enumerate() {
            let normal = all([Vec3::X, Vec3::Y, Vec3::Z][axis]);
            let (friction, stuck) = (f32x8::ZERO, Vector::zero());
            space.pulls.push(Pull {
                node: point,
                normal,
                reach,
                stiffness,
                one_sided: false,
                friction,
                stuck,
            });
        }
    }

    fn solve_part(&self, space: &mut Workspace, planes: &mut [Plane]) {
        let Workspace { carried, sections, work, .. } = space;
        work.begin(|index| carried[index + 1] - carried[index], |index| sections[index]);
        let settings = StepSettings {
            time_step: self.parts.time_step,
            newton_steps: self.parts.settings.newton_steps,
            tolerance: TOLERANCE,
            damping: f64::from(self.parts.settings.damping),
        };
        let solved = work.solve(self.nodes, &space.pulls, &settings);
        for (point, carried) in space.carried.iter_mut().enumerate() {
            let [x, y, z, _] = space.work.moved[point];
            *carried = *carried + Vector::new(x, y, z);
        }
        space.project.project(&mut space.carried, &space.inverse_mass, &space.length, LENGTH_ROUNDS);
        self.place(space, planes);
        self.take(space, &solved);
    }

    /// Lengths to the last bit, from root to tip, outside the solids.
    fn place(&self, space: &mut Workspace, planes: &mut [Plane]) {
        for (placed, point) in space.placed.iter_mut().zip(&space.carried) {
            store(*point, placed);
        }
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
            last_rooted: f32x8::from(last_rooted),
            solids: &self.parts.solids,
        };
        follow.place(&mut space.placed, planes, &mut space.corrections);
        for (placed, point) in space.placed.iter().zip(&mut space.carried) {
            *point = load(placed);
        }
    }

    /// The new state: velocities are what takes the points there; strands at rest stay.
    fn take(&self, space: &mut Workspace, solved: &Solved<f32x8>) {
        let last = self.nodes.len() - 1;
        let per_step = f32x8::of(1.0 / self.parts.time_step);
        let (mut largest, mut nothing) = (f32x8::ZERO, f32x8::ZERO);
        for point in 0..=last {
            let moved = space.carried[point] - space.points[point];
            let square = moved.dot(moved);
            largest = largest.fast_max(square);
            // 0 for finite numbers, else not a number.
            nothing += (square + space.velocities[point].dot(space.velocities[point])) * f32x8::ZERO;
        }
        let bad = nothing.is_nan();
        space.bad |= bad;
        // 1 where the strand moves.
        let limit = f32x8::splat(if self.parts.moved { -1.0 } else { still(self.parts.time_step) });
        let moves = (largest.simd_gt(limit) | bad).bitselect(f32x8::of(1.0), f32x8::ZERO);
        for point in 0..=last {
            let moved = space.carried[point] - space.points[point];
            space.velocities[point] = Vector::choose(moves, moved * per_step, Vector::zero());
            space.points[point] = Vector::choose(moves, space.carried[point], space.points[point]);
            let [.., angle] = space.work.moved[point];
            space.spins[point] = moves.choose(angle * per_step, f32x8::ZERO);
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

/// The same vector for the stages of the thesis.
#[inline(always)]
fn pass(vector: Vector<f32x8>) -> vec3x8::Vec3x8 {
    Vec3x8 { x: vector.x, y: vector.y, z: vector.z }
}
