//! Arithmetic on blocks: eight strands at a time.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

use glam::{Mat3, Vec3};
use strandline_groom::{Lanes, Vec3Lanes};
use wide::f32x8;

/// One vector for each strand of a block, in registers.
#[derive(Clone, Copy, Debug)]
pub struct Vec3x8 {
    /// First components.
    pub x: f32x8,
    /// Second components.
    pub y: f32x8,
    /// Third components.
    pub z: f32x8,
}

/// Loads one number for each strand.
#[inline(always)]
pub fn load(lanes: &Lanes) -> f32x8 {
    f32x8::new(lanes.0)
}

/// The same number in every lane.
#[inline(always)]
pub fn splat(number: f32) -> f32x8 {
    f32x8::splat(number)
}

impl Vec3x8 {
    /// No displacement.
    pub const ZERO: Self = Self { x: f32x8::ZERO, y: f32x8::ZERO, z: f32x8::ZERO };

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(vector: Vec3) -> Self {
        Self { x: splat(vector.x), y: splat(vector.y), z: splat(vector.z) }
    }

    /// Loads one vector for each strand.
    #[inline(always)]
    pub fn load(lanes: &Vec3Lanes) -> Self {
        Self { x: f32x8::new(lanes.x), y: f32x8::new(lanes.y), z: f32x8::new(lanes.z) }
    }

    /// Stores one vector for each strand.
    #[inline(always)]
    pub fn store(self, lanes: &mut Vec3Lanes) {
        lanes.x = self.x.to_array();
        lanes.y = self.y.to_array();
        lanes.z = self.z.to_array();
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f32x8 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Length, never 0, so that it may divide.
    #[inline(always)]
    pub fn length(self) -> f32x8 {
        (self.dot(self) + splat(1e-30)).sqrt()
    }

    /// This where the mask is set, else `other`.
    #[inline(always)]
    pub fn or(self, mask: f32x8, other: Self) -> Self {
        Self {
            x: mask.bitselect(self.x, other.x),
            y: mask.bitselect(self.y, other.y),
            z: mask.bitselect(self.z, other.z),
        }
    }
}

impl Add for Vec3x8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for Vec3x8 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul<f32x8> for Vec3x8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f32x8) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl AddAssign for Vec3x8 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Vec3x8 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// A rigid transform of all lanes.
#[derive(Clone, Copy)]
pub struct Rigid {
    columns: [Vec3; 3],
    translation: Vec3,
}

impl Rigid {
    /// The transform of a pose.
    pub fn new(pose: &strandline_body::Pose) -> Self {
        let Mat3 { x_axis, y_axis, z_axis } = Mat3::from_quat(pose.rotation);
        Self { columns: [x_axis, y_axis, z_axis], translation: pose.translation }
    }

    /// Carries points \[m\].
    #[inline(always)]
    pub fn points(&self, points: Vec3x8) -> Vec3x8 {
        self.directions(points) + Vec3x8::splat(self.translation)
    }

    /// Carries directions.
    #[inline(always)]
    pub fn directions(&self, directions: Vec3x8) -> Vec3x8 {
        Vec3x8::splat(self.columns[0]) * directions.x
            + Vec3x8::splat(self.columns[1]) * directions.y
            + Vec3x8::splat(self.columns[2]) * directions.z
    }
}
