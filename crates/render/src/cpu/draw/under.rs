//! The lit body under the hair of a tile.

use glam::{Vec2, Vec3, Vec4};

use super::body::Body;
use super::coverage::OPAQUE;
use super::light_shares::LightShares;
use super::sight::Sight;
use crate::cpu::shade::skin::{Skin, SkinPoint};
use crate::frame::projection::Projection;
use crate::frame::samples::{BodySamples, NO_TRIANGLE, TILE};
use crate::surfaces::Painted;

/// The body in one tile.
#[derive(Clone, Copy)]
pub(super) struct Under<'a> {
    pub body: &'a Body,
    pub projection: &'a Projection,
    pub skin: &'a Skin<'a>,
    /// The body in all tiles.
    pub seen: BodySamples<'a>,
    /// Column and row of the tile's first sample.
    pub corner: [usize; 2],
    pub triangles: &'a [u32],
    pub depths: &'a [f32],
    /// Samples along a side of a pixel.
    pub pixel: usize,
}

impl Under<'_> {
    /// Puts the lit body under what is there. The samples of a pixel that show the same surface are lit
    /// together.
    pub fn fill(&self, colors: &mut [Vec4]) {
        let pixel = self.pixel;
        let mut shares = LightShares::new(self, colors);
        for row in (0..TILE).step_by(pixel) {
            for column in (0..TILE).step_by(pixel) {
                let mut lit: Option<(f32, Vec4)> = None;
                for sample in 0..pixel * pixel {
                    let index = (row + sample / pixel) * TILE + column + sample % pixel;
                    if self.triangles[index] == NO_TRIANGLE || colors[index].w >= OPAQUE {
                        continue;
                    }
                    let depth = self.depths[index];
                    let known = lit.filter(|&(known, _)| is_near(known, depth));
                    let (_, radiance) = *lit.insert(known.unwrap_or_else(|| {
                        let corner = [column, row];
                        let painted = self.painted(corner, sample, depth);
                        let place = self.place(self.triangles[index], corner.map(|at| at as isize));
                        shares.look([column / pixel, row / pixel], depth);
                        let passed = |map: &_, light, places| shares.share(map, light, places, &place);
                        let radiance = self.skin.radiance(&place, painted.as_ref(), passed);
                        (depth, if radiance.is_finite() { radiance.extend(1.0) } else { Vec4::W })
                    }));
                    colors[index] += radiance * (1.0 - colors[index].w);
                }
            }
        }
    }

    /// The mean paint of the samples of a pixel, from one on, that show the surface at some depth; `None` without
    /// materials. The pixel begins at a column and a row.
    fn painted(&self, [column, row]: [usize; 2], first: usize, depth: f32) -> Option<Painted> {
        let (surfaces, pixel) =
            (self.body.surfaces.as_ref().filter(|_| self.skin.look.materials)?, self.pixel);
        let painted = |sample: usize| {
            let (x, y) = (column + sample % pixel, row + sample / pixel);
            let triangle = self.triangles[y * TILE + x];
            if triangle == NO_TRIANGLE || !is_near(depth, self.depths[y * TILE + x]) {
                return None;
            }
            let place = Vec2::from(self.corner.map(|at| at as f32)) + Vec2::new(x as f32, y as f32) + 0.5;
            let sight = self.body.sight(triangle, self.projection, place);
            Some(self.body.painted(surfaces, triangle, &sight, self.projection))
        };
        Painted::mean((first..pixel * pixel).filter_map(painted))
    }

    /// The place of a triangle that is seen in the middle of the pixel that begins at a column and a row of the tile.
    pub fn place(&self, triangle: u32, [column, row]: [isize; 2]) -> SkinPoint {
        let corner = Vec2::from(self.corner.map(|at| at as f32)) + Vec2::new(column as f32, row as f32);
        let corners = self.body.triangle(triangle);
        let middle = corner + 0.5 * self.pixel as f32;
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
