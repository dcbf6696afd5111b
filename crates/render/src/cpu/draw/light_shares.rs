//! Shares of soft lights that reach the body, found for neighbouring pixels together.
//!
//! A pixel follows a part of the rays to a place of a light, and those beside it the others [Keller2001]: a sixteenth each in
//! squares of four pixels along a side where the rays are a multiple of 64, and where they are one of 16 a quarter, of every
//! fourth place of a light. It shows the mean of the pixels about it by a tent filter (1 2 3 4 3 2 1 along both axes), in which
//! all parts have the same weight: so much less work, and shadows that are softer by two pixels. Where not all these pixels
//! lie as deep, those of squares of two follow a quarter each (1 2 1). A pixel at an outline or almost alone between hairs
//! follows all rays.
//!
//! Other rays are followed by each pixel; in simpler pictures by one in a square of two, and the others show the mean of
//! those about them.

use glam::Vec4;

use super::coverage::OPAQUE;
use super::pixels::{Pixels, is_near};
use crate::cpu::shade::skin::SkinPoint;
use crate::frame::samples::TILE;
use crate::shadow::ShadowMap;

/// Pixels beside those of the tile, on each side, that share rays with them.
const BESIDE: usize = 3;
/// Pixels along a side of the largest square.
const LARGEST: usize = 4;
/// Squares of pixels that share rays, those that share more of them first.
const SQUARES: [Square; 2] = [
    // Neighbours follow rays to distant parts of a light.
    Square {
        side: LARGEST,
        parts: &[0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5],
        weights: &[0.0625, 0.125, 0.1875, 0.25, 0.1875, 0.125, 0.0625],
        least: 12,
    },
    Square { side: 2, parts: &[0, 1, 2, 3], weights: &[0.25, 0.5, 0.25], least: 4 },
];

/// Places of a light that take turns among the pixels of the larger square.
const PLACES: usize = 4;

/// Pixels that share rays.
struct Square {
    /// Pixels along a side.
    side: usize,
    /// Numbers of its pixels, by which they choose parts of the rays: shape `[row][column]`.
    parts: &'static [usize],
    /// Weights of the pixels about one along an axis.
    weights: &'static [f32],
    /// Least number of the pixels about one that show the body: the parts of fewer cost as much as all rays of each.
    least: usize,
}

impl Square {
    /// Indices of the pixels about one, of so many along a side, and their weights.
    fn about(&self, side: usize, middle: usize) -> impl Iterator<Item = (usize, f32)> + use<> {
        let (weights, first) = (self.weights, middle - self.weights.len() / 2 * (side + 1));
        weights.iter().enumerate().flat_map(move |(y, high)| {
            weights.iter().enumerate().map(move |(x, wide)| (first + y * side + x, wide * high))
        })
    }

    /// Numbers of pixels in their squares, of so many along a side about a tile, which is a whole number of squares.
    fn numbers(&self, side: usize) -> Vec<usize> {
        let at = |at: usize| (at + LARGEST - BESIDE) % self.side;
        let row = |row: usize| (0..side).map(move |column| self.parts[at(row) * self.side + at(column)]);
        (0..side).flat_map(row).collect()
    }
}

/// The shares in a tile, in which each pixel is looked at once.
pub(super) struct LightShares<'a> {
    pixels: &'a Pixels<'a>,
    /// Pixels along a side: those of the tile and those beside it.
    side: usize,
    /// True for pixels that show the body, not hair alone; those beside the tile may.
    shown: Vec<bool>,
    /// Places of the body in the pixels with one over their view depths \[1/m\], as far as somebody asked for them.
    places: Vec<Option<Option<(SkinPoint, f32)>>>,
    /// By kind of square.
    sharings: [Sharing; SQUARES.len()],
    /// The pixel that is looked at, and one over its view depth \[1/m\].
    middle: usize,
    depth: f32,
}

/// Known shares of squares of one kind.
#[derive(Default)]
struct Sharing {
    /// Numbers of pixels in their squares; empty as long as nobody asked.
    numbers: Vec<usize>,
    /// Shares that pixels found, shape `[light][row][column]`; NaN where nobody asked for them.
    found: Vec<f32>,
    /// True if the pixels about the one that is looked at share rays; `None` as long as nobody asked.
    is_shared: Option<bool>,
}

/// A place of a light.
struct Source<'a> {
    map: &'a ShadowMap,
    /// Its number among the places of all lights.
    light: usize,
    /// Its number among the places of its light, and the number of these.
    places: [usize; 2],
}

/// Parting of the rays to a place among the pixels of a square.
enum Parting {
    /// Each follows a part, of so many.
    All(usize),
    /// One of four does; this is the number of that place.
    Fourth(usize),
    /// One follows all rays.
    First,
}

impl Source<'_> {
    /// Its parting among the pixels of a square; `None` if these share no rays.
    fn parting(&self, square: &Square) -> Option<Parting> {
        let [place, count] = self.places;
        let parts = square.parts.len();
        if self.map.parts_rays(count, parts) {
            Some(Parting::All(parts))
        } else if parts == 4 * PLACES && self.map.parts_rays(count, 4) {
            Some(Parting::Fourth(place % PLACES))
        } else {
            (self.map.settings.simple && parts == 4).then_some(Parting::First)
        }
    }
}

impl Parting {
    /// The part of the rays that a pixel of a number in its square follows, and the number of parts; `None` if it follows
    /// none.
    fn part(&self, number: usize) -> Option<[usize; 2]> {
        match *self {
            Self::All(parts) => Some([number, parts]),
            Self::Fourth(place) => (number / 4 == place).then_some([number % 4, 4]),
            Self::First => (number == 0).then_some([0, 1]),
        }
    }
}

impl<'a> LightShares<'a> {
    /// None yet; colours are those of the hair in the tile.
    pub fn new(pixels: &'a Pixels<'a>, colors: &[Vec4]) -> Self {
        let inner = TILE / pixels.side;
        let side = inner + 2 * BESIDE;
        let is_open = |sample: usize, [column, row]: [usize; 2]| {
            let (x, y) =
                (column * pixels.side + sample % pixels.side, row * pixels.side + sample / pixels.side);
            colors[y * TILE + x].w < OPAQUE
        };
        let shown = (0..side * side).map(|index| {
            let place = [index % side, index / side].map(|at| at.wrapping_sub(BESIDE));
            let is_inner = place.iter().all(|at| *at < inner);
            !is_inner || (0..pixels.side * pixels.side).any(|sample| is_open(sample, place))
        });
        let shown = shown.collect();
        Self { pixels, side, shown, places: Vec::new(), sharings: Default::default(), middle: 0, depth: 0.0 }
    }

    /// Turns to a pixel of the tile, at a column and a row, where it shows the body at one over a view depth \[1/m\].
    pub fn look(&mut self, [column, row]: [usize; 2], depth: f32) {
        (self.middle, self.depth) = ((row + BESIDE) * self.side + column + BESIDE, depth);
        self.sharings.iter_mut().for_each(|sharing| sharing.is_shared = None);
    }

    /// Share of a light that reaches the body in the pixel, of which a place is given. `light` numbers the places of all
    /// lights, `places` are the place's number among those of its light and their number.
    pub fn share(&mut self, map: &ShadowMap, light: usize, places: [usize; 2], place: &SkinPoint) -> f32 {
        let source = Source { map, light, places };
        let shared = (0..SQUARES.len()).find_map(|kind| self.shared(kind, &source));
        shared.unwrap_or_else(|| map.on_skin(place.point, place.normal, places))
    }

    /// The share that the pixels about the one that is looked at find together, if they share rays.
    fn shared(&mut self, kind: usize, source: &Source) -> Option<f32> {
        let square = &SQUARES[kind];
        let parting = source.parting(square)?;
        if !self.is_shared(kind) {
            return None;
        }
        if self.sharings[kind].numbers.is_empty() {
            self.sharings[kind].numbers = square.numbers(self.side);
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for (index, weight) in square.about(self.side, self.middle) {
            if let Some(part) = parting.part(self.sharings[kind].numbers[index]) {
                sum += weight * self.found(kind, index, source, part)?;
                weights += weight;
            }
        }
        Some(sum / weights)
    }

    /// True if the pixels about the one that is looked at share rays.
    fn is_shared(&mut self, kind: usize) -> bool {
        if let Some(known) = self.sharings[kind].is_shared {
            return known;
        }
        self.places.resize(self.side * self.side, None);
        let (side, middle, depth) = (self.side, self.middle, self.depth);
        let about = || SQUARES[kind].about(side, middle).map(|(index, _)| index);
        let is_shared = about().filter(|&index| self.shown[index]).count() >= SQUARES[kind].least
            && about().all(|index| self.place(index).is_some_and(|(_, other)| is_near(other, depth)));
        *self.sharings[kind].is_shared.insert(is_shared)
    }

    /// Share by a part of the rays from a pixel, given by its number and the number of parts.
    fn found(&mut self, kind: usize, index: usize, source: &Source, part: [usize; 2]) -> Option<f32> {
        let Source { map, light, places } = *source;
        let count = self.side * self.side;
        let known = light * count + index;
        let found = &mut self.sharings[kind].found;
        if found.len() <= known {
            found.resize((light + 1) * count, f32::NAN);
        }
        if found[known].is_nan() {
            let (SkinPoint { point, normal, .. }, _) = self.place(index)?;
            self.sharings[kind].found[known] = match part {
                [_, 1] => map.on_skin(point, normal, places),
                part => map.part_on_skin(point, normal, places, part),
            };
        }
        Some(self.sharings[kind].found[known])
    }

    /// The place of the first sample of a pixel that shows the body.
    fn place(&mut self, index: usize) -> Option<(SkinPoint, f32)> {
        let (pixels, side) = (self.pixels, self.side);
        *self.places[index].get_or_insert_with(|| {
            let pixel = pixels.side;
            let begin =
                [index % side, index / side].map(|at| (at as isize - BESIDE as isize) * pixel as isize);
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

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_body::{BodyFrame, Mesh};
    use strandline_groom::{Groom, Guides};

    use crate::{
        BodyLook, Camera, FrameInput, LevelOfDetail, Light, LightKind, Look, PictureSettings, Renderer,
    };

    /// Settings of a picture.
    #[derive(Clone, Copy)]
    struct Drawn {
        /// Rays to the light, and its places along a side.
        rays: u32,
        places: u32,
        /// Samples along a side of a pixel.
        supersampling: u32,
        simple: bool,
    }

    /// Reds of a floor under a plate in a soft light.
    fn floor(Drawn { rays, places, supersampling, simple }: Drawn) -> Vec<f32> {
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
            samples: places,
            ..Light::default()
        };
        let mut look = Look { hair_count: 0, follow_strands: 1, ..Look::brown() };
        look.shadow = crate::Shadow { map_size: 512, rays, simple, ..look.shadow };
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
        let all = Drawn { rays: 68, places: 1, supersampling: 2, simple: false };
        // Sharing rays makes the sharpest edge softer.
        let (little, soft) = (1e-3, 0.02..0.05);
        let cases = [
            // Parts of 64 rays, at both sizes of a pixel, and of 16 to each of four places.
            (all, Drawn { rays: 64, ..all }, little, soft.clone()),
            (
                Drawn { supersampling: 1, ..all },
                Drawn { supersampling: 1, rays: 64, ..all },
                little,
                soft.clone(),
            ),
            (Drawn { places: 2, ..all }, Drawn { places: 2, rays: 64, ..all }, little, soft),
            // Four rays of one of four pixels, in place of four of each: the steps between these go.
            (Drawn { rays: 4, ..all }, Drawn { rays: 4, simple: true, ..all }, 3e-3, 0.05..0.2),
        ];
        for (number, (all, shared, most_mean, edge)) in cases.into_iter().enumerate() {
            let [shared, all] = [shared, all].map(floor);
            let most = all.iter().copied().fold(0.0, f32::max);
            let off = shared.iter().zip(&all).map(|(shared, all)| (shared - all).abs() / most);
            let (sum, worst) = off.fold((0.0, 0.0_f32), |(sum, worst), off| (sum + off, worst.max(off)));
            let mean = sum / all.len() as f32;
            assert!(mean < most_mean && edge.contains(&worst), "case {number}: {mean} {worst}");
        }
    }
}
