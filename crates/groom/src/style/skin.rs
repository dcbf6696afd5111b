//! The skin that hair keeps off, and the room in which it is known to be far.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use glam::{UVec3, Vec3};
use strandline_body::{Mannequin, SignedDistance};

/// Distance \[m\] of the skin from every place of a far cell, at least: more than strands keep off it.
const FAR: f32 = 0.0025;
/// Side of a cell \[m\], and the room about the body that has cells \[m\].
const CELL: f32 = 0.005;
const ROOM: f32 = 0.08;
/// Most by which the distance differs between two places, over that from one to the other.
const STEEPEST: f32 = 1.5;
/// States of a cell: not looked at, not far everywhere, far everywhere.
const UNKNOWN: u8 = 0;
const NEAR: u8 = 1;
const DISTANT: u8 = 2;

/// The skin of a head.
pub struct Skin {
    mannequin: Arc<Mannequin>,
    /// Lower corner of the first cell \[m\], on the side of positive x.
    low: Vec3,
    counts: UVec3,
    /// State of each cell, x fastest, found when a place in it is looked at.
    cells: Vec<AtomicU8>,
}

impl Skin {
    /// Skin of the built-in head.
    pub fn new(mannequin: Arc<Mannequin>) -> Self {
        let bounds = mannequin.bounds();
        let low = (bounds.min - ROOM).with_x(0.0);
        // Both sides are the same.
        let counts = ((bounds.max + ROOM - low) / CELL).ceil().as_uvec3();
        let count = counts.element_product() as usize;
        let cells = std::iter::repeat_with(|| AtomicU8::new(UNKNOWN)).take(count).collect();
        Self { mannequin, low, counts, cells }
    }

    /// The head.
    pub fn mannequin(&self) -> &Mannequin {
        &self.mannequin
    }

    /// Moves a point \[m\] out of the body until it is `clearance` \[m\] from the skin.
    pub fn outside(&self, point: Vec3, clearance: f32) -> Vec3 {
        if clearance <= FAR && self.is_far(point) { point } else { self.led_outside(point, clearance).0 }
    }

    /// As [`Skin::outside`]: the point, and distance \[m\] and direction away from the skin there.
    pub fn led_outside(&self, mut point: Vec3, clearance: f32) -> (Vec3, (f32, Vec3)) {
        let mut above = self.mannequin.distance_and_gradient(point);
        for _ in 0..8 {
            let (distance, out) = above;
            if distance >= clearance {
                break;
            }
            point += out * (clearance - distance);
            above = self.mannequin.distance_and_gradient(point);
        }
        (point, above)
    }

    /// The first place on the skin along a way \[m\].
    pub fn first_along(&self, start: Vec3, way: Vec3) -> Option<Vec3> {
        let mut passed = 0.0;
        for _ in 0..48 {
            let distance = self.mannequin.distance(start + way * passed);
            if distance < 2e-4 {
                return Some(start + way * passed);
            }
            passed += 0.8 * distance;
            if passed > 0.25 {
                break;
            }
        }
        None
    }

    /// True for most places \[m\] that are far from the skin: found without its distance there.
    fn is_far(&self, point: Vec3) -> bool {
        let at = (point.with_x(point.x.abs()) - self.low) / CELL;
        if !(at.cmpge(Vec3::ZERO).all() && at.cmplt(self.counts.as_vec3()).all()) {
            return false;
        }
        let place = at.as_uvec3();
        let index = (place.z * self.counts.y + place.y) * self.counts.x + place.x;
        let cell = &self.cells[index as usize];
        // A cell that two threads look at has the same state for both.
        let known = cell.load(Ordering::Relaxed);
        if known != UNKNOWN {
            return known == DISTANT;
        }
        let middle = self.low + (place.as_vec3() + 0.5) * CELL;
        let half_diagonal = 0.5 * 3f32.sqrt() * CELL;
        let is_far = self.mannequin.distance(middle) >= FAR + STEEPEST * half_diagonal;
        cell.store(if is_far { DISTANT } else { NEAR }, Ordering::Relaxed);
        is_far
    }
}

#[cfg(test)]
mod tests {
    use strandline_body::Random;

    use super::*;

    #[test]
    fn far_places_are_farther_than_strands_keep_off() {
        let skin = Skin::new(Mannequin::new());
        let bounds = skin.mannequin.bounds();
        let (mut near, mut far) = (0, 0);
        for index in 0..200_000 {
            let mut random = Random::new(21, index);
            let share = Vec3::new(random.unit(), random.unit(), random.unit());
            let place = bounds.min - 0.03 + share * (bounds.max - bounds.min + 0.06);
            let distance = skin.mannequin.distance(place);
            assert!(!skin.is_far(place) || distance > FAR, "{place}: {distance}");
            // Most places about the skin are told.
            if (0.010..0.030).contains(&distance) {
                near += 1;
                far += usize::from(skin.is_far(place));
            }
        }
        assert!(far as f32 > 0.9 * near as f32, "{far} of {near}");
    }
}
