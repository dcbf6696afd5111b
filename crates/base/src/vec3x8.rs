//! Arithmetic on blocks: eight strands at a time.

use glam::{Mat3, Vec3};
use wide::f32x8;

use crate::real::Vector;
use crate::{LANES, Lanes, Pose, Vec3Lanes};

/// One vector for each strand of a block, in registers.
pub type Vec3x8 = Vector<f32x8>;

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

    /// The same number in all three components.
    #[inline(always)]
    pub fn same(number: f32x8) -> Self {
        Self { x: number, y: number, z: number }
    }

    /// Component by component.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }

    /// Unit vectors; lanes too short to have a direction take `fallback`.
    #[inline(always)]
    pub fn normalize_or(self, fallback: Self) -> Self {
        let square = self.dot(self);
        let least = f32x8::splat(1e-24);
        let sound = square.simd_gt(least);
        let unit = self * (f32x8::splat(1.0) / square.max(least).sqrt());
        unit.or(sound, fallback)
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

/// A rigid transform in each lane.
#[derive(Clone, Copy)]
pub struct RigidLanes {
    columns: [Vec3x8; 3],
    translation: Vec3x8,
}

impl RigidLanes {
    /// The transforms of poses, one a lane.
    pub fn new(poses: &[Pose; LANES]) -> Self {
        let axis = |axis: usize| lanes(poses.map(|pose| Mat3::from_quat(pose.rotation).col(axis)));
        Self { columns: [axis(0), axis(1), axis(2)], translation: lanes(poses.map(|pose| pose.translation)) }
    }

    /// Carries points \[m\]: the bits of [`Rigid::points`] where all lanes have one pose.
    #[inline(always)]
    pub fn points(&self, points: Vec3x8) -> Vec3x8 {
        self.columns[0] * points.x
            + self.columns[1] * points.y
            + self.columns[2] * points.z
            + self.translation
    }
}

/// A vector for each lane.
pub fn lanes(vectors: [Vec3; LANES]) -> Vec3x8 {
    Vec3x8 {
        x: f32x8::from(vectors.map(|vector| vector.x)),
        y: f32x8::from(vectors.map(|vector| vector.y)),
        z: f32x8::from(vectors.map(|vector| vector.z)),
    }
}

impl From<Rigid> for RigidLanes {
    fn from(rigid: Rigid) -> Self {
        Self { columns: rigid.columns.map(Vec3x8::splat), translation: Vec3x8::splat(rigid.translation) }
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
    pub fn new(pose: &Pose) -> Self {
        let Mat3 { x_axis, y_axis, z_axis } = Mat3::from_quat(pose.rotation);
        Self { columns: [x_axis, y_axis, z_axis], translation: pose.translation }
    }

    /// The transform of a pose, by the axes that it turns: as rods carry their points, to the bit.
    pub fn of_axes(pose: &Pose) -> Self {
        let columns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| pose.direction(axis));
        Self { columns, translation: pose.translation }
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
