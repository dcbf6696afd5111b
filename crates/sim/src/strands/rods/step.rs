//! The stage: rods of all strands through a step, in parts, then outside the solids at exact lengths.

use glam::Vec3;
use rayon::prelude::*;
use strandline_body::Pose;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::lengths::Lengths;
use super::model::{Rods, all, load, store};
use super::real::{Real, Vector};
use super::rod::{Node, Pull, StepSettings, Work};
use super::settings::RodSettings;
use crate::cpu::Obstacles;
use crate::cpu::advance::{Block, NonFinite, recover};
use crate::cpu::contacts::{Care, Plane, Query, Solids};
use crate::cpu::integrate::Fall;
use crate::cpu::length_pass::Follow;
use crate::cpu::vec3x8::{self, Vec3x8};
use crate::grab::Pinned;
use crate::solver::carried;
use crate::{Solver, State};

/// Stiffness of a contact or a pin over the mass of its point and the square of the step: what rests on a
/// solid sinks in by a thousandth of its fall in a step.
const STIFF: f64 = 1e3;
/// Rounds of the projection onto lengths.
const LENGTH_ROUNDS: u32 = 2;
/// A strand is solved when a Newton step turns none of its segments farther \[rad\].
const TOLERANCE: f64 = 1e-4;
/// Most that a point of a strand at rest moves in a part of a step \[m\]: a few roundings of single precision a
/// metre away. Below, the strand stays where it is to the bit.
const STILL: f64 = 5e-7;

/// Forces, elasticity, lengths and solids: writes the predicted positions, the sections and the
/// velocities. Returns the number of points that were not finite; their strands are back at rest.
pub(crate) fn solve_rods(
    solver: &Solver,
    rods: &Rods,
    state: &mut State,
    obstacles: &Obstacles,
    wind: Vec3,
) -> NonFinite {
    let points = solver.points_per_strand;
    let settings = &solver.settings.strands.rods;
    if state.sections.len() != rods.sections.len() {
        // The solver was another one so far: sections as at rest, put upright where a part begins.
        let turn = Pose { translation: Vec3::ZERO, ..state.world_from_head };
        state.sections = rods.sections.iter().map(|lanes| carried(lanes, &turn)).collect();
        state.spins = vec![Lanes::default(); rods.sections.len()];
    }
    let parts = Parts::new(solver, settings, obstacles, wind);
    let (scratch, grab) = (&mut state.scratch, &state.grab);
    let lengths = &scratch.lengths.stretch;
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks_mut(points))
        .zip(scratch.contacts.blocks.par_iter_mut())
        .zip(state.sections.par_chunks_mut(points))
        .zip(state.spins.par_chunks_mut(points))
        .zip(state.corrections.par_chunks_mut(points))
        .enumerate()
        .with_min_len(8)
        .map_init(
            || Workspace::new(points),
            |work, (block, ((((((predicted, velocities), start), planes), sections), spins), corrections))| {
                let range = block * points..(block + 1) * points;
                let strands = Strands {
                    solver,
                    parts: &parts,
                    nodes: &rods.nodes[range.clone()],
                    lengths: &lengths[range.clone()],
                    inverse_mass: &solver.inverse_mass[range.clone()],
                    rest: &solver.positions[range.clone()],
                    clearance: &solver.rest_clearance[range.clone()],
                    rest_sections: &rods.sections[range],
                };
                work.load(start, velocities, sections, spins);
                let pinned: Vec<Pinned> =
                    grab.pinned(block, predicted, strands.lengths, strands.inverse_mass).collect();
                strands.solve(work, planes, &pinned);
                work.store(predicted, velocities, sections, spins);
                corrections.fill(Vec3Lanes::default());
                let hair = Block { positions: predicted, previous: start, velocities, corrections };
                recover(solver, &obstacles.end, block, hair)
            },
        )
        .reduce(NonFinite::default, NonFinite::with)
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

/// Rigid motion of all lanes.
struct Carry {
    columns: [Vector<f32x8>; 3],
    translation: Vector<f32x8>,
}

impl Carry {
    fn new(pose: &Pose) -> Self {
        let columns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| all(pose.direction(axis)));
        Self { columns, translation: all(pose.translation) }
    }

    #[inline(always)]
    fn direction(&self, vector: Vector<f32x8>) -> Vector<f32x8> {
        self.columns[0] * vector.x + self.columns[1] * vector.y + self.columns[2] * vector.z
    }

    #[inline(always)]
    fn point(&self, point: Vector<f32x8>) -> Vector<f32x8> {
        self.direction(point) + self.translation
    }
}

/// What a thread works in.
struct Workspace {
    points: Vec<Vector<f32x8>>,
    velocities: Vec<Vector<f32x8>>,
    sections: Vec<Vector<f32x8>>,
    spins: Vec<f32x8>,
    /// The shape that the head carried along: where a part begins.
    carried: Vec<Vector<f32x8>>,
    /// How far forces alone would take the points from there.
    wanted: Vec<Vector<f32x8>>,
    pulls: Vec<Pull<f32x8>>,
    margins: Vec<f32x8>,
    placed: Vec<Vec3Lanes>,
    corrections: Vec<Vec3x8>,
    inverse_mass: Vec<f32x8>,
    length: Vec<f32x8>,
    work: Work<f32x8>,
    project: Lengths<f32x8>,
}

impl Workspace {
    fn new(points: usize) -> Self {
        let (zero, none) = (Vector::zero(), f32x8::of(0.0));
        Self {
            points: vec![zero; points],
            velocities: vec![zero; points],
            sections: vec![zero; points],
            spins: vec![none; points],
            carried: vec![zero; points],
            wanted: vec![zero; points],
            pulls: Vec::with_capacity(4 * points),
            margins: vec![none; points],
            placed: vec![Vec3Lanes::default(); points],
            corrections: vec![Vec3x8::ZERO; points + 1],
            inverse_mass: vec![none; points],
            length: vec![none; points],
            work: Work::new(points),
            project: Lengths::new(points),
        }
    }

    fn load(
        &mut self,
        start: &[Vec3Lanes],
        velocities: &[Vec3Lanes],
        sections: &[Vec3Lanes],
        spins: &[Lanes],
    ) {
        for point in 0..start.len() {
            self.points[point] = load(&start[point]);
            self.velocities[point] = load(&velocities[point]);
            self.sections[point] = load(&sections[point]);
            self.spins[point] = f32x8::new(spins[point].0);
        }
    }

    fn store(
        &self,
        predicted: &mut [Vec3Lanes],
        velocities: &mut [Vec3Lanes],
        sections: &mut [Vec3Lanes],
        spins: &mut [Lanes],
    ) {
        for point in 0..predicted.len() {
            store(self.points[point], &mut predicted[point]);
            store(self.velocities[point], &mut velocities[point]);
            store(self.sections[point], &mut sections[point]);
            spins[point] = Lanes(self.spins[point].to_array());
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
}

impl Strands<'_> {
    fn solve(&self, space: &mut Workspace, planes: &mut [Plane], pinned: &[Pinned]) {
        for point in 0..self.nodes.len() {
            space.inverse_mass[point] = f32x8::new(self.inverse_mass[point].0);
            space.length[point] = f32x8::new(self.lengths[point].0);
        }
        for part in 0..self.parts.count {
            let (pose, moved) = &self.parts.poses[part as usize];
            self.want(space, &Carry::new(pose), moved);
            self.find_pulls(space, planes, pinned, part);
            self.solve_part(space, planes, pinned);
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
            let fallen = self.parts.fall.velocity(pass(space.velocities[point]), pass(tangent), Vec3x8::ZERO);
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
                    space.pulls.push(Pull {
                        node: point,
                        normal: Vector::new(touch.normal.x, touch.normal.y, touch.normal.z),
                        reach: near.bitselect(-height, f32x8::splat(-1.0)),
                        stiffness: (node.mass * stiff) & near,
                        one_sided: true,
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
            space.pulls.push(Pull { node: point, normal, reach, stiffness, one_sided: false });
        }
    }

    fn solve_part(&self, space: &mut Workspace, planes: &mut [Plane], pinned: &[Pinned]) {
        let Workspace { carried, sections, work, .. } = space;
        work.begin(|index| carried[index + 1] - carried[index], |index| sections[index]);
        let settings = StepSettings {
            time_step: self.parts.time_step,
            newton_steps: self.parts.settings.newton_steps,
            tolerance: TOLERANCE,
            damping: f64::from(self.parts.settings.damping),
        };
        work.solve(self.nodes, &space.pulls, &settings);
        for (point, carried) in space.carried.iter_mut().enumerate() {
            let [x, y, z, _] = space.work.moved[point];
            *carried = *carried + Vector::new(x, y, z);
        }
        space.project.project(&mut space.carried, &space.inverse_mass, &space.length, LENGTH_ROUNDS);
        self.place(space, planes, pinned);
        self.take(space);
    }

    /// Lengths to the last bit, from root to tip, outside the solids.
    fn place(&self, space: &mut Workspace, planes: &mut [Plane], pinned: &[Pinned]) {
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
        let mut last_held = last_rooted;
        pinned.iter().for_each(|pin| last_held[pin.lane] = last_held[pin.lane].max(pin.point as f32));
        let follow = Follow {
            lengths: self.lengths,
            margins: &space.margins,
            last_rooted: f32x8::from(last_rooted),
            last_held: f32x8::from(last_held),
            solids: &self.parts.solids,
        };
        follow.place(None, &mut space.placed, planes, &mut space.corrections);
        for (placed, point) in space.placed.iter().zip(&mut space.carried) {
            *point = load(placed);
        }
    }

    /// The new state: velocities are what takes the points there; strands at rest stay.
    fn take(&self, space: &mut Workspace) {
        let last = self.nodes.len() - 1;
        let per_step = f32x8::of(1.0 / self.parts.time_step);
        let mut largest = f32x8::ZERO;
        for point in 0..=last {
            let moved = space.carried[point] - space.points[point];
            largest = largest.fast_max(moved.dot(moved));
        }
        // 1 where the strand moves.
        let moves = largest - f32x8::of(if self.parts.moved { -1.0 } else { STILL * STILL });
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
        }
    }
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
