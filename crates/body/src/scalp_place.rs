//! Coordinates on the scalp.

use glam::{Vec2, Vec3};
use strandline_base::math;

/// The scalp is seen from here without overlap \[m\].
pub(crate) const CENTER: Vec3 = Vec3::new(0.0, 0.0, -0.005);
/// Direction from [`CENTER`] to the crown.
const CROWN: Vec3 = Vec3::new(0.0, 0.862, -0.507);
/// Largest angle \[rad\] between the crown and a place on the scalp.
const WIDEST: f32 = 2.10;

/// Coordinates on the scalp of a place on the head \[m\], 0..1 in both: the crown in the middle, angle and distance from
/// it kept.
pub(crate) fn uv(position: Vec3) -> Vec2 {
    let arm = (position - CENTER).normalize();
    let back = Vec3::X.cross(CROWN);
    let around = Vec2::new(arm.x, -arm.dot(back)).normalize_or(Vec2::Y);
    let share = math::acos(arm.dot(CROWN).clamp(-1.0, 1.0)) / WIDEST;
    (around * (0.5 * share) + 0.5).clamp(Vec2::ZERO, Vec2::ONE)
}
