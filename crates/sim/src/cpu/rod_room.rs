//! One block of rods among others: Newton steps with what holds its points, and rounds with their factors kept.

use glam::Vec3;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::rod_strands::Hair;
use crate::contact::planes::Plane;
use crate::grab::Pinned;
use crate::strands::rods::real::{Real, Vector};
use crate::strands::rods::rod::{Solved, StepSettings};
use crate::strands::rods::rounds::Push;
use crate::strands::rods::workspace::Workspace;
use crate::wisps::pair::Near;

/// A pair of a block: its index in the list, which of both segments is the block's own, and the point, the lane and the share
/// of its place there.
#[derive(Clone, Copy)]
struct Touch {
    pair: u32,
    side: u32,
    point: u32,
    lane: u32,
    share: f32,
}

/// One block of strands among others.
#[derive(Clone)]
pub(super) struct Room {
    pub(super) space: Workspace,
    settings: StepSettings<f32x8>,
    pub(super) pinned: Vec<Pinned>,
    /// Pairs of the block.
    touches: Vec<Touch>,
    /// Stiffness \[N/m\] that holds each point, and by which it holds the next; shape `[point]` of lanes.
    own: Vec<Lanes>,
    next: Vec<Lanes>,
    /// Forces \[N\] and steps \[m\], shape `[point]`.
    forces: Vec<Vec3Lanes>,
    pushes: Vec<Push<f32x8>>,
    steps: Vec<Vector<f32x8>>,
    /// Above 0: strands that have pairs, that are not solved, and whose last Newton step was whole.
    meets: f32x8,
    open: f32x8,
    whole: f32x8,
    /// Force \[N\] of what presses a strand, and largest turn \[rad\] of its last Newton step.
    pressed: f32x8,
    turn: f32x8,
}

impl Room {
    pub(super) fn new(points: usize) -> Self {
        let zero = Vector::zero();
        Self {
            space: Workspace::new(points),
            settings: StepSettings { time_step: 0.0, newton_steps: 0, tolerance: 0.0, viscous: f32x8::ZERO },
            pinned: Vec::new(),
            touches: Vec::new(),
            own: vec![Lanes::default(); points],
            next: vec![Lanes::default(); points],
            forces: vec![Vec3Lanes::default(); points],
            pushes: vec![Push::zero(); points],
            steps: vec![zero; points],
            meets: f32x8::ZERO,
            open: f32x8::ZERO,
            whole: f32x8::ZERO,
            pressed: f32x8::ZERO,
            turn: f32x8::ZERO,
        }
    }
}

impl Room {
    /// Forgets the pairs.
    pub(super) fn part_from_all(&mut self) {
        self.touches.clear();
    }

    /// Takes note of a pair by its index in the list, with a side whose segment is the block's.
    pub(super) fn meet(&mut self, pair: usize, near: &Near, side: usize) {
        let segment = near.segments[side] as usize;
        self.touches.push(Touch {
            pair: pair as u32,
            side: side as u32,
            point: (segment / LANES % self.own.len()) as u32,
            lane: (segment % LANES) as u32,
            share: near.shares[side],
        });
    }

    pub(super) fn begin(
        &mut self,
        hair: &Hair,
        planes: &mut [Plane],
        block: usize,
        part: u32,
        (start, coast): (&mut [Vec3Lanes], &mut [Vec3Lanes]),
    ) {
        let strands = hair.strands(block);
        let space = &mut self.space;
        self.settings = strands.begin_part(space, planes, &self.pinned, part);
        for (point, node) in strands.nodes.iter().enumerate() {
            space.points[point].store(&mut start[point]);
            let rides = space.carried[point] - space.points[point];
            Vector::choose(node.free, rides + space.coast[point], rides).store(&mut coast[point]);
        }
    }

    /// Begins Newton's method, and finds how stiffly rounds hold the points. Strands without pairs forget their tension
    /// unless a solid presses them hard, as strands alone do: strands of the same block do not affect each other.
    pub(super) fn hold(&mut self, near: &[Near], hair: &Hair, block: usize, ways: &mut [Vec3Lanes]) {
        (self.open, self.pressed, self.whole) = (f32x8::of(1.0), f32x8::ZERO, f32x8::ZERO);
        let mut meets = [0.0; LANES];
        if !self.touches.is_empty() {
            self.own.fill(Lanes::default());
            self.next.fill(Lanes::default());
            for touch in &self.touches {
                let (point, lane, share) = (touch.point as usize, touch.lane as usize, touch.share);
                let stiffness = near[touch.pair as usize].holds[touch.side as usize];
                self.own[point].0[lane] += stiffness * (1.0 - share) * (1.0 - share);
                self.own[point + 1].0[lane] += stiffness * share * share;
                self.next[point].0[lane] += stiffness * share * (1.0 - share);
                meets[lane] = 1.0;
            }
            self.space.prepare(hair.strands(block).nodes, self.settings.viscous);
            self.give_ways(ways);
        }
        self.meets = f32x8::from(meets);
        self.space.forget_tensions(self.meets.or_more(self.space.loaded));
    }

    /// Sums a force of each pair at the points.
    fn gather(&mut self, near: &[Near], force: fn(&Near) -> Vec3) {
        self.forces.fill(Vec3Lanes::default());
        for touch in &self.touches {
            let (point, lane, share) = (touch.point as usize, touch.lane as usize, touch.share);
            let force = force(&near[touch.pair as usize]);
            let force = if touch.side == 0 { force } else { -force };
            for (point, share) in [(point, 1.0 - share), (point + 1, share)] {
                let sum = &mut self.forces[point];
                sum.set(lane, sum.get(lane) + force * share);
            }
        }
    }

    /// Finds the forces of others on each point, and the stiffness that holds it, for a Newton step.
    fn find_pushes(&mut self) {
        let last = self.steps.len() - 1;
        for point in 0..=last {
            let (own, next) = (f32x8::new(self.own[point].0), f32x8::new(self.next[point].0));
            let mut held = self.steps[point] * own;
            if point < last {
                held += self.steps[point + 1] * next;
            }
            if point > 0 {
                held += self.steps[point - 1] * f32x8::new(self.next[point - 1].0);
            }
            self.pushes[point] = Push { force: Vector::load(&self.forces[point]) + held, own, next };
        }
    }

    /// A Newton step.
    pub(super) fn push(
        &mut self,
        near: &[Near],
        hair: &Hair,
        block: usize,
        newton: u32,
        (ways, coast): (&mut [Vec3Lanes], &[Vec3Lanes]),
    ) {
        let strands = hair.strands(block);
        if self.touches.is_empty() {
            return;
        }
        self.gather(near, |near| near.given);
        for (point, step) in self.steps.iter_mut().enumerate() {
            // Rounds begin with hair that keeps its velocity.
            let from = if newton == 0 {
                Vector::load(&coast[point]) - Vector::load(&ways[point])
            } else {
                Vector::zero()
            };
            *step = Vector::choose(self.meets, from, Vector::zero());
        }
        self.find_pushes();
        let first = newton == 0;
        let open = [self.open, self.meets];
        let turned = self.space.push(strands.nodes, &self.pushes, &self.settings, first, open);
        self.give_ways(ways);
        if first {
            for (point, step) in self.steps.iter_mut().enumerate() {
                *step = Vector::load(&ways[point]) - Vector::load(&coast[point]);
            }
            self.space.set_held(&self.steps);
        }
        self.pressed = self.open.choose(turned.pressed, self.pressed);
        self.turn = self.open.choose(turned.turn, self.turn);
        self.whole = self.meets.choose(turned.whole, f32x8::ZERO);
        let more = turned.turn - f32x8::of(self.settings.tolerance);
        let more = if first { turned.pressed.choose(f32x8::of(1.0), more) } else { more };
        let alone = self.open.choose(more.choose(f32x8::of(1.0), f32x8::ZERO), f32x8::ZERO);
        self.open = self.meets.choose(f32x8::of(1.0), alone);
    }

    /// A round: the answer to the change of forces.
    pub(super) fn round(&mut self, near: &[Near], hair: &Hair, block: usize, ways: &mut [Vec3Lanes]) {
        if self.touches.is_empty() {
            return;
        }
        self.gather(near, |near| near.change);
        self.space.round(hair.nodes(block), (&self.pushes, &self.forces), self.whole, ways);
    }

    /// Takes the steps of the rounds.
    pub(super) fn settle(&mut self) {
        if self.touches.is_empty() {
            return;
        }
        self.space.settle(self.whole);
    }

    fn give_ways(&self, ways: &mut [Vec3Lanes]) {
        let space = &self.space;
        for (point, way) in ways.iter_mut().enumerate() {
            let [x, y, z, _] = space.work.moved[point];
            (Vector::new(x, y, z) + (space.carried[point] - space.points[point])).store(way);
        }
    }

    pub(super) fn end(&mut self, hair: &Hair, planes: &mut [Plane], block: usize, near: &[Near]) {
        let strands = hair.strands(block);
        let solved = if self.touches.is_empty() {
            self.space.solve(strands.nodes, &self.settings)
        } else {
            self.space.give();
            let mut pressed = self.pressed.to_array();
            for touch in &self.touches {
                let (near, lane) = (&near[touch.pair as usize], touch.lane as usize);
                pressed[lane] = pressed[lane].max(near.normal.dot(near.force).abs());
            }
            self.space.work.step.fill([f32x8::ZERO; 4]);
            Solved {
                steps: self.settings.newton_steps,
                unsolved: (self.turn - f32x8::of(self.settings.tolerance)).fast_max(f32x8::ZERO),
                residual: self.turn,
                pressed: f32x8::from(pressed),
            }
        };
        strands.end_part(&mut self.space, planes, &solved);
    }
}
