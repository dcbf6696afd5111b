//! Places of the body as they are seen, and their paint.

use glam::{Vec2, Vec3};

use super::body::Body;
use crate::frame::projection::Projection;
use crate::surfaces::{Painted, Surfaces, copy_of};

/// A place of a triangle as it is seen.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// Shares of its corners.
    pub shares: Vec3,
    /// From the eye to it, over its depth.
    pub way: Vec3,
    /// Normal of the triangle, not of unit length.
    pub face: Vec3,
    /// Distance along the view \[m\].
    pub depth: f32,
}

impl Body {
    /// The place of a triangle that is seen at a place on the screen.
    pub fn sight(&self, triangle: u32, projection: &Projection, place: Vec2) -> Sight {
        let [a, b, c] = self.triangle(triangle).map(|corner| self.positions[corner]);
        let eye = projection.eye();
        let way = projection.world(place.x, place.y, 1.0) - eye;
        let face = (b - a).cross(c - a);
        let depth = face.dot(a - eye) / face.dot(way);
        let point = eye + way * depth;
        // Shares of the corners, kept inside: beside an edge the plane runs off.
        let area = face.length_squared();
        let share_b = face.dot((point - a).cross(c - a)) / area;
        let share_c = face.dot((b - a).cross(point - a)) / area;
        let shares = Vec3::new(1.0 - share_b - share_c, share_b, share_c).clamp(Vec3::ZERO, Vec3::ONE);
        Sight { shares: shares / shares.element_sum(), way, face, depth }
    }

    /// The paint of a place of a triangle.
    pub fn painted(
        &self,
        surfaces: &Surfaces,
        triangle: u32,
        sight: &Sight,
        projection: &Projection,
    ) -> Painted {
        let lengths = (sight.face.length_squared() * sight.way.length_squared()).sqrt();
        let cosine = sight.face.dot(sight.way).abs() / lengths.max(f32::MIN_POSITIVE);
        let density = surfaces.corners[3 * triangle as usize].density;
        let copy = copy_of(density, sight.depth / projection.focal, cosine);
        surfaces.at(triangle, sight.shares, copy)
    }
}
