//! Exact lengths from root to tip, outside the solids \[Mueller2012\].

use glam::Vec3;
use strandline_body::turned_out;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use crate::contact::contacts::{Care, Query, Solids};
use crate::contact::planes::Plane;
use crate::contact::touch::Touch;
use strandline_base::vec3x8::{Vec3x8, load, splat};

/// Times that a point is placed again at most when the solid under it curves: enough for an ear.
const PLACINGS: usize = 8;
/// Share of a length that rounding makes of it: of strands whose segments are moved no more is taken out.
const SAME_LENGTH: f32 = 2.5e-7;
/// Depth \[m\] inside its margin that a point may keep.
const TOLERATED: f32 = 2e-4;

/// One block of strands as the pass sees it.
pub struct Follow<'a> {
    pub lengths: &'a [Lanes],
    /// Distance \[m\] that points keep from solids.
    pub margins: &'a [f32x8],
    /// Depth \[m\] that points may stay inside it.
    pub sinks: f32x8,
    /// Last rooted point of each strand, -1 without one; points before it stay.
    pub last_rooted: f32x8,
    pub solids: &'a Solids<'a>,
}

impl Follow<'_> {
    /// Moves each point to its length from the point before, and returns the distance moved \[m\].
    ///
    /// Solids push points out last, which is no correction of a length that gives velocity back.
    pub fn place(&self, positions: &mut [Vec3Lanes], planes: &mut [Plane], corrections: &mut [Vec3x8]) {
        corrections[0] = Vec3x8::ZERO;
        let mut before = Vec3x8::load(&positions[0]);
        for point in 1..positions.len() {
            let found = Vec3x8::load(&positions[point]);
            let free = splat(point as f32).simd_gt(self.last_rooted);
            let length = load(&self.lengths[point - 1]);
            let across = found - before;
            let mut placed = before + across * (length / across.length());
            corrections[point] = (placed - found).or(free, Vec3x8::ZERO);
            if !self.solids.is_empty() && free.any() {
                placed = self.out_of_solids(point, before, placed, planes);
            }
            let placed = placed.or(free, found);
            placed.store(&mut positions[point]);
            before = placed;
        }
    }
}

impl Follow<'_> {
    /// Moves each point to its length from the one before. A point lies at its `start` and `moved` from there \[m\],
    /// which alone changes: a small motion is not rounded as a position is.
    pub fn place_moved(&self, start: &[Vec3x8], moved: &mut [Vec3x8], planes: &mut [Plane]) {
        for point in 1..start.len() {
            let free = splat(point as f32).simd_gt(self.last_rooted);
            let length = load(&self.lengths[point - 1]);
            let across = start[point] - start[point - 1] + (moved[point] - moved[point - 1]);
            let missing = length / across.length() - splat(1.0);
            let wrong = missing.abs().simd_gt(splat(SAME_LENGTH));
            let mut there = moved[point] + across * (missing & wrong);
            if !self.solids.is_empty() && free.any() {
                let before = start[point - 1] + moved[point - 1];
                let placed = start[point] + there;
                let out = self.out_of_solids(point, before, placed, planes);
                there += out - placed;
            }
            moved[point] = there.or(free, moved[point]);
        }
    }

    /// Position of a point at its length from `before` and outside the solids.
    fn out_of_solids(&self, point: usize, before: Vec3x8, first: Vec3x8, planes: &mut [Plane]) -> Vec3x8 {
        let (margin, length) = (self.margins[point] - self.sinks, load(&self.lengths[point - 1]));
        let free = splat(point as f32).simd_gt(self.last_rooted);
        let mut placed = first;
        for placing in 0..PLACINGS {
            let care = if placing == 0 { Care::EXACT } else { Care::ANEW };
            let query = Query { position: placed, start: None, margin, free, care, part: 0 };
            let touch = self.solids.touch(planes, point, query);
            let Some(touch) = touch.filter(|touch| touch.height(placed).simd_lt(splat(-1e-6)).any()) else {
                return placed;
            };
            placed = outside(&touch, before, placed, length);
        }
        let (mut from, mut here) = (Vec3Lanes::default(), Vec3Lanes::default());
        before.store(&mut from);
        placed.store(&mut here);
        for lane in (0..LANES).filter(|lane| point as f32 > self.last_rooted.to_array()[*lane]) {
            let (before, end) = (from.get(lane), here.get(lane));
            let kept = margin.to_array()[lane] - TOLERATED;
            let is_out = |place: Vec3| self.solids.nearest(place).0 > kept;
            if !is_out(end) {
                here.set(lane, turned_out(before, end, self.solids.nearest(before).1, is_out));
            }
        }
        Vec3x8::load(&here)
    }
}

/// The nearest place on a plane that lies at a distance from `before`, where `placed` is below the
/// plane; the farthest place out when the plane is out of reach.
#[inline(always)]
fn outside(touch: &Touch, before: Vec3x8, placed: Vec3x8, length: f32x8) -> Vec3x8 {
    let below = touch.height(placed).simd_lt(splat(0.0));
    let rise = (-touch.height(before)).fast_min(length);
    let across = placed - before;
    let mut aside = across - touch.normal * touch.normal.dot(across);
    let straight = below & aside.length().simd_lt(length * splat(1e-3));
    if straight.any() {
        // Straight at the plane: any way along it.
        let steep = touch.normal.x.abs().simd_gt(splat(0.7));
        let axis = Vec3x8::splat(Vec3::Y).or(steep, Vec3x8::splat(Vec3::X));
        aside = touch.normal.cross(axis).or(straight, aside);
    }
    let reach = (length * length - rise * rise).fast_max(splat(0.0)).sqrt();
    let moved = before + touch.normal * rise + aside * (reach / aside.length());
    moved.or(below, placed)
}
