//! The distance to one triangle.

use glam::DVec3;

use crate::layers::Corners;

/// The plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    /// A corner.
    corner: DVec3,
    /// Normal, as long as twice the area.
    normal: DVec3,
    /// Square of that length, and one over it.
    area: f64,
    inverse_area: f64,
    /// A disc in the plane that holds the triangle: its middle, from the corner, and its radius.
    middle: DVec3,
    radius: f64,
}

/// Shares of squared distances by which rounding may err in the bound of a disc.
const ROUNDING: f64 = 1e-9;
const CANCELLED: f64 = 1e-12;

impl Plane {
    pub fn of([a, b, c]: &Corners) -> Self {
        let normal = (b - a).cross(c - a);
        let middle = (a + b + c) / 3.0;
        let radius =
            [a, b, c].into_iter().fold(0.0, |most: f64, corner| most.max(corner.distance_squared(middle)));
        let area = normal.length_squared();
        Self { corner: *a, normal, area, inverse_area: 1.0 / area, middle: middle - a, radius: radius.sqrt() }
    }

    /// True where the disc is farther from a point than a known squared distance: most triangles about the nearest one lie in
    /// nearly the same plane and beside the point.
    #[inline]
    pub fn is_farther(&self, point: DVec3, known: f64) -> bool {
        let from_corner = point - self.corner;
        let height = from_corner.dot(self.normal);
        let height_squared = height * height * self.inverse_area;
        let squared = (from_corner - self.middle).length_squared();
        let reach = self.radius + (known - height_squared).max(0.0).sqrt();
        // False without an area, where the height is no number.
        squared - height_squared > (1.0 + ROUNDING) * reach * reach + CANCELLED * squared
    }
}

/// The squared distance of a point from a triangle, if it is less than a known one.
pub(crate) fn nearer(corners: &Corners, point: DVec3, known: f64) -> Option<f64> {
    nearer_than(corners, &Plane::of(corners), point, known)
}

/// The same for a triangle whose plane is known.
///
/// Double precision: in single precision the distance to a triangle that is small and far comes out
/// wrong by its whole size.
#[inline]
pub(crate) fn nearer_than(corners: &Corners, plane: &Plane, point: DVec3, known: f64) -> Option<f64> {
    let Plane { corner, normal, area, .. } = *plane;
    // The distance from its plane is a lower bound, and cheap.
    let height = (point - corner).dot(normal);
    if height * height > known * area {
        return None;
    }
    let [a, b, c] = *corners;
    let mut nearest = f64::INFINITY;
    for [start, end] in [[a, b], [b, c], [c, a]] {
        // The nearest place lies on an edge that has the point on its outer side, or within all of them.
        if is_outer(start, end, normal, point) {
            nearest = nearest.min(from_edge(start, end, point));
        }
    }
    if nearest == f64::INFINITY {
        nearest = height * height / area;
    }
    (nearest < known).then_some(nearest)
}

/// The place of a triangle that is nearest to a point.
pub(crate) fn nearest_place(corners: &Corners, point: DVec3) -> DVec3 {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let edges = [[a, b], [b, c], [c, a]];
    let outer = edges.into_iter().filter(|[start, end]| is_outer(*start, *end, normal, point));
    let places = outer.map(|[start, end]| {
        let axis = end - start;
        let share = (point - start).dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE);
        start + axis * share.clamp(0.0, 1.0)
    });
    let near = |one: &DVec3, two: &DVec3| one.distance_squared(point).total_cmp(&two.distance_squared(point));
    places
        .min_by(near)
        .unwrap_or_else(|| point - normal * ((point - a).dot(normal) / normal.length_squared()))
}

/// True if a point is not on the inner side of an edge; always true for a triangle without an area.
fn is_outer(start: DVec3, end: DVec3, normal: DVec3, point: DVec3) -> bool {
    (end - start).cross(point - start).dot(normal) <= 0.0
}

/// The squared distance of a point from an edge.
fn from_edge(start: DVec3, end: DVec3, point: DVec3) -> f64 {
    let (axis, offset) = (end - start, point - start);
    // An edge of no length is its start.
    let share = (offset.dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (offset - axis * share).length_squared()
}
