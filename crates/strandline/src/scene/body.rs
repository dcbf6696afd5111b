use std::path::PathBuf;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::within;
use crate::{
    Error,
    body::{Carrier, Collider, Shape},
};

/// Which body is used when no file is named.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Model {
    /// The mannequin under a grown style, nothing under a groom from a file.
    #[default]
    Auto,
    /// The built-in bust.
    Mannequin,
    /// No body.
    None,
}

/// `[body]`: what hair grows on and hits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodySection {
    /// The body when no file is named: "auto", "mannequin" or "none".
    pub model: Model,
    /// An .obj, .gltf or .glb file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// A closed mesh that hair hits in place of the drawn one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collider_file: Option<PathBuf>,
    /// Metres per unit of the body's files.
    pub scale: f32,
    /// Whether the body is drawn.
    pub visible: bool,
    /// Whether hair hits the body.
    pub solid: bool,
    /// Distance between the samples of the body's signed distance \[m\].
    pub spacing: f32,
    /// Whether hair hits the exact mannequin in place of samples of it; slower.
    pub exact: bool,
    /// Coulomb friction coefficient of hair on the body.
    pub friction: f32,
}

impl Default for BodySection {
    fn default() -> Self {
        Self {
            model: Model::Auto,
            file: None,
            collider_file: None,
            scale: 1.0,
            visible: true,
            solid: true,
            spacing: 0.004,
            exact: false,
            friction: 0.3,
        }
    }
}

impl BodySection {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("body.scale", f64::from(self.scale), 1e-6..=1e6)?;
        within("body.spacing", f64::from(self.spacing), 5e-4..=0.1)?;
        within("body.friction", f64::from(self.friction), 0.0..=10.0)
    }
}

/// `[[colliders]]`: a solid beside the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "shape", rename_all = "lowercase", deny_unknown_fields)]
pub enum ColliderSection {
    /// A ball.
    Sphere {
        /// Centre \[m\].
        center: Vec3,
        /// Radius \[m\].
        radius: f32,
        /// What it moves with: "head" or "world".
        #[serde(default)]
        carrier: Carrier,
        /// Coulomb friction coefficient.
        #[serde(default = "default_friction")]
        friction: f32,
    },
    /// A segment with a radius.
    Capsule {
        /// One end \[m\].
        start: Vec3,
        /// The other end \[m\].
        end: Vec3,
        /// Radius \[m\].
        radius: f32,
        /// What it moves with: "head" or "world".
        #[serde(default)]
        carrier: Carrier,
        /// Coulomb friction coefficient.
        #[serde(default = "default_friction")]
        friction: f32,
    },
}

fn default_friction() -> f32 {
    BodySection::default().friction
}

impl ColliderSection {
    /// The solid itself.
    ///
    /// # Errors
    /// A radius that is not positive, a negative friction, a number that is not finite.
    pub fn collider(&self) -> Result<Collider, Error> {
        let (shape, carrier, friction) = match *self {
            Self::Sphere { center, radius, carrier, friction } => {
                (Shape::Sphere { center, radius }, carrier, friction)
            }
            Self::Capsule { start, end, radius, carrier, friction } => {
                (Shape::Capsule { start, end, radius }, carrier, friction)
            }
        };
        Ok(Collider::new(shape, carrier, friction)?)
    }
}
