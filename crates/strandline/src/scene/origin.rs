//! The origin from which hair is simulated: single precision is exact beside it alone.

use glam::Vec3;

use crate::body::Collider;

/// Distance \[m\] from the world's origin up to which single precision is as exact as beside it.
const NEAR: f32 = 8.0;

/// An origin \[m\] beside a place \[m\], in whole metres; the world's where the place is near that.
///
/// Whole metres are subtracted without rounding from any coordinate beside them.
pub(crate) fn beside(place: Vec3) -> Vec3 {
    if place.abs().max_element() <= NEAR { Vec3::ZERO } else { place.round() }
}

/// An origin, and colliders as they lie from there; the world's where one of them cannot be moved.
pub(crate) fn about(origin: Vec3, colliders: Vec<Collider>) -> (Vec3, Vec<Collider>) {
    if origin == Vec3::ZERO {
        return (origin, colliders);
    }
    match colliders.iter().map(|collider| collider.seen_from(origin)).collect() {
        Some(moved) => (origin, moved),
        None => (Vec3::ZERO, colliders),
    }
}
