//! Frames of guides for the strands that are bound to them.

use glam::{Mat3, Quat, Vec3, Vec4};

/// A frame of a guide's point as a map from rest to now.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PointFrame {
    /// Images of the three axes, and the translation \[m\], world space. The map is of positions at rest
    /// \[m\], head space.
    pub(super) columns: [Vec4; 4],
}

impl PointFrame {
    pub(super) fn new(rotation: Quat, rest: Vec3, now: Vec3) -> Self {
        let matrix = Mat3::from_quat(rotation);
        let translation = now - matrix * rest;
        let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis, translation];
        Self { columns: columns.map(|column| column.extend(0.0)) }
    }
}

/// Frames of guides for the strands that are bound to them; reused from picture to picture.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// Shape `[guide][point]`.
    pub(super) points: Vec<PointFrame>,
    pub(super) scales: Vec<f32>,
}

impl Frames {
    /// Length of each guide over its length at rest, shape `[guide]`: other than 1 where it was cut or grew.
    pub fn scales(&self) -> &[f32] {
        &self.scales
    }
}
