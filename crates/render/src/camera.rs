use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// Where it stands \[m\], world space.
    pub position: Vec3,
    /// What it looks at \[m\], world space.
    pub target: Vec3,
    /// Vertical field of view \[degrees\].
    pub field_of_view: f32,
}

impl Camera {
    /// The built-in bust from the front.
    pub fn front() -> Self {
        Self { position: Vec3::new(0.0, 0.0, 1.0), target: Vec3::ZERO, field_of_view: 30.0 }
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self::front()
    }
}
