//! The distance to one triangle.

use glam::DVec3;

use crate::layers::Corners;

/// The squared distance of a point from a triangle.
///
/// Double precision: in single precision the distance to a triangle that is small and far comes out
/// wrong by its whole size.
pub(crate) fn distance_squared(corners: &Corners, point: DVec3) -> f64 {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let edges = [edge(a, b, normal, point), edge(b, c, normal, point), edge(c, a, normal, point)];
    if edges.iter().all(|(_, is_inner)| *is_inner) {
        let height = (point - a).dot(normal);
        return height * height / normal.length_squared();
    }
    edges[0].0.min(edges[1].0).min(edges[2].0)
}

/// Whether a point is further than `reach` from the plane of a triangle; never for one without an area.
pub(crate) fn is_beyond_plane(corners: &Corners, point: DVec3, reach: f64) -> bool {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let height = (point - a).dot(normal);
    height * height > reach * reach * normal.length_squared()
}

/// The squared distance of a point from an edge, and whether the point is on its inner side.
fn edge(start: DVec3, end: DVec3, normal: DVec3, point: DVec3) -> (f64, bool) {
    let (axis, offset) = (end - start, point - start);
    // An edge of no length is its start.
    let share = (offset.dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let is_inner = axis.cross(offset).dot(normal) > 0.0;
    ((offset - axis * share).length_squared(), is_inner)
}
