use std::sync::Arc;

use glam::Vec3;

use crate::{Aabb, Mesh, Scalp, SignedDistance};

/// The built-in bust: a smooth signed-distance model of skull, jaw, nose, ears, neck and shoulders.
///
/// Head space: the centre of the skull is near the origin, y up, the face looks along +z.
#[derive(Clone, Debug, Default)]
pub struct Mannequin {}

impl Mannequin {
    /// The one model, shared.
    pub fn new() -> Arc<Self> {
        Arc::new(Self::default())
    }

    /// The surface as triangles.
    pub fn mesh(&self) -> Mesh {
        unimplemented!("mannequin")
    }

    /// The part of the skin on which hair grows.
    pub fn scalp(&self) -> Scalp {
        unimplemented!("mannequin")
    }
}

impl SignedDistance for Mannequin {
    fn distance(&self, _point: Vec3) -> f32 {
        unimplemented!("mannequin")
    }
    fn distance_and_gradient(&self, _point: Vec3) -> (f32, Vec3) {
        unimplemented!("mannequin")
    }
    fn bounds(&self) -> Aabb {
        unimplemented!("mannequin")
    }
}
