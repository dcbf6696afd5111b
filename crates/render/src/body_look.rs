use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::RenderError;

/// How the body looks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodyLook {
    /// Colour, linear RGB 0..1. Default a warm grey.
    pub color: Vec3,
    /// How far light reaches around the edge of shadow, 0 (not at all) to 1. Default 0.2.
    pub wrap: f32,
    /// Reflectance at normal incidence, 0 (no highlight) to 1. Default 0.03.
    pub specular: f32,
    /// Width of the highlight, 0.05 (polished) to 1 (matt). Default 0.5.
    pub roughness: f32,
}

impl Default for BodyLook {
    fn default() -> Self {
        Self { color: Vec3::new(0.30, 0.262, 0.236), wrap: 0.2, specular: 0.03, roughness: 0.5 }
    }
}

impl BodyLook {
    /// Checks every field.
    ///
    /// # Errors
    /// A value outside its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        let refuse = |name, found: String, expected| Err(RenderError::Setting { name, found, expected });
        if !(self.color.cmpge(Vec3::ZERO).all() && self.color.cmple(Vec3::ONE).all()) {
            return refuse("body_look.color", self.color.to_string(), "three numbers of 0 to 1");
        }
        for (name, share) in [("body_look.wrap", self.wrap), ("body_look.specular", self.specular)] {
            if !(0.0..=1.0).contains(&share) {
                return refuse(name, share.to_string(), "0 to 1");
            }
        }
        if !(0.05..=1.0).contains(&self.roughness) {
            return refuse("body_look.roughness", self.roughness.to_string(), "0.05 to 1");
        }
        Ok(())
    }
}
