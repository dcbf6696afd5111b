//! Planes on a skin that moves by itself: they ride its triangles from step to step.
//!
//! A plane near the skin moves with its triangle, so that hair which rests there asks for no distance. The distance of a
//! point far from it stays a lower bound when the most that a vertex near it moves is taken off: a head that turns on
//! shoulders asks nothing for the hair on it. The values that a plane needs for this, its
//! rider, lie in a further plane for each point, behind those of all carriers.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::{Vec3x8, load, splat};
use strandline_body::PosedSkin;
use strandline_groom::{LANES, Vec3Lanes};

use super::contacts::{Care, Group, Solids};
use super::planes::{Contacts, Plane, Rider};

/// Distance \[m\] from the skin within which a plane rides a triangle.
const CLOSE: f32 = 0.02;
/// Sum \[m\] of what riding may have moved a plane off its place before it is looked up again, and the parts of the error
/// of a triangle's motion and of the most that a vertex moves, for which another part of the skin may have come near.
const MOST_OFF: f32 = 5e-4;
const OF_ERROR: f32 = 2.0;
const OF_SHIFT: f32 = 0.02;
/// Distance \[m\] beyond the margin of points from which on a plane that riding has moved off its place stays as a bound that is so
/// much less: what a point moves before a look.
const LOOSE: f32 = Care::ROUGH.stale + 1e-3;
/// Way \[m\] of the skin about a plane through a step below which the plane stays where it is.
const STILL: f32 = 1e-6;
/// Most that a vertex may move \[m\] where planes stay: their triangles end within reach of where they were.
const SLOW: f32 = 0.03;

impl Group<'_> {
    /// Way \[m\] of the material under points of one index through the step beside that of the carrier, world space.
    pub(super) fn along(&self, rider: Option<&Plane>) -> Option<Vec3x8> {
        rider.map(|rider| self.world_from_carrier.directions(Vec3x8::load(&rider.anchor)))
    }

    /// Depth \[m\] of points of one index inside a group with a skin; their planes tell which are outside for certain. Sides of
    /// the skin are exact: outside a fold that crosses itself contacts have a few points inside, which this counts as outside.
    pub(super) fn depth_on(
        &self,
        position: Vec3x8,
        plane: &Plane,
        rider: Option<&Plane>,
        counted: impl Fn(usize) -> bool,
    ) -> f32 {
        let local = self.carrier_from_world.points(position);
        let moved = (local - Vec3x8::load(&plane.anchor)).length();
        let is_near = (load(&plane.distance) - moved).simd_le(splat(0.0)).to_bitmask();
        let mut here = Vec3Lanes::default();
        local.store(&mut here);
        let lanes = (0..LANES).filter(|lane| is_near & (1 << lane) != 0 && counted(*lane));
        let depths = lanes.map(|lane| {
            let triangle = rider.map_or(PosedSkin::UNKNOWN, |rider| rider.friction.0[lane].to_bits());
            self.deepest(here.get(lane), triangle)
        });
        depths.fold(0.0, f32::max)
    }
}

impl Contacts {
    /// Carries the planes on skins from the start of a step to its end, of points that keep a margin \[m\].
    pub fn ride(&mut self, solids: &Solids, margin: f32) {
        let loose = LOOSE + margin;
        let points = solids.points();
        let skins: Vec<(usize, &PosedSkin)> = solids.skins().collect();
        if skins.is_empty() {
            return;
        }
        let carriers = solids.carrier_count();
        self.blocks.par_iter_mut().for_each(|planes| {
            let (planes, riders) = planes.split_at_mut(carriers * points);
            for (group, skin) in &skins {
                let planes = &mut planes[group * points..(group + 1) * points];
                planes
                    .iter_mut()
                    .zip(riders.iter_mut())
                    .for_each(|(plane, rider)| ride(plane, rider, skin, loose));
            }
        });
    }
}

fn ride(plane: &mut Plane, rider: &mut Plane, skin: &PosedSkin, loose: f32) {
    let most = skin.most_shift();
    let shifts = if most == 0.0 { [0.0; LANES] } else { skin.shifts_about(&plane.anchor) };
    for (lane, shift) in shifts.into_iter().enumerate() {
        if !plane.distance.0[lane].is_finite() {
            continue;
        }
        let triangle = Rider(rider).triangle(lane);
        let anchor = plane.anchor.get(lane);
        if most == 0.0 {
            rider.anchor.set(lane, Vec3::ZERO);
            continue;
        }
        let distance = plane.distance.0[lane];
        if distance > CLOSE {
            plane.distance.0[lane] = skin.at_least_after(distance, shift);
            rider.anchor.set(lane, skin.drift(triangle));
            continue;
        }
        if shift < STILL && most < SLOW {
            rider.anchor.set(lane, Vec3::ZERO);
            rider.distance.0[lane] += (OF_ERROR + OF_SHIFT) * shift;
            is_kept(plane, rider, lane, loose);
            continue;
        }
        let Some(motion) = skin.motion(triangle, anchor) else {
            plane.forget(lane);
            rider.anchor.set(lane, Vec3::ZERO);
            continue;
        };
        let carried = motion.point(anchor);
        rider.anchor.set(lane, carried - anchor);
        rider.distance.0[lane] += OF_ERROR * motion.error + OF_SHIFT * shift;
        if !is_kept(plane, rider, lane, loose) {
            continue;
        }
        plane.anchor.set(lane, carried);
        plane.normal.set(lane, motion.direction(plane.normal.get(lane)));
    }
}

/// True for a plane that riding has left where it was, or whose point is far enough that it serves as a bound; else it is
/// forgotten.
fn is_kept(plane: &mut Plane, rider: &mut Plane, lane: usize, loose: f32) -> bool {
    let off = rider.distance.0[lane];
    if off <= MOST_OFF {
        return true;
    }
    let least = plane.distance.0[lane] - off;
    if least > loose {
        (plane.distance.0[lane], rider.distance.0[lane]) = (least, 0.0);
        return true;
    }
    plane.forget(lane);
    false
}
