use glam::Vec3;

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

    /// True if both sides of the plane x = 0 are the same.
    fn is_symmetric(&self) -> bool {
        false
    }

    /// A box that holds every point of negative distance.
    fn bounds(&self) -> Aabb;
}
