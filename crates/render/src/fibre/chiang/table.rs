//! The fibre seen from afar as tables, derived once on the host and read by both backends.
//!
//! Radiance over irradiance is the sum over the kinds of paths of a term along the fibre, which depends on both
//! inclinations, times one around it, which depends on the eye's inclination, the turn and the pigment.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{Vec3, Vec4};
use strandline_base::math;
use strandline_base::par::prelude::*;

use super::lobes::Lobes;
use super::moments::{MOMENTS, moments, powers};
pub use super::ring::{LEVEL_COUNT, LEVELS, TURNS};
use super::ring::{Ring, rings, turn_sums};

/// Nodes of the sum of both inclinations, -pi to pi.
pub const SUMS: usize = 257;
/// Nodes of the light's inclination less the eye's, -pi to pi.
pub const DIFFERENCES: usize = 49;
/// Nodes of the eye's inclination, 0 to pi / 2.
pub const EYES: usize = 17;
/// Nodes of the eye's inclination of the moments, -pi / 2 to pi / 2.
pub const MOMENT_EYES: usize = 2 * EYES - 1;

/// First entry of the terms around the fibre: two for each `[level][eye][turn]`.
pub const AROUND: usize = SUMS * DIFFERENCES;
/// First entry of the moments: [`MOMENTS`] for each `[level][eye]`.
pub const FIRST_MOMENT: usize = AROUND + 2 * LEVEL_COUNT * EYES * TURNS;
/// First entry of the shares of the kinds of paths: two for each `[level][eye]`, as those around the fibre.
pub const FIRST_SHARE: usize = FIRST_MOMENT + MOMENTS * LEVEL_COUNT * MOMENT_EYES;
/// Number of entries.
pub const ENTRIES: usize = FIRST_SHARE + 2 * LEVEL_COUNT * EYES;

/// The tables of one fibre.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Entries, shape `[...][4]`: along the fibre R, TT and TRT, times `evened`; around it TT and R (last), then TRT; moments.
    pub entries: Vec<Vec4>,
    /// Least product of cosines by which the terms along the fibre are evened out.
    pub floor: f32,
}

/// Pigment of a point as multiples of that of the tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pigments {
    /// The same for all channels.
    Even(f32),
    /// One for each channel.
    Channels(Vec3),
}

/// Table look-ups of one point of hair that all lights share.
#[derive(Clone, Copy, Debug)]
pub struct EyeRow {
    /// Inclination of the eye \[rad\], its sine, and one less the square of that.
    angle: f32,
    sine: f32,
    square: f32,
    /// Node before the angle, and share of the way to the next one.
    pub(super) row: (usize, f32),
    /// Levels of the pigment, of one channel or of three.
    pub(super) levels: [(usize, f32); 3],
    even: bool,
}

impl EyeRow {
    /// For the sine of the eye's inclination and a multiple of the pigment.
    #[inline]
    pub fn new(sine: f32, pigments: Pigments) -> Self {
        let (levels, even) = match pigments {
            Pigments::Even(pigment) => ([level_of(pigment); 3], true),
            Pigments::Channels(pigments) => (pigments.to_array().map(level_of), false),
        };
        Self { angle: 0.0, sine: 0.0, square: 1.0, row: (0, 0.0), levels, even }.at(sine)
    }

    /// The same where the inclination has another sine.
    #[inline]
    pub fn at(self, sine: f32) -> Self {
        let angle = arc_sine(sine);
        let row = place(angle.abs() * std::f32::consts::FRAC_2_PI, EYES);
        Self { angle, sine, square: 1.0 - sine * sine, row, ..self }
    }

    /// The same of hair of another's pigment.
    #[inline]
    pub fn of(self, other: &Self) -> Self {
        Self { levels: other.levels, even: other.even, ..self }
    }

    /// The sine of the eye's inclination.
    pub fn sine(&self) -> f32 {
        self.sine
    }
}

/// Table look-ups of light from one inclination that all eyes share.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    /// The inclination \[rad\], and one less the square of its sine.
    angle: f32,
    square: f32,
}

impl Met {
    /// For the sine of the light's inclination.
    #[inline]
    pub fn new(sine: f32) -> Self {
        Self { angle: arc_sine(sine), square: 1.0 - sine * sine }
    }
}

impl Table {
    /// Computes the tables of a fibre. `absorption` is that at the root, per fibre radius.
    pub fn new(lobes: &Lobes, absorption: [f64; 3]) -> Self {
        let mut entries = Vec::with_capacity(ENTRIES);
        // Wide lobes depend on little, and need no evening out.
        let floor = lobes.variance().powi(6).clamp(0.02, 1.0) as f32;
        entries.extend(terms_along(lobes, floor));
        let rings: Vec<[Ring; LEVEL_COUNT]> = (0..EYES)
            .into_par_iter()
            .map(|eye| rings(lobes, FRAC_PI_2 * eye as f64 / (EYES - 1) as f64, absorption))
            .collect();
        let levels = 0..LEVEL_COUNT;
        for level in levels.clone() {
            for &[r, tt, trt, rest] in rings.iter().flat_map(|rings| &rings[level]) {
                entries.push(vector(tt).extend(r[0] as f32));
                // The rest is as wide along the fibre as TRT, and little.
                entries.push((vector(trt) + vector(rest)).extend(0.0));
            }
        }
        let along: Vec<_> = (0..MOMENT_EYES)
            .into_par_iter()
            .map(|eye| powers(lobes, node(eye, MOMENT_EYES, FRAC_PI_2)))
            .collect();
        for level in levels.clone() {
            for (eye, along) in along.iter().enumerate() {
                // The nodes are those of the rings, on both sides of 0.
                let ring = &rings[eye.abs_diff(EYES - 1)][level];
                entries.extend(moments(along, ring).map(|moment| vector(moment).extend(0.0)));
            }
        }
        for level in levels.clone() {
            for rings in &rings {
                let [r, tt, trt, rest] = turn_sums(&rings[level], |_| 1.0);
                entries.push(vector(tt).extend(r[0] as f32));
                entries.push((vector(trt) + vector(rest)).extend(0.0));
            }
        }
        debug_assert_eq!(entries.len(), ENTRIES);
        Self { entries, floor }
    }

    /// Reflectance times the cosine of the light's inclination \[1/sr\], for the inclinations' sines of eye and
    /// light, the cosine of the turn between them, and a multiple of the pigment. `shift` \[rad\] moves the
    /// highlights.
    #[inline]
    pub fn scatter(&self, eye: f32, light: f32, turn: f32, pigments: Pigments, shift: f32) -> Vec3 {
        self.shown(&EyeRow::new(eye, pigments), light, turn, shift)
    }

    /// [`Table::scatter`] of many lights that one point shows.
    #[inline]
    pub fn shown(&self, seen: &EyeRow, light: f32, turn: f32, shift: f32) -> Vec3 {
        let [r, tt, trt] = self.by_path(seen, &Met::new(light), turn, shift);
        r + tt + trt
    }

    /// [`Table::shown`] of R, TT and TRT.
    #[inline]
    pub fn by_path(&self, seen: &EyeRow, met: &Met, turn: f32, shift: f32) -> [Vec3; 3] {
        self.by_path_along(&self.entries, seen, met, turn, shift)
    }

    /// [`Table::by_path`] with other [`terms_along`] the fibre.
    #[inline]
    pub(crate) fn by_path_along(
        &self,
        terms: &[Vec4],
        seen: &EyeRow,
        met: &Met,
        turn: f32,
        shift: f32,
    ) -> [Vec3; 3] {
        let (along, turn) = self.along(terms, seen, met, turn, shift);
        let around = if seen.even {
            self.around(seen.row, turn, seen.levels[0])
        } else {
            let found = seen.levels.map(|level| self.around(seen.row, turn, level));
            channels(found, [0, 1].map(|term| found[0][term].w))
        };
        paths(along, around)
    }

    /// Terms along the fibre, and the node before the turn of a cosine with the share of the way to the next one.
    #[inline]
    pub(super) fn along(
        &self,
        terms: &[Vec4],
        eye: &EyeRow,
        met: &Met,
        turn: f32,
        shift: f32,
    ) -> (Vec4, (usize, f32)) {
        let cosines = (eye.square * met.square).max(0.0).sqrt();
        let along = along(terms, eye.angle, met.angle, shift) / evened(cosines, self.floor);
        let turn = FRAC_PI_2 as f32 - arc_sine(turn);
        (along, place(turn * std::f32::consts::FRAC_1_PI, TURNS))
    }

    /// Terms around the fibre between nodes of the eye's inclination, the turn and the pigment.
    #[inline]
    fn around(&self, eye: (usize, f32), turn: (usize, f32), pigment: (usize, f32)) -> [Vec4; 2] {
        let ((row, down), (column, across), (level, between)) = (eye, turn, pigment);
        let at = |level: usize| {
            let first = AROUND + 2 * ((level * EYES + row) * TURNS + column);
            [0, 1].map(|part| {
                let entry = |offset: usize| self.entries[first + part + 2 * offset];
                let near = entry(0).lerp(entry(1), across);
                near.lerp(entry(TURNS).lerp(entry(TURNS + 1), across), down)
            })
        };
        let (low, high) = (at(level), at(level + 1));
        [low[0].lerp(high[0], between), low[1].lerp(high[1], between)]
    }

    /// Shares of light that go as R, TT and TRT.
    #[inline]
    pub fn shares(&self, seen: &EyeRow) -> [Vec3; 3] {
        let [first, second] = if seen.even {
            self.even_shares(seen.row, seen.levels[0])
        } else {
            let found = seen.levels.map(|level| self.even_shares(seen.row, level));
            channels(found, [0, 1].map(|term| found[0][term].w))
        };
        [Vec3::splat(first.w), first.truncate(), second.truncate()]
    }

    #[inline]
    fn even_shares(&self, (row, part): (usize, f32), (level, between): (usize, f32)) -> [Vec4; 2] {
        [0, 1].map(|half| {
            let at = |level: usize| {
                let first = FIRST_SHARE + 2 * (level * EYES + row) + half;
                self.entries[first].lerp(self.entries[first + 2], part)
            };
            at(level).lerp(at(level + 1), between)
        })
    }

    /// The fibre's moments (see `moments.rs`) for the sine of the eye's inclination and a multiple of the pigment.
    #[inline]
    pub fn moments(&self, eye: f32, pigments: Pigments) -> [Vec4; MOMENTS] {
        self.seen_moments(&EyeRow::new(eye, pigments))
    }

    /// [`Table::moments`] as the eye sees a fibre.
    #[inline]
    pub fn seen_moments(&self, seen: &EyeRow) -> [Vec4; MOMENTS] {
        if seen.even {
            self.even_moments(seen.angle, seen.levels[0])
        } else {
            channels(seen.levels.map(|level| self.even_moments(seen.angle, level)), [0.0; MOMENTS])
        }
    }

    #[inline]
    fn even_moments(&self, eye: f32, (level, between): (usize, f32)) -> [Vec4; MOMENTS] {
        let (row, part) = place(0.5 + eye * std::f32::consts::FRAC_1_PI, MOMENT_EYES);
        let first = FIRST_MOMENT + MOMENTS * (level * MOMENT_EYES + row);
        std::array::from_fn(|moment| {
            let at = |first: usize| {
                self.entries[first + moment].lerp(self.entries[first + MOMENTS + moment], part)
            };
            at(first).lerp(at(first + MOMENTS * MOMENT_EYES), between)
        })
    }
}

/// Terms along a fibre, times `evened` with the floor of its table: shape `[sum][difference]`.
pub(crate) fn terms_along(lobes: &Lobes, floor: f32) -> Vec<Vec4> {
    let nodes = (0..SUMS).flat_map(|sum| (0..DIFFERENCES).map(move |difference| (sum, difference)));
    let term = |(sum, difference)| {
        let [sum, difference] = [node(sum, SUMS, PI), node(difference, DIFFERENCES, PI)];
        let [eye, light] = [0.5 * (sum - difference), 0.5 * (sum + difference)];
        let [r, tt, trt, _] = lobes
            .inclinations(eye, light)
            .map(|density| density * f64::from(evened((math::cos(eye) * math::cos(light)) as f32, floor)));
        Vec4::new(r as f32, tt as f32, trt as f32, 0.0)
    };
    nodes.map(term).collect()
}

/// Terms along the fibre of R, TT and TRT, times `evened`.
#[inline]
fn along(terms: &[Vec4], eye: f32, light: f32, shift: f32) -> Vec4 {
    const WHOLE: f32 = std::f32::consts::PI;
    let (row, part) = place((eye + light + shift + WHOLE) / (2.0 * WHOLE), SUMS);
    let (column, across) = place((light - eye + WHOLE) / (2.0 * WHOLE), DIFFERENCES);
    let first = row * DIFFERENCES + column;
    let near = terms[first].lerp(terms[first + 1], across);
    let far = terms[first + DIFFERENCES].lerp(terms[first + DIFFERENCES + 1], across);
    near.lerp(far, part)
}

/// R, TT and TRT by their terms along the fibre and around it.
#[inline]
pub(super) fn paths(along: Vec4, [first, second]: [Vec4; 2]) -> [Vec3; 3] {
    [Vec3::splat(first.w * along.x), first.truncate() * along.y, second.truncate() * along.z]
}

/// One channel of each of three, and last lanes.
#[inline]
pub(super) fn channels<const N: usize>(found: [[Vec4; N]; 3], last: [f32; N]) -> [Vec4; N] {
    std::array::from_fn(|at| Vec4::new(found[0][at].x, found[1][at].y, found[2][at].z, last[at]))
}

/// Factor of the terms along the fibre that makes them depend almost on the sum of the inclinations alone;
/// from the product of the cosines.
#[inline]
fn evened(cosines: f32, floor: f32) -> f32 {
    cosines.max(floor).sqrt()
}

/// The angle of a sine of -1 to 1, to 7e-5.
#[inline]
pub(crate) fn arc_sine(sine: f32) -> f32 {
    let x = sine.abs().min(1.0);
    // [Abramowitz1964 eq. 4.4.45]
    let series = 1.570_728_8 + x * (-0.212_114_4 + x * (0.074_261 - 0.018_729_3 * x));
    (FRAC_PI_2 as f32 - (1.0 - x).sqrt() * series).copysign(sine)
}

/// The `index`-th of `count` nodes from -`end` to `end`.
fn node(index: usize, count: usize, end: f64) -> f64 {
    end * (2.0 * index as f64 / (count - 1) as f64 - 1.0)
}

/// Node before a share of the range, and share of the way to the next one.
#[inline]
fn place(share: f32, count: usize) -> (usize, f32) {
    let at = (share * (count - 1) as f32).clamp(0.0, count as f32 - 1.0);
    let low = (at as usize).min(count - 2);
    (low, at - low as f32)
}

/// Level before a multiple of the pigment, and share of the way to the next one.
#[inline]
fn level_of(pigment: f32) -> (usize, f32) {
    let level = LEVELS[1..LEVEL_COUNT - 1].iter().filter(|level| pigment >= **level).count();
    let (low, high) = (LEVELS[level], LEVELS[level + 1]);
    (level, ((pigment - low) / (high - low)).clamp(0.0, 1.0))
}

fn vector(channels: [f64; 3]) -> Vec3 {
    Vec3::from(channels.map(|channel| channel as f32))
}
