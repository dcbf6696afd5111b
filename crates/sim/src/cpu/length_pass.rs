//! Exact lengths from root to tip, outside the solids \[Mueller2012\].

use strandline_groom::{Lanes, Vec3Lanes};
use wide::f32x8;

use super::angles::Held;
use super::contacts::{Care, Plane, Query, Solids, Touch};
use super::vec3x8::{Vec3x8, load, splat};

/// Times that a point is placed anew at most when the solid under it curves: enough for an ear.
const PLACINGS: usize = 8;

/// One block of strands as the pass sees it.
pub struct Follow<'a> {
    pub lengths: &'a [Lanes],
    pub inverse_mass: &'a [Lanes],
    /// Distance \[m\] that points keep from solids.
    pub margins: &'a [f32x8],
    /// The point of each strand that is held by a hand, -1 where none is.
    pub pinned: f32x8,
    pub solids: &'a Solids<'a>,
}

impl Follow<'_> {
    /// Moves each point to its length from the one before and tells how far \[m\] that moved it.
    ///
    /// A held shape turns the segments first, and solids push points out last: neither is a correction
    /// of a length, which gives velocity back. Segments between the head and a hand go where the hand
    /// pulls them.
    pub fn place(
        &self,
        mut held: Option<Held>,
        positions: &mut [Vec3Lanes],
        planes: &mut [Plane],
        corrections: &mut [Vec3x8],
    ) {
        corrections[0] = Vec3x8::ZERO;
        let mut before = Vec3x8::load(&positions[0]);
        for point in 1..positions.len() {
            let mut found = Vec3x8::load(&positions[point]);
            let free = load(&self.inverse_mass[point]).simd_gt(splat(0.0));
            let length = load(&self.lengths[point - 1]);
            if let Some(held) = &held {
                let shaped = free & splat(point as f32).simd_gt(self.pinned);
                found = (before + held.turn(point, found - before)).or(shaped, found);
            }
            let across = found - before;
            let mut placed = before + across * (length / across.length());
            corrections[point] = (placed - found).or(free, Vec3x8::ZERO);
            if !self.solids.is_empty() && free.any() {
                for _ in 0..PLACINGS {
                    let margin = self.margins[point];
                    let query = Query { position: placed, start: placed, margin, free, care: Care::EXACT };
                    let touch = self.solids.touch(planes, point, query);
                    let Some(touch) = touch.filter(|touch| touch.height(placed).simd_lt(splat(-1e-6)).any())
                    else {
                        break;
                    };
                    placed = outside(&touch, before, placed, length);
                }
            }
            let placed = placed.or(free, found);
            placed.store(&mut positions[point]);
            if let Some(held) = &mut held {
                held.pass(point, placed - before);
            }
            before = placed;
        }
    }
}

/// The nearest place on a plane that lies at a distance from `before`, where `placed` is below the
/// plane; the farthest place out when the plane is out of reach.
#[inline(always)]
fn outside(touch: &Touch, before: Vec3x8, placed: Vec3x8, length: f32x8) -> Vec3x8 {
    let below = touch.height(placed).simd_lt(splat(0.0));
    let rise = (-touch.height(before)).fast_min(length);
    let across = placed - before;
    let aside = across - touch.normal * touch.normal.dot(across);
    let reach = (length * length - rise * rise).fast_max(splat(0.0)).sqrt();
    let moved = before + touch.normal * rise + aside * (reach / aside.length());
    moved.or(below, placed)
}
