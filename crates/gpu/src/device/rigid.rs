//! Rigid motions as shaders have them.

use glam::{Affine3A, Mat3, Vec3};
use strandline_base::Pose;

crate::mirror! {
    /// Rows of a rotation, each with its component of the translation \[m\] behind it. Mirrors `Rigid` in kit.wesl.
    pub struct Rigid {
        /// First row.
        pub x: [f32; 4],
        /// Second row.
        pub y: [f32; 4],
        /// Third row.
        pub z: [f32; 4],
    }
}

impl Rigid {
    fn new(rotation: Mat3, translation: Vec3) -> Self {
        let rows = rotation.transpose();
        let row = |axis: Vec3, offset: f32| axis.extend(offset).to_array();
        Self {
            x: row(rows.x_axis, translation.x),
            y: row(rows.y_axis, translation.y),
            z: row(rows.z_axis, translation.z),
        }
    }
}

impl From<&Pose> for Rigid {
    fn from(pose: &Pose) -> Self {
        Self::new(Mat3::from_quat(pose.rotation), pose.translation)
    }
}

impl From<&Affine3A> for Rigid {
    fn from(affine: &Affine3A) -> Self {
        Self::new(affine.matrix3.into(), affine.translation.into())
    }
}
