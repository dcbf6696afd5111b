//! The lit body under the hair of a tile.

use glam::{Vec2, Vec4};

use super::coverage::OPAQUE;
use super::light_shares::LightShares;
use super::pixels::{Pixels, is_near};
use crate::cpu::shade::skin::Skin;
use crate::frame::samples::{NO_TRIANGLE, TILE};
use crate::surfaces::Painted;

/// The body in one tile.
#[derive(Clone, Copy)]
pub(super) struct Under<'a> {
    pub pixels: Pixels<'a>,
    pub skin: &'a Skin<'a>,
    pub triangles: &'a [u32],
    pub depths: &'a [f32],
}

impl Under<'_> {
    /// Puts the lit body under what is there. The samples of a pixel that show the same surface are lit
    /// together.
    pub fn fill(&self, colors: &mut [Vec4]) {
        let pixel = self.pixels.side;
        let mut shares = LightShares::new(&self.pixels, colors);
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
                        let place = self.pixels.place(self.triangles[index], corner.map(|at| at as isize));
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
        let Pixels { body, projection, corner, side: pixel, .. } = self.pixels;
        let surfaces = body.surfaces.as_ref().filter(|_| self.skin.look.materials)?;
        let painted = |sample: usize| {
            let (x, y) = (column + sample % pixel, row + sample / pixel);
            let triangle = self.triangles[y * TILE + x];
            if triangle == NO_TRIANGLE || !is_near(depth, self.depths[y * TILE + x]) {
                return None;
            }
            let place = Vec2::from(corner.map(|at| at as f32)) + Vec2::new(x as f32, y as f32) + 0.5;
            let sight = body.sight(triangle, projection, place);
            Some(body.painted(surfaces, triangle, &sight, projection))
        };
        Painted::mean((first..pixel * pixel).filter_map(painted))
    }
}
