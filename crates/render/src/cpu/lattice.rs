//! Scattering among the directions along which light is carried through a grid.
//!
//! The fibre is looked up between single directions and scaled, for each kind of path, so that the sum over the
//! directions is the share of light that goes that way: even light stays even whatever the directions resolve.

use glam::{IVec3, Vec3, Vec4};
use strandline_base::math;
use strandline_base::par::prelude::*;

use super::light_field;
use crate::fibre::chiang::{Lobes, Met, Pigments, Seen, Table};

/// Directions along which light is carried.
pub const DIRECTIONS: usize = 26;
/// Directions of hair for which scattering is known, on half of the sphere.
pub const TANGENTS: usize = 256;
/// Variance of the inclination \[rad^2\] by which lobes are widened: directions stand for all around them.
const SPREAD: f64 = 0.005;

/// Radiance of every direction.
pub type Rays = [Vec4; DIRECTIONS];

/// Scattering of one fibre.
#[derive(Clone, Debug)]
pub struct Lattice {
    table: Table,
    pigment: f32,
    /// Unit directions in which light goes, and their shares of the sphere.
    ways: [(Vec3, f32); DIRECTIONS],
    tangents: Vec<Vec3>,
    /// What hair shows toward where light goes, of light that goes some way: shape `[tangent][shown][arriving]`.
    shown: Vec<[Rays; DIRECTIONS]>,
    albedo: Vec4,
}

/// The directions: steps from cell to cell, with their shares of the sphere.
pub fn directions() -> [(IVec3, f32); DIRECTIONS] {
    let mut found = [(IVec3::ZERO, 0.0); DIRECTIONS];
    let mut count = 0;
    for index in 0..27 {
        let step = IVec3::new(index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1);
        // [Lebedev1976]: sums of polynomials up to the seventh order are exact.
        let share = match step.length_squared() {
            1 => 1.0 / 21.0,
            2 => 4.0 / 105.0,
            3 => 9.0 / 280.0,
            _ => continue,
        };
        found[count] = (step, share);
        count += 1;
    }
    found
}

impl Lattice {
    /// The scattering of a fibre; absorption per fibre radius, times `pigment`.
    pub fn new(lobes: &Lobes, absorption: [f64; 3], pigment: f32) -> Self {
        let table = Table::new(&lobes.spread(SPREAD), absorption);
        let ways = directions().map(|(step, share)| (step.as_vec3().normalize(), share));
        let tangents: Vec<Vec3> = (0..TANGENTS).map(tangent).collect();
        let albedo = table.moments(0.5, Pigments::Even(pigment))[0];
        let mut lattice = Self { table, pigment, ways, tangents, shown: Vec::new(), albedo };
        lattice.shown =
            lattice.tangents.par_iter().map(|&t| ways.map(|(way, _)| lattice.weights(t, way))).collect();
        lattice
    }

    /// The tables that scattering is looked up in.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The entries of the tables; known directions of hair; what hair shows, shape `[tangent][shown][arriving]`.
    pub fn entries(&self) -> Vec<Vec4> {
        let tangents = self.tangents.iter().map(|tangent| tangent.extend(0.0));
        let shown = self.shown.iter().flatten().flatten().copied();
        self.table.entries.iter().copied().chain(tangents).chain(shown).collect()
    }

    /// The directions and their shares of the sphere.
    pub fn ways(&self) -> &[(Vec3, f32); DIRECTIONS] {
        &self.ways
    }

    /// The nearest known direction of hair to a unit tangent.
    pub fn nearest(&self, tangent: Vec3) -> usize {
        let dots = self.tangents.iter().map(|known| known.dot(tangent).abs());
        dots.enumerate().fold((0, -1.0), |best, next| if next.1 > best.1 { next } else { best }).0
    }

    /// What hair of unit tangent `t` shows toward where `to_eye` points of light along each direction.
    pub fn weights(&self, t: Vec3, to_eye: Vec3) -> Rays {
        let sine = t.dot(to_eye);
        let u = light_field::across(t, to_eye);
        let seen = self.seen(sine);
        let paths = self.ways.map(|(way, share)| {
            let solid = 4.0 * std::f32::consts::PI * share;
            self.paths(u, &seen, &Arriving::new(t, -way)).map(|path| path * solid)
        });
        let shares = self.table.shares(sine, self.pigment);
        let mut sums = [Vec3::ZERO; 3];
        for path in &paths {
            sums.iter_mut().zip(path).for_each(|(sum, path)| *sum += *path);
        }
        let scales: [Vec3; 3] = std::array::from_fn(|path| shares[path] / sums[path].max(Vec3::splat(1e-20)));
        paths.map(|[r, tt, trt]| (r * scales[0] + tt * scales[1] + trt * scales[2]).extend(0.0))
    }

    /// What is seen by the sine of the eye's inclination.
    fn seen(&self, sine: f32) -> Seen {
        Seen::new(sine, Pigments::Even(self.pigment))
    }

    #[inline]
    fn paths(&self, u: Vec3, seen: &Seen, light: &Arriving) -> [Vec3; 3] {
        let turn = (u.dot(light.to_light) / light.flat).clamp(-1.0, 1.0);
        self.table.by_path(seen, &light.met, turn, 0.0)
    }

    /// How hair of unit tangent `t` is seen along every direction.
    pub fn shows(&self, t: Vec3) -> [Shows; DIRECTIONS] {
        self.ways.map(|(way, share)| {
            let sine = t.dot(way);
            let weight = 4.0 * std::f32::consts::PI * share * flat(sine);
            Shows { u: light_field::across(t, way), seen: self.seen(sine), weight }
        })
    }

    /// Adds what hair of unit tangent `t` shows along every direction of light of the given radiance (of a white
    /// surface that faces it) from a unit direction; what is shown all around is what meets the hair.
    pub fn add_light(
        &self,
        t: Vec3,
        shows: &[Shows; DIRECTIONS],
        to_light: Vec3,
        light: Vec3,
        shown: &mut Rays,
    ) {
        let arriving = Arriving::new(t, to_light);
        let mut sums = [Vec3::ZERO; 3];
        let paths = shows.each_ref().map(|Shows { u, seen, weight }| {
            let path = self.paths(*u, seen, &arriving);
            sums.iter_mut().zip(path).for_each(|(sum, path)| *sum += path * *weight);
            path
        });
        let sine = t.dot(to_light);
        let shares = self.table.shares(sine, self.pigment);
        let light = light * std::f32::consts::PI;
        let scales: [Vec3; 3] = std::array::from_fn(|path| {
            light * shares[path] * flat(sine) / sums[path].max(Vec3::splat(1e-20))
        });
        for (shown, [r, tt, trt]) in shown.iter_mut().zip(paths) {
            *shown += (r * scales[0] + tt * scales[1] + trt * scales[2]).extend(0.0);
        }
    }

    /// Adds what hair near tangent number `tangent` shows of light along every direction; a share `order` of the hair
    /// has that tangent, the rest lies every way and shows the same all around.
    pub fn add_shown(&self, tangent: usize, order: f32, light: &Rays, shown: &mut Rays) {
        let mean: Vec4 = light.iter().zip(&self.ways).map(|(light, (_, share))| *light * *share).sum();
        let unordered = self.albedo * mean * (1.0 - order);
        for (weights, shown) in self.shown[tangent].iter().zip(shown) {
            let ordered: Vec4 = weights.iter().zip(light).map(|(weight, light)| *weight * *light).sum();
            *shown += ordered * order + unordered;
        }
    }

    /// Share of even light that hair gives back, as a mean over its directions.
    pub fn albedo(&self) -> Vec4 {
        self.albedo
    }
}

/// How hair is seen along one direction.
#[derive(Clone, Copy, Debug)]
pub struct Shows {
    /// A unit vector across the hair toward the eye.
    u: Vec3,
    seen: Seen,
    /// What it weighs in the sum of all that is shown.
    weight: f32,
}

/// Light that meets hair from one direction.
struct Arriving {
    to_light: Vec3,
    /// Cosine of its inclination.
    flat: f32,
    met: Met,
}

impl Arriving {
    #[inline]
    fn new(t: Vec3, to_light: Vec3) -> Self {
        let sine = t.dot(to_light);
        Self { to_light, flat: (1.0 - sine * sine).max(1e-8).sqrt(), met: Met::new(sine) }
    }
}

/// The cosine of a sine.
#[inline]
fn flat(sine: f32) -> f32 {
    (1.0 - sine * sine).max(0.0).sqrt()
}

/// Unit vectors spread evenly over half of the sphere.
fn tangent(index: usize) -> Vec3 {
    let height = 1.0 - (index as f32 + 0.5) / TANGENTS as f32;
    let flat = (1.0 - height * height).sqrt();
    let turn = index as f32 * 2.399_963_2;
    Vec3::new(flat * math::cos(turn), height, flat * math::sin(turn))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fibre::Chiang;

    #[test]
    fn even_light_stays_even_about_white_hair() {
        let lattice = Lattice::new(&Chiang::default().lobes(), [0.0; 3], 1.0);
        for tangent in 0..TANGENTS {
            for order in [0.0, 0.3, 1.0] {
                let mut shown = Rays::default();
                lattice.add_shown(tangent, order, &[Vec4::ONE; DIRECTIONS], &mut shown);
                for shown in shown {
                    assert!((shown.x - 1.0).abs() < 1e-3, "{tangent}: {shown}");
                }
            }
        }
    }

    #[test]
    fn what_meets_white_hair_is_shown_all_around() {
        let lattice = Lattice::new(&Chiang::default().lobes(), [0.0; 3], 1.0);
        let (t, to_light) = (Vec3::new(0.2, 0.9, 0.1).normalize(), Vec3::new(0.4, 0.7, 0.6).normalize());
        let mut shown = Rays::default();
        lattice.add_light(t, &lattice.shows(t), to_light, Vec3::ONE, &mut shown);
        let leaves = |(shown, (way, share)): (&Vec4, &(Vec3, f32))| {
            shown.x * 4.0 * share * (1.0 - t.dot(*way).powi(2)).sqrt()
        };
        let sum: f32 = shown.iter().zip(lattice.ways()).map(leaves).sum();
        let meets = (1.0 - t.dot(to_light).powi(2)).sqrt();
        assert!((sum / meets - 1.0).abs() < 1e-3, "{sum} {meets}");
    }
}
