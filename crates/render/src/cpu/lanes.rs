//! Vectors in SIMD lanes.

use std::ops::{Add, Mul, Sub};

use glam::{Vec2, Vec3};
use strandline_groom::Vec3Lanes;
use wide::{f32x4, f32x8};

/// The whole parts of coordinates that are not negative, and what is left of them; 0 where they are NaN. `floor` is a
/// call on processors that every build must run on.
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

/// Eight vectors, component by component.
#[derive(Clone, Copy)]
pub(crate) struct Wide3 {
    pub(crate) x: f32x8,
    pub(crate) y: f32x8,
    pub(crate) z: f32x8,
}

impl Wide3 {
    #[inline]
    pub(crate) fn splat(vector: Vec3) -> Self {
        Self { x: f32x8::splat(vector.x), y: f32x8::splat(vector.y), z: f32x8::splat(vector.z) }
    }

    #[inline]
    pub(crate) fn load(lanes: &Vec3Lanes) -> Self {
        Self { x: f32x8::from(lanes.x), y: f32x8::from(lanes.y), z: f32x8::from(lanes.z) }
    }

    #[inline]
    pub(crate) fn store(self, lanes: &mut Vec3Lanes) {
        lanes.x = self.x.to_array();
        lanes.y = self.y.to_array();
        lanes.z = self.z.to_array();
    }

    /// The same number in all three components.
    #[inline]
    pub(crate) fn same(value: f32x8) -> Self {
        Self { x: value, y: value, z: value }
    }

    /// Component by component.
    #[inline]
    pub(crate) fn times(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }

    #[inline]
    pub(crate) fn dot(self, other: Self) -> f32x8 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Unit vectors; lanes too short to have a direction take `fallback`.
    #[inline]
    pub(crate) fn normalize_or(self, fallback: Self) -> Self {
        let square = self.dot(self);
        let least = f32x8::splat(1e-24);
        let sound = square.simd_gt(least);
        let unit = self * (f32x8::splat(1.0) / square.max(least).sqrt());
        Self {
            x: sound.select(unit.x, fallback.x),
            y: sound.select(unit.y, fallback.y),
            z: sound.select(unit.z, fallback.z),
        }
    }
}

impl Add for Wide3 {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for Wide3 {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul<f32x8> for Wide3 {
    type Output = Self;
    #[inline]
    fn mul(self, scale: f32x8) -> Self {
        Self { x: self.x * scale, y: self.y * scale, z: self.z * scale }
    }
}
