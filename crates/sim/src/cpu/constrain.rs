//! Lengths, bends and solids, then v* = (x* - x) / dt [Mueller2007; Chen2011 §4.1].

use strandline_base::par::prelude::*;
use strandline_body::BodyFrame;
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use super::Scratch;
use super::advance::{Block, NonFinite, recover};
use super::length_pass::Follow;
use super::spans::Spans;
use crate::contact::Obstacles;
use crate::contact::contacts::{Care, Query, Solids};
use crate::contact::planes::Plane;
use crate::contact::touch::Touch;
use crate::grab::Pinned;
use crate::strands::constrain::angles::{Bends, Joints, ROUNDS_PER_PASS};
use crate::strands::constrain::lengths::Segments;
use crate::{Model, State};
use strandline_base::vec3x8::{Vec3x8, load, splat};

/// Projects the predicted positions onto the constraints and derives the velocities from them.
///
/// All rounds of a block of strands run one after the other, so that its points stay in the first
/// cache. Returns the points that were not finite; their strands are back at rest, so that they
/// do not spoil the volume.
pub fn constrain(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    obstacles: &Obstacles,
) -> NonFinite {
    let points = model.points_per_strand;
    let settings = &model.settings;
    let solids = Solids::new(obstacles, points);
    let bends = Bends::new(
        &settings.strands.constrain.angles,
        settings.time_step,
        settings.strands.constrain.iterations,
        obstacles.end.world_from_head().rotation,
    );
    let (lengths, masses, grab) = (&state.lengths.stretch, &scratch.masses, &state.grab);
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points).zip(state.corrections.par_chunks_mut(points)))
        .zip(state.positions.par_chunks_mut(points))
        .zip(state.contacts.blocks.par_iter_mut())
        .enumerate()
        .with_min_len(8)
        .map_init(
            || Workspace::new(points),
            |work, (block, (((predicted, (velocities, corrections)), start), planes))| {
                let range = block * points..(block + 1) * points;
                let strands = Strands {
                    model,
                    bends: bends.map(|bends| from_roots(bends, model, &obstacles.end, block)),
                    segments: Segments {
                        lengths: &lengths[range.clone()],
                        share_lower: &masses.share_lower[range.clone()],
                        share_upper: &masses.share_upper[range.clone()],
                    },
                    joints: Joints {
                        directions: &model.directions[range.clone()],
                        inverse_mass: &masses.inverse_mass[range],
                    },
                    solids: &solids,
                };
                work.pinned.clear();
                let Segments { lengths, .. } = strands.segments;
                work.pinned.extend(grab.pinned(block, predicted, lengths, strands.joints.inverse_mass));
                let mut hair = Block { positions: predicted, previous: start, velocities, corrections };
                strands.solve(block, &mut hair, planes, work);
                recover(model, &obstacles.end, block, hair)
            },
        )
        .reduce(NonFinite::default, NonFinite::with)
}

/// The bends of a block of strands, from its root frames where the body has them.
fn from_roots(bends: Bends, model: &Model, body: &BodyFrame, block: usize) -> Bends {
    match body.roots() {
        Some(_) => bends.with_roots(model.roots(body, block).map(|root| root.rotation)),
        None => bends,
    }
}

/// Rounds from one look for points that were carried beside their planes to the next.
const ROUNDS_PER_LOOK: u32 = 5;

/// Scratch of a thread.
struct Workspace {
    pinned: Vec<Pinned>,
    /// Solid near each point, if there is one.
    touches: Vec<Option<Touch>>,
    /// Way \[m\] that friction may still take each point back in this step.
    friction: Vec<f32x8>,
    /// Predicted positions \[m\].
    predicted: Vec<Vec3x8>,
    margins: Vec<f32x8>,
    /// Motion of each point by the length pass \[m\], and a zero behind the last.
    corrections: Vec<Vec3x8>,
    spans: Spans,
    /// Points of strands that the rounds leave alone.
    kept: Vec<Vec3Lanes>,
}

impl Workspace {
    fn new(points: usize) -> Self {
        Self {
            pinned: Vec::with_capacity(LANES),
            touches: vec![None; points],
            friction: vec![splat(0.0); points],
            predicted: vec![Vec3x8::ZERO; points],
            margins: vec![splat(0.0); points],
            corrections: vec![Vec3x8::ZERO; points + 1],
            spans: Spans::new(points),
            kept: vec![Vec3Lanes::default(); points],
        }
    }
}

/// One block of strands.
struct Strands<'a> {
    model: &'a Model,
    bends: Option<Bends>,
    segments: Segments<'a>,
    joints: Joints<'a>,
    solids: &'a Solids<'a>,
}

impl Strands<'_> {
    fn solve(&self, block: usize, hair: &mut Block, planes: &mut [Plane], work: &mut Workspace) {
        let Block { positions: predicted, previous: start, velocities, corrections } = hair;
        let pass = &self.model.settings.strands.constrain.length_pass;
        work.spans.find(self.joints.inverse_mass, work.pinned.iter().map(|held| (held.lane, held.point)));
        let spanned = if pass.enabled { work.spans.held_behind } else { splat(0.0) };
        for round in 0..self.model.settings.strands.constrain.iterations {
            if round % ROUNDS_PER_LOOK == 0 {
                self.find_touches(block, round == 0, predicted, start, planes, work);
            }
            self.segments.project_all_but(spanned, predicted, &mut work.kept);
            if let Some(bends) = self.bends.filter(|_| round % ROUNDS_PER_PASS == 0) {
                bends.project(self.joints, predicted);
            }
            for Pinned { lane, point, goal } in &work.pinned {
                predicted[*point].set(*lane, *goal);
            }
            work.resolve_touches(predicted);
        }
        if !self.model.settings.strands.constrain.length_pass.enabled {
            // Nothing follows: what the rounds moved far has its last look here.
            self.find_touches(block, false, predicted, start, planes, work);
            work.resolve_touches(predicted);
        }
        work.corrections.fill(Vec3x8::ZERO);
        if pass.enabled {
            if spanned.any() {
                work.spans.solve(self.segments.lengths, start, &work.touches, predicted);
            }
            let follow = Follow {
                lengths: self.segments.lengths,
                margins: &work.margins,
                sinks: f32x8::ZERO,
                last_rooted: work.spans.last_rooted,
                solids: self.solids,
            };
            follow.place(predicted, planes, &mut work.corrections);
        }
        let rate = splat(1.0 / self.model.settings.time_step);
        let returned = rate * splat(-pass.correction);
        for point in 0..predicted.len() {
            let moved = Vec3x8::load(&predicted[point]) - Vec3x8::load(&start[point]);
            (moved * rate).store(&mut velocities[point]);
            // [Mueller2012 eq. 9]
            let free = load(&self.joints.inverse_mass[point]).simd_gt(splat(0.0));
            let correction = work.corrections[point + 1] * returned;
            correction.or(free, Vec3x8::ZERO).store(&mut corrections[point]);
        }
    }

    /// Finds the planes that the free points of the block may touch in this step: those of the
    /// predictions first, later those of points that the rounds have carried beside theirs. Points that a
    /// solid stopped on their way are put where it did.
    fn find_touches(
        &self,
        block: usize,
        is_first: bool,
        predicted: &mut [Vec3Lanes],
        start: &[Vec3Lanes],
        planes: &mut [Plane],
        work: &mut Workspace,
    ) {
        if self.solids.is_empty() {
            return;
        }
        let settings = &self.model.settings;
        let mut care =
            if settings.strands.constrain.length_pass.enabled { Care::ROUGH } else { Care::ROUNDS };
        if !is_first {
            // The planes that points have left are what this look is for, also those of where a solid
            // stopped them.
            care.stale = 0.0;
        }
        let most = splat(settings.collision_margin);
        let clearance = &self.model.rest_clearance[block * predicted.len()..];
        for point in 0..predicted.len() {
            let free = load(&self.joints.inverse_mass[point]).simd_gt(splat(0.0));
            let (position, start) = (Vec3x8::load(&predicted[point]), Vec3x8::load(&start[point]));
            if is_first {
                work.margins[point] = most.fast_min(load(&clearance[point]));
                work.predicted[point] = position;
                (work.touches[point], work.friction[point]) = (None, splat(0.0));
            }
            let moved = (position - work.predicted[point]).length();
            let looked = if is_first { free } else { free & moved.simd_gt(splat(care.near)) };
            if !looked.any() {
                continue;
            }
            let margin = work.margins[point];
            let query = Query { position, start: Some(start), margin, free: looked, care, part: 0 };
            let found = self.solids.touch(planes, point, query);
            if let Some(touch) = &found {
                touch.place.or(looked, position).store(&mut predicted[point]);
                if is_first {
                    work.friction[point] = touch.friction_of(position);
                }
            }
            work.touches[point] = match (found, work.touches[point]) {
                (Some(found), Some(old)) => Some(found.or(looked, &old)),
                (Some(found), None) => Some(found.except(!looked)),
                (None, old) => old.map(|old| old.except(looked)),
            };
        }
    }
}

impl Workspace {
    fn resolve_touches(&mut self, predicted: &mut [Vec3Lanes]) {
        for ((position, touch), left) in predicted.iter_mut().zip(&self.touches).zip(&mut self.friction) {
            if let Some(touch) = touch {
                touch.resolve(Vec3x8::load(position), left).store(position);
            }
        }
    }
}
