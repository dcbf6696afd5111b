use glam::Vec3;

use crate::{BodyError, Mesh};

/// An axis-aligned box \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner \[m\].
    pub min: Vec3,
    /// Largest corner \[m\].
    pub max: Vec3,
}

/// A field of signed distance \[m\], negative inside, in head space.
pub trait SignedDistance: Send + Sync {
    /// Signed distance \[m\] at a point \[m\].
    fn distance(&self, point: Vec3) -> f32;

    /// Signed distance \[m\] and its unit gradient (pointing out of the body).
    fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3);

    /// A box that holds every point of negative distance.
    fn bounds(&self) -> Aabb;
}

/// Signed distance sampled on a regular grid and interpolated trilinearly.
#[derive(Clone, Debug)]
pub struct DistanceGrid {}

impl DistanceGrid {
    /// Samples a field over its bounds, padded by `padding` \[m\], at `spacing` \[m\].
    pub fn from_field(_field: &dyn SignedDistance, _spacing: f32, _padding: f32) -> Self {
        unimplemented!("body mechanics")
    }

    /// Signed distance of a closed mesh at `spacing` \[m\].
    ///
    /// # Errors
    /// An empty or an open mesh has no inside.
    pub fn from_mesh(_mesh: &Mesh, _spacing: f32, _padding: f32) -> Result<Self, BodyError> {
        unimplemented!("body mechanics")
    }
}

impl SignedDistance for DistanceGrid {
    fn distance(&self, _point: Vec3) -> f32 {
        unimplemented!("body mechanics")
    }
    fn distance_and_gradient(&self, _point: Vec3) -> (f32, Vec3) {
        unimplemented!("body mechanics")
    }
    fn bounds(&self) -> Aabb {
        unimplemented!("body mechanics")
    }
}
