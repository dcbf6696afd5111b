//! Pixels of a tile and those about them, as the body shows in them.

use glam::{Vec2, Vec3};

use super::body::Body;
use super::sight::Sight;
use crate::cpu::shade::skin::SkinPoint;
use crate::frame::projection::Projection;
use crate::frame::samples::BodySamples;

/// The body in the pixels of one tile and about it.
#[derive(Clone, Copy)]
pub(super) struct Pixels<'a> {
    pub body: &'a Body,
    pub projection: &'a Projection,
    /// The body in all tiles.
    pub seen: BodySamples<'a>,
    /// Column and row of the tile's first sample.
    pub corner: [usize; 2],
    /// Samples along a side of a pixel.
    pub side: usize,
}

impl Pixels<'_> {
    /// The place of a triangle that is seen in the middle of the pixel that begins at a column and a row of the tile.
    pub fn place(&self, triangle: u32, [column, row]: [isize; 2]) -> SkinPoint {
        let corner = Vec2::from(self.corner.map(|at| at as f32)) + Vec2::new(column as f32, row as f32);
        let corners = self.body.triangle(triangle);
        let middle = corner + 0.5 * self.side as f32;
        let Sight { shares, way, face, .. } = self.body.sight(triangle, self.projection, middle);
        let mix =
            |of: &[Vec3]| of[corners[0]] * shares.x + of[corners[1]] * shares.y + of[corners[2]] * shares.z;
        let (point, normal) = (mix(&self.body.positions), mix(&self.body.normals).normalize_or(Vec3::Y));
        // The inside of an open mesh is lit like its outside.
        let normal = if normal.dot(way) > 0.0 && face.dot(way) > 0.0 { -normal } else { normal };
        let root = |corner: usize| self.body.roots.get(corner).copied().unwrap_or(0.0);
        SkinPoint { point, normal, rooted: Vec3::from(corners.map(root)).dot(shares) }
    }
}

/// True for two inverse depths \[1/m\] of one surface: less than half a per cent of the distance apart.
pub(super) fn is_near(known: f32, depth: f32) -> bool {
    (known - depth).abs() < 0.005 * depth
}
