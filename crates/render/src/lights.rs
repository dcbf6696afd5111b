use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A light. Spot lights and distant lights may cast shadows through the hair.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Light {
    /// Where it stands \[m\], world space.
    pub position: Vec3,
    /// What it points at \[m\], world space.
    pub target: Vec3,
    /// Whether hair and body cast shadows in it.
    pub shadow: bool,
}

impl Default for Light {
    fn default() -> Self {
        Self { position: Vec3::new(0.5, 1.0, 1.0), target: Vec3::ZERO, shadow: true }
    }
}
