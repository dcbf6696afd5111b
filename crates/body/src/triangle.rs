//! The distance to one triangle, for the search for the nearest.

use glam::DVec3;
use rstar::{AABB, PointDistance, RTreeObject};

/// A triangle with what its distance needs. Double precision: in single precision the distance to a
/// triangle that is small and far comes out wrong by its whole size.
pub(crate) struct Triangle {
    corners: [DVec3; 3],
    /// Unit normal; zero without an area.
    normal: DVec3,
}

impl Triangle {
    pub fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self { corners, normal: (b - a).cross(c - a).normalize_or_zero() }
    }

    /// The squared distance of a point from an edge, and whether the point is on its inner side.
    fn edge(&self, index: usize, point: DVec3) -> (f64, bool) {
        let start = self.corners[index];
        let axis = self.corners[(index + 1) % 3] - start;
        let offset = point - start;
        // An edge of no length is its start.
        let share = (offset.dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let is_inner = axis.cross(offset).dot(self.normal) > 0.0;
        ((offset - axis * share).length_squared(), is_inner)
    }
}

impl RTreeObject for Triangle {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b, c] = self.corners;
        AABB::from_corners(a.min(b).min(c).to_array(), a.max(b).max(c).to_array())
    }
}

impl PointDistance for Triangle {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        let point = DVec3::from_array(*point);
        let edges = [self.edge(0, point), self.edge(1, point), self.edge(2, point)];
        if edges.iter().all(|(_, is_inner)| *is_inner) {
            let height = (point - self.corners[0]).dot(self.normal);
            return height * height;
        }
        edges[0].0.min(edges[1].0).min(edges[2].0)
    }
}
