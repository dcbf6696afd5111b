//! Surroundings as a picture: what lights hair and skin from all around.
//!
//! Hair sees them as spherical harmonics up to the second order [Ramamoorthi2001, §3], carried through the grid of
//! scattered light, so that hair and body hide them. A place much brighter than the rest, the sun or a lamp, is taken
//! out and shines as a distant light with a shadow.

mod exr;
mod hdr;
mod panorama;
mod size;

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use strandline_base::math;

pub use panorama::Panorama;

use crate::light_field::{self, Field};
use crate::{Light, LightKind};

/// Most lights that are taken out of a picture.
const MOST_SUNS: usize = 2;
/// Ratio of a pixel of such a light to the mean.
const BRIGHT: f32 = 16.0;
/// Cosine of the angle around the brightest pixel that belongs to its light: 8 degrees.
const WITHIN: f32 = 0.990_268;
/// Least share of all light that is taken out.
const LEAST_SHARE: f32 = 0.04;
/// Rows that are enough for what is kept of a picture.
const ROWS: usize = 256;

/// Light from all around, as it is used.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    pub(crate) field: Field,
    pub(crate) suns: Vec<Light>,
}

/// A direction's radiance and its part of the sphere, 0 to 1.
struct Ray {
    way: Vec3,
    light: Vec3,
    share: f32,
}

impl Surroundings {
    /// Light of a picture, turned about the vertical by an angle \[degrees\] (counter-clockwise from above)
    /// and multiplied. The middle of the picture lies toward +z, its right half toward -x.
    pub fn new(panorama: &Panorama, rotation: f32, strength: f32) -> Self {
        let small = panorama.reduced(ROWS);
        let mut rays = rays(&small, rotation.to_radians(), strength);
        let suns = suns(&mut rays);
        let mut field = Field::default();
        for ray in &rays {
            light_field::add(&mut field, ray.way, (ray.light * ray.share).extend(0.0));
        }
        Self { field, suns }
    }

    /// The lights that were taken out, with a shadow each.
    pub fn suns(&self) -> &[Light] {
        &self.suns
    }

    /// Mean radiance of the rest, linear RGB.
    pub fn mean(&self) -> Vec3 {
        self.field[0].truncate()
    }
}

fn rays(panorama: &Panorama, turn: f32, strength: f32) -> Vec<Ray> {
    let [width, height] = panorama.size();
    let ray = |index: usize| {
        let (column, row) = (index % width, index / width);
        // Heights of a row's borders give its part of the sphere exactly.
        let border = |row: usize| math::cos(PI * row as f32 / height as f32);
        let (upper, lower) = (border(row), border(row + 1));
        let y = 0.5 * (upper + lower);
        let flat = (1.0 - y * y).max(0.0).sqrt();
        let (sine, cosine) = math::sin_cos(TAU * ((column as f32 + 0.5) / width as f32 - 0.5) - turn);
        Ray {
            way: Vec3::new(-sine * flat, y, cosine * flat),
            light: panorama.pixels()[index] * strength,
            share: 0.5 * (upper - lower) / width as f32,
        }
    };
    (0..width * height).map(ray).collect()
}

/// Takes bright lights out of the rays.
fn suns(rays: &mut [Ray]) -> Vec<Light> {
    let whole: f32 = rays.iter().map(|ray| ray.light.element_sum() * ray.share).sum();
    let mut suns = Vec::new();
    while suns.len() < MOST_SUNS {
        let bright = |ray: &Ray| ray.light.element_sum();
        let Some(peak) = rays.iter().max_by(|one, other| bright(one).total_cmp(&bright(other))) else {
            break;
        };
        if bright(peak) <= BRIGHT * whole {
            break;
        }
        let (middle, limit) = (peak.way, BRIGHT * whole);
        let is_part =
            |ray: &&mut Ray| ray.way.dot(middle) >= WITHIN && ray.light.element_sum() > 0.25 * limit;
        let (mut way, mut light) = (Vec3::ZERO, Vec3::ZERO);
        let mut taken = Vec::new();
        for ray in rays.iter_mut().filter(is_part) {
            let part = ray.light * ray.share;
            way += ray.way * part.element_sum();
            light += part;
            // The surroundings of the light continue below it.
            taken.push(ray);
        }
        if light.element_sum() < LEAST_SHARE * whole {
            break;
        }
        taken.into_iter().for_each(|ray| ray.light = Vec3::splat(whole / 3.0).min(ray.light));
        suns.push(distant(way.normalize_or(Vec3::Y), light * 4.0));
    }
    suns
}

/// A light from far away; `light` is its irradiance over pi.
fn distant(way: Vec3, light: Vec3) -> Light {
    let intensity = light.max_element().max(1e-12);
    let color = light / intensity;
    Light {
        kind: LightKind::Directional,
        position: way,
        target: Vec3::ZERO,
        color,
        intensity,
        ..Light::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panorama(light: impl Fn(usize, usize) -> Vec3) -> Panorama {
        let pixels = (0..64 * 128).map(|index| light(index % 128, index / 128)).collect();
        Panorama::new(128, 64, pixels).unwrap()
    }

    #[test]
    fn even_surroundings_are_even() {
        let found = Surroundings::new(&panorama(|_, _| Vec3::new(0.5, 1.0, 2.0)), 30.0, 2.0);
        assert!(found.suns.is_empty());
        assert!((found.mean() - Vec3::new(1.0, 2.0, 4.0)).abs().max_element() < 1e-3);
        // Rows of 2.8 degrees stand for their middles: the mean square of the height is 1.3e-4 too small, times 7.5
        // times the 4 of blue.
        for part in &found.field[1..] {
            assert!(part.truncate().abs().max_element() < 5e-3, "{part}");
        }
    }

    #[test]
    fn a_sun_is_a_light_where_the_picture_has_it() {
        // In the right half, a quarter of a turn from the middle, 45 degrees up: toward -x.
        let shine = |column: usize, row: usize| {
            if (95..97).contains(&column) && (15..17).contains(&row) {
                Vec3::splat(4000.0)
            } else {
                Vec3::ONE
            }
        };
        let found = Surroundings::new(&panorama(shine), 0.0, 1.0);
        let [sun] = &found.suns[..] else { panic!("{:?}", found.suns) };
        let expected = Vec3::new(-1.0, 1.0, 0.0).normalize();
        assert!(sun.position.distance(expected) < 0.03, "{}", sun.position);
        // Four pixels of (2 pi / 128) by (pi / 64) rad, foreshortened: irradiance over pi.
        let solid = 4.0 * (TAU / 128.0) * (PI / 64.0) * std::f32::consts::FRAC_1_SQRT_2;
        assert!((sun.intensity / (4000.0 * solid / PI) - 1.0).abs() < 0.02, "{} {solid}", sun.intensity);
        // The rest is even, and only the light of the sky behind the sun is lost.
        assert!((found.mean().x - 1.0).abs() < 0.05, "{}", found.mean());
        // A quarter turn to the left brings it before the face.
        let turned = Surroundings::new(&panorama(shine), 90.0, 1.0);
        let before = Vec3::new(0.0, 1.0, 1.0).normalize();
        assert!(turned.suns[0].position.distance(before) < 0.03, "{}", turned.suns[0].position);
    }
}
