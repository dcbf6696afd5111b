mod ear;
mod field;
mod proportions;
mod shape;
mod surface;

use std::sync::Arc;

use glam::Vec3;

use crate::{Aabb, Mesh, Scalp, SignedDistance};
use shape::BustShape;

/// The built-in bust: a smooth signed-distance model of skull, jaw, nose, ears, neck and shoulders.
///
/// Head space: the centre of the skull is near the origin, y up, the face looks along +z.
/// Everything is symmetric in x.
#[derive(Clone, Debug)]
pub struct Mannequin {
    shape: BustShape,
}

/// Within this distance \[m\] of the skin the value is divided by the length of its gradient,
/// which makes it a distance to first order; the correction has faded out at twice as much.
const CORRECTED: f32 = 0.015;

impl Mannequin {
    /// The one model, shared.
    pub fn new() -> Arc<Self> {
        Arc::new(Self::default())
    }

    /// The surface as triangles: closed, refined onto the skin, with normals from the gradient.
    pub fn mesh(&self) -> Mesh {
        surface::mesh(self)
    }

    /// The part of the skin on which hair grows.
    pub fn scalp(&self) -> Scalp {
        Scalp::new(self.clone())
    }

    /// The point \[m\] about which the head nods and turns: between the base of the skull and the
    /// uppermost vertebra.
    pub fn neck_pivot(&self) -> Vec3 {
        Vec3::new(0.0, -0.062, -0.016)
    }
}

impl Default for Mannequin {
    fn default() -> Self {
        Self { shape: BustShape::mannequin() }
    }
}

impl SignedDistance for Mannequin {
    fn distance(&self, point: Vec3) -> f32 {
        self.distance_and_gradient(point).0
    }

    fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        let field = self.shape.at(point);
        let steepness = field.gradient.length().max(0.25);
        let fade = (2.0 - field.value.abs() / CORRECTED).clamp(0.0, 1.0);
        let divisor = 1.0 + (steepness - 1.0) * fade;
        (field.value / divisor, field.gradient.normalize_or(Vec3::Y))
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: Vec3::new(-0.21, -0.265, -0.125), max: Vec3::new(0.21, 0.112, 0.125) }
    }
}
