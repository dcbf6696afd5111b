//! Shares of soft lights that reach the body, found for neighbouring pixels together.
//!
//! A pixel follows a quarter of the rays to a place of a light, and each of four pixels beside each other another one
//! [Keller2001]. It shows the mean of the nine pixels about it by a tent filter (1 2 1 along both axes), in which all
//! quarters have the same weight: a quarter of the work, and shadows that are softer by a pixel. Rays to a place whose
//! number is no multiple of 16 are followed by each pixel. A pixel at an outline or almost alone between hairs follows all
//! rays.

use glam::Vec4;

use super::coverage::OPAQUE;
use super::pixels::{Pixels, is_near};
use crate::cpu::shade::skin::SkinPoint;
use crate::frame::samples::TILE;
use crate::shadow::ShadowMap;

/// Pixels along a side of those that share rays.
const ABOUT: usize = 3;
/// Least number of them that show the body: for fewer, quarters of all nine cost as much as all rays of each.
const LEAST: usize = 4;

/// The shares in a tile, in which each pixel is looked at once.
pub(super) struct LightShares<'a> {
    pixels: &'a Pixels<'a>,
    /// Pixels along a side: those of the tile and one at each end.
    side: usize,
    /// True for pixels that show the body, not hair alone; those beside the tile may.
    shown: Vec<bool>,
    /// Places of the body in the pixels with one over their view depths \[1/m\], as far as somebody asked for them.
    places: Vec<Option<Option<(SkinPoint, f32)>>>,
    /// Shares found by a quarter of the rays, shape `[light][row][column]`; NaN where nobody asked for them.
    quarters: Vec<f32>,
    /// The pixel that is looked at, and one over its view depth \[1/m\].
    middle: usize,
    depth: f32,
    /// True if the nine pixels about it share rays; `None` as long as nobody asked.
    is_shared: Option<bool>,
}

impl<'a> LightShares<'a> {
    /// None yet; colours are those of the hair in the tile.
    pub fn new(pixels: &'a Pixels<'a>, colors: &[Vec4]) -> Self {
        let inner = TILE / pixels.side;
        let side = inner + 2;
        let is_open = |sample: usize, [column, row]: [usize; 2]| {
            let (x, y) =
                (column * pixels.side + sample % pixels.side, row * pixels.side + sample / pixels.side);
            colors[y * TILE + x].w < OPAQUE
        };
        let shown = (0..side * side).map(|index| {
            let [column, row] = [index % side, index / side];
            let is_inner = (1..=inner).contains(&column) && (1..=inner).contains(&row);
            !is_inner || (0..pixels.side * pixels.side).any(|sample| is_open(sample, [column - 1, row - 1]))
        });
        let shown = shown.collect();
        Self {
            pixels,
            side,
            shown,
            places: Vec::new(),
            quarters: Vec::new(),
            middle: 0,
            depth: 0.0,
            is_shared: None,
        }
    }

    /// Turns to a pixel of the tile, at a column and a row, where it shows the body at one over a view depth \[1/m\].
    pub fn look(&mut self, [column, row]: [usize; 2], depth: f32) {
        (self.middle, self.depth, self.is_shared) = ((row + 1) * self.side + column + 1, depth, None);
    }

    /// Share of a light that reaches the body in the pixel, of which a place is given. `light` numbers the places of all
    /// lights, `places` are the place's number among those of its light and their number.
    pub fn share(&mut self, map: &ShadowMap, light: usize, places: [usize; 2], place: &SkinPoint) -> f32 {
        let shared: Option<f32> = (map.parts_rays(places[1]) && self.is_shared())
            .then(|| {
                let nine = about(self.side, self.middle);
                nine.map(|(index, weight)| Some(weight * self.quarter(index, map, light, places)?)).sum()
            })
            .flatten();
        shared.unwrap_or_else(|| map.on_skin(place.point, place.normal, places))
    }

    /// True if the nine pixels about the one that is looked at share rays.
    fn is_shared(&mut self) -> bool {
        if let Some(known) = self.is_shared {
            return known;
        }
        self.places.resize(self.side * self.side, None);
        let (side, middle, depth) = (self.side, self.middle, self.depth);
        let about = || about(side, middle).map(|(index, _)| index);
        let is_shared = about().filter(|&index| self.shown[index]).count() >= LEAST
            && about().all(|index| self.place(index).is_some_and(|(_, other)| is_near(other, depth)));
        *self.is_shared.insert(is_shared)
    }

    /// Share by a quarter of the rays from a pixel; `None` if these cannot be parted.
    fn quarter(&mut self, index: usize, map: &ShadowMap, light: usize, places: [usize; 2]) -> Option<f32> {
        let count = self.side * self.side;
        let known = light * count + index;
        if self.quarters.len() <= known {
            self.quarters.resize((light + 1) * count, f32::NAN);
        }
        if self.quarters[known].is_nan() {
            let (place, _) = self.place(index)?;
            let inner = self.side - 2;
            let parity = |axis: usize, at: usize| (self.pixels.corner[axis] / TILE * inner + at) % 2;
            let quarter = parity(0, index % self.side) + 2 * parity(1, index / self.side);
            self.quarters[known] = map.quarter_on_skin(place.point, place.normal, places, quarter)?;
        }
        Some(self.quarters[known])
    }

    /// The place of the first sample of a pixel that shows the body.
    fn place(&mut self, index: usize) -> Option<(SkinPoint, f32)> {
        let (pixels, side) = (self.pixels, self.side);
        *self.places[index].get_or_insert_with(|| {
            let pixel = pixels.side;
            let begin = [index % side, index / side].map(|at| (at as isize - 1) * pixel as isize);
            let sample = |number: usize| {
                let at = [begin[0] + (number % pixel) as isize, begin[1] + (number / pixel) as isize];
                let at = [0, 1].map(|axis| pixels.corner[axis].checked_add_signed(at[axis]));
                let [Some(column), Some(row)] = at else { return None };
                pixels.seen.at([column, row])
            };
            let (triangle, depth) = (0..pixel * pixel).find_map(sample)?;
            Some((pixels.place(triangle, begin), depth))
        })
    }
}

/// The nine pixels about one of so many along a side, and their weights.
fn about(side: usize, middle: usize) -> impl Iterator<Item = (usize, f32)> {
    (0..ABOUT * ABOUT).map(move |number| {
        let [x, y] = [number % ABOUT, number / ABOUT];
        let weight = |at: usize| if at == 1 { 0.5 } else { 0.25 };
        (middle + y * side + x - side - 1, weight(x) * weight(y))
    })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_body::{BodyFrame, Mesh};
    use strandline_groom::{Groom, Guides};

    use crate::{
        BodyLook, Camera, FrameInput, LevelOfDetail, Light, LightKind, Look, PictureSettings, Renderer,
    };

    /// Reds of a floor under a plate in a soft light, by so many rays and samples along a side of a pixel.
    fn floor(rays: u32, supersampling: u32) -> Vec<f32> {
        let square = |height: f32, half: f32| {
            [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, z)| Vec3::new(x, height, z))
        };
        let mesh = Mesh {
            positions: [square(0.0, 0.5), square(0.06, 0.06)].concat(),
            normals: vec![Vec3::Y; 8],
            triangles: vec![[0, 2, 1], [0, 3, 2], [4, 6, 5], [4, 7, 6]],
            ..Mesh::default()
        };
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::new(0.4, 0.0, 0.4), Vec3::new(0.4, 0.01, 0.4)]);
        let guides = Guides::resample(&groom, 4).unwrap();
        let settings = PictureSettings { supersampling, ..PictureSettings::sized(80, 70) };
        let mut renderer = Renderer::new(&guides, Some(&mesh), &settings).unwrap();
        let camera = Camera { position: Vec3::new(0.05, 0.5, 0.3), target: Vec3::ZERO, ..Camera::front() };
        let light = Light {
            kind: LightKind::Rectangle,
            position: Vec3::new(0.4, 1.0, 0.1),
            width: 0.6,
            height: 0.5,
            samples: 1,
            ..Light::default()
        };
        let mut look = Look { hair_count: 0, follow_strands: 1, ..Look::brown() };
        (look.shadow.map_size, look.shadow.rays) = (512, rays);
        let input = FrameInput {
            positions: guides.positions(),
            body: &BodyFrame::REST,
            camera: &camera,
            look: &look,
            body_look: &BodyLook { softness: 0.0, ..BodyLook::default() },
            lights: &[light],
            level_of_detail: &LevelOfDetail::default(),
        };
        renderer.draw_samples(&input).unwrap();
        renderer.samples().colors.iter().map(|color| color.x).collect()
    }

    #[test]
    fn pixels_that_share_rays_are_as_bright_as_pixels_that_follow_all() {
        for supersampling in [1, 2] {
            // 68 rays cannot be parted.
            let [shared, all] = [64, 68].map(|rays| floor(rays, supersampling));
            let most = all.iter().copied().fold(0.0, f32::max);
            let off = shared.iter().zip(&all).map(|(shared, all)| (shared - all).abs() / most);
            let (sum, worst) = off.fold((0.0, 0.0_f32), |(sum, worst), off| (sum + off, worst.max(off)));
            let mean = sum / all.len() as f32;
            // Sharing rays makes the sharpest edge softer.
            assert!(mean < 1e-3 && (0.015..0.05).contains(&worst), "{supersampling}: {mean} {worst}");
        }
    }
}
