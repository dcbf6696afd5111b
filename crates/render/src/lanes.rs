//! Whole numbers of coordinates, without a call.

use glam::{Vec2, Vec3};
use wide::f32x4;

/// Whole and fractional parts of coordinates that are not negative; 0 for NaN. `floor` would be a function call on the
/// oldest processors that a build must run on.
#[inline]
pub(crate) fn split(at: Vec3) -> ([usize; 3], Vec3) {
    let whole = f32x4::from([at.x, at.y, at.z, 0.0]).trunc_int();
    let [x, y, z, _] = f32x4::from_i32x4(whole).to_array();
    let [columns, rows, layers, _] = whole.to_array().map(|whole| whole as u32 as usize);
    ([columns, rows, layers], at - Vec3::new(x, y, z))
}

/// [`split`] of coordinates of 0 to 2^24.
#[inline]
pub(crate) fn split_texel(at: Vec2) -> ([usize; 2], Vec2) {
    let whole = f32x4::from([at.x, at.y, 0.0, 0.0]).fast_trunc_int();
    let [x, y, ..] = f32x4::from_i32x4(whole).to_array();
    let [column, row, ..] = whole.to_array().map(|whole| whole as u32 as usize);
    ([column, row], at - Vec2::new(x, y))
}

/// A number of 0 to 2^31 rounded up, without a call.
#[inline]
pub(crate) fn rounded_up(number: f32) -> i32 {
    let whole = number as i32;
    whole + i32::from((whole as f32) < number)
}
