//! The depth of a body in a light's map.

use glam::{Vec2, Vec3};

use crate::lanes::rounded_up;
use crate::shadow::{LightView, Window};
use crate::surfaces::Surfaces;

/// Half a texel and more than rounding adds.
const HALF: f32 = 0.501;

/// A body that casts shadows and reflects light into hair, already in its place.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBody<'a> {
    /// Vertex positions \[m\], world space.
    pub positions: &'a [Vec3],
    /// Corner indices.
    pub triangles: &'a [[u32; 3]],
    /// Density of roots about every vertex, 0 to 1; empty without roots.
    pub roots: &'a [f32],
    /// Parts of triangles that are cut away, where there are some.
    pub cuts: Option<Cuts<'a>>,
}

/// Parts of triangles that materials cut away.
#[derive(Clone, Copy, Debug)]
pub struct Cuts<'a>(&'a Surfaces);

impl<'a> Cuts<'a> {
    /// Cut-outs of the materials of a body.
    pub(crate) fn of(surfaces: &'a Surfaces) -> Self {
        Self(surfaces)
    }

    fn cut(self, triangle: usize, shares: Vec3) -> bool {
        self.0.at(triangle as u32, shares, 0.0).is_cut()
    }
}

/// Draws the nearest depth \[m\] of a body into a square map that already holds depths.
pub(crate) fn draw_depth(
    body: &ShadowBody,
    view: &LightView,
    window: &Window,
    size: usize,
    depths: &mut [f32],
) {
    // Triangles with a corner behind the light are not finite.
    let place = |&position: &Vec3| match view.project(position) {
        Some(point) => window.texel(point.truncate()).extend(point.z),
        None => Vec3::NAN,
    };
    let places: Vec<Vec3> = body.positions.iter().map(place).collect();
    for (index, corners) in body.triangles.iter().enumerate() {
        let corners = corners.map(|corner| places[corner as usize]);
        match body.cuts {
            Some(cuts) => fill(corners, size, depths, |shares| !cuts.cut(index, shares)),
            None => fill(corners, size, depths, |_| true),
        }
    }
}

/// Fills one triangle where it is shown at shares of its corners, which are texel coordinates with depth.
fn fill(corners: [Vec3; 3], size: usize, depths: &mut [f32], shown: impl Fn(Vec3) -> bool) {
    let [a, b, c] = corners;
    let area = (b - a).truncate().perp_dot((c - a).truncate());
    if area.abs() < 1e-12 || !area.is_finite() {
        return;
    }
    let limit = Vec2::splat(size as f32);
    let min = a.min(b).min(c).truncate().max(Vec2::ZERO);
    let max = a.max(b).max(c).truncate().min(limit);
    if !min.cmplt(max).all() {
        return;
    }
    let inverse = 1.0 / area;
    // Texels whose middles may lie inside: most triangles are as small as a texel.
    let first = (min - HALF).max(Vec2::ZERO);
    let end = max - (1.0 - HALF);
    for row in rounded_up(first.y)..rounded_up(end.y) {
        for column in rounded_up(first.x)..rounded_up(end.x) {
            let middle = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
            let from = |corner: Vec3| corner.truncate() - middle;
            let first = from(b).perp_dot(from(c)) * inverse;
            let second = from(c).perp_dot(from(a)) * inverse;
            let third = 1.0 - first - second;
            let is_inside = first >= 0.0 && second >= 0.0 && third >= 0.0;
            if is_inside && shown(Vec3::new(first, second, third)) {
                let depth = &mut depths[row as usize * size + column as usize];
                *depth = depth.min(first * a.z + second * b.z + third * c.z);
            }
        }
    }
}
