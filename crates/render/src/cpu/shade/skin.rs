//! Reflection of the body: soft diffuse and a mild highlight.

use std::f32::consts::PI;

use glam::Vec3;

use crate::cpu::{LightGrid, Occlusion};
use crate::shadow::{ShadowMap, Shadows};
use crate::strands::scalp::tint;
use crate::surfaces::Painted;
use crate::{BodyLook, Environment, Light};

/// Lights of the body.
#[derive(Clone, Copy)]
pub struct Skin<'a> {
    /// Its reflection.
    pub look: &'a BodyLook,
    /// The lights.
    pub lights: &'a [Light],
    /// Their shadows of hair and body.
    pub shadows: &'a Shadows,
    /// Surroundings hidden by the hair.
    pub occlusion: &'a Occlusion,
    /// Light that hair and skin scatter, where the fibre has it; that from all around is in it.
    pub grid: Option<&'a LightGrid>,
    /// Light from all around.
    pub environment: &'a Environment,
    /// Factor of its colour among dense roots.
    pub scalp: Vec3,
    /// Position of the camera \[m\], world space.
    pub eye: Vec3,
}

impl Skin<'_> {
    /// Radiance toward the camera, linear RGB, of a place with the paint that it has. `passed` tells the share of a light
    /// that reaches it, by its map, the number of the light's place among all, and among those of its light with their
    /// number.
    pub(crate) fn radiance(
        &self,
        place: &SkinPoint,
        painted: Option<&Painted>,
        mut passed: impl FnMut(&ShadowMap, usize, [usize; 2]) -> f32,
    ) -> Vec3 {
        let SkinPoint { point, normal, rooted } = *place;
        let finish = &Finish::new(self.look, tint(self.scalp, rooted), painted);
        let to_eye = (self.eye - point).normalize_or(normal);
        let around = match self.grid {
            Some(grid) => grid.on_skin(point, normal),
            None => self.occlusion.ambient_on(point, normal, self.environment),
        };
        let mut sum = finish.color * around;
        let mut first = 0;
        while let Some(light) = self.lights.get(first) {
            let count = light.sample_count().min(self.lights.len() - first);
            for place in 0..count {
                let source = &self.lights[first + place];
                let lit = source.at(point);
                let square = source.position.distance_squared(point).max(1e-6);
                let blur = SLOPE_SHARE * source.part_area() / square;
                let reflected = reflectance(finish, normal, to_eye, lit.to_light, blur) * lit.radiance;
                if reflected != Vec3::ZERO {
                    let map = self.shadows.map(first + place);
                    let passed = map.map_or(1.0, |map| passed(map, first + place, [place, count]));
                    sum += reflected * bled(passed, finish.bleed) * PI;
                }
            }
            first += count;
        }
        sum
    }
}

/// A place of the body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkinPoint {
    /// The point \[m\], world space.
    pub point: Vec3,
    /// The unit normal, world space.
    pub normal: Vec3,
    /// Density of roots there, 0 to 1.
    pub rooted: f32,
}

/// The reflecting surface of a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    /// Linear RGB, toward light from all around.
    color: Vec3,
    /// Linear RGB, toward lights.
    diffuse: Vec3,
    /// Reflectance at normal incidence, linear RGB.
    specular: Vec3,
    roughness: f32,
    /// Reach of light around the edge of shadow, of each channel.
    reach: Vec3,
    /// Share of the highlight that is as narrow as that of oil.
    oil: f32,
    /// Red that penumbrae gain.
    bleed: f32,
}

impl Finish {
    /// Finish of a look with a factor of its colour, or of paint.
    fn new(look: &BodyLook, tint: Vec3, painted: Option<&Painted>) -> Self {
        let color = painted.map_or(look.color, |painted| painted.color_on(look.color)) * tint;
        let skin = if painted.is_none_or(Painted::is_skin) { 1.0 } else { 0.0 };
        let (metallic, own) = painted.map_or((0.0, -1.0), |painted| (painted.metallic, painted.roughness));
        let roughness = if own < 0.0 { look.roughness } else { own.max(LEAST_ROUGHNESS) };
        let specular = Vec3::splat(look.specular);
        Self {
            color,
            // Metal mirrors with its colour, and what is around it stays diffuse.
            diffuse: color * (1.0 - metallic),
            specular: specular + (color - specular) * metallic,
            roughness,
            reach: (Vec3::splat(look.wrap) + TRAVEL * (look.softness * skin)).min(Vec3::ONE),
            oil: look.oil * skin,
            bleed: BLEED * look.softness * skin,
        }
    }
}

/// Ways of green and of blue light in skin over that of red: diffuse mean free paths of 3.67, 1.37 and 0.68 mm
/// \[Jensen2001\], as of a sphere a few ways across.
pub(crate) const GREEN_WAY: f32 = 0.372;
pub(crate) const BLUE_WAY: f32 = 0.186;
const TRAVEL: Vec3 = Vec3::new(1.0, GREEN_WAY, BLUE_WAY);
/// Share of what a penumbra hides that red light, scattered in from beside it, brings back. Penumbrae of soft lights are
/// some centimetres wide, many ways of red light: only a part of them is near enough to lit skin.
pub(crate) const BLEED: f32 = 0.2;
/// Width of the highlight of oil over that of the skin.
pub(crate) const OIL_WIDTH: f32 = 0.6;

/// Least roughness of a material: the highlight of a smoother one is smaller than a sample.
pub(crate) const LEAST_ROUGHNESS: f32 = 0.2;

/// Square of the width that a highlight gains from the size of a light, over the solid angle \[sr\] of its part. Ways to a
/// square of side `s` at a distance of 1 have a variance of `s^2 / 12` along each side, halfway vectors a quarter of it:
/// that of slopes of a normal distribution of width `s / sqrt(24)` \[Walter2007 eq. 25\]. With half as much again
/// the long tails of the distribution here come within a tenth of the sum over a light.
pub(crate) const SLOPE_SHARE: f32 = 0.0625;

/// Share of a light's irradiance (on a surface that faces it) that leaves toward the camera
/// \[1/sr\], linear RGB. All directions are unit vectors away from the surface. `blur` is added to the square of the
/// highlights' width.
fn reflectance(finish: &Finish, normal: Vec3, to_eye: Vec3, to_light: Vec3, blur: f32) -> Vec3 {
    let facing = normal.dot(to_light);
    finish.diffuse * (wrapped(facing, finish.reach) / PI) + highlights(finish, normal, to_eye, to_light, blur)
}

/// The cosine of light, smooth over its reach about the edge of shadow, of each channel. It is scaled so that a sphere
/// reflects as much as with a reach of 0: the integral over all normals is pi.
fn wrapped(facing: f32, reach: Vec3) -> Vec3 {
    let reach = reach.max(Vec3::splat(LEAST_REACH));
    let within = (Vec3::splat(facing) + reach).max(Vec3::ZERO).min(2.0 * reach);
    let above = (Vec3::splat(facing) - reach).max(Vec3::ZERO);
    (within * within / (4.0 * reach) + above) / (Vec3::ONE + reach * reach / 3.0)
}

/// Reach below which the edge of shadow is sharp.
pub(crate) const LEAST_REACH: f32 = 1e-3;

/// The highlight of skin under a film of oil: a wide lobe and a narrow one.
fn highlights(finish: &Finish, normal: Vec3, to_eye: Vec3, to_light: Vec3, blur: f32) -> Vec3 {
    let wide = highlight(finish, normal, to_eye, to_light, blur);
    if finish.oil == 0.0 {
        return wide;
    }
    let oily = Finish { roughness: (finish.roughness * OIL_WIDTH).max(LEAST_ROUGHNESS), ..*finish };
    wide.lerp(highlight(&oily, normal, to_eye, to_light, blur), finish.oil)
}

/// Share of light, of each channel, that reaches skin of which a share sees the light: red comes in from beside.
fn bled(passed: f32, bleed: f32) -> Vec3 {
    Vec3::splat(passed) + Vec3::new(1.0, 0.25, 0.1) * (bleed * passed * (1.0 - passed))
}

/// Microfacets with the distribution and masking of \[Walter2007\] and the Fresnel term of
/// \[Schlick1994\].
fn highlight(finish: &Finish, normal: Vec3, to_eye: Vec3, to_light: Vec3, blur: f32) -> Vec3 {
    let (light, eye) = (normal.dot(to_light), normal.dot(to_eye).max(1e-3));
    if light <= 0.0 {
        return Vec3::ZERO;
    }
    let half = (to_light + to_eye).normalize_or(normal);
    let spread = (finish.roughness.powi(4) + blur).min(1.0);
    let cosine = normal.dot(half).max(0.0);
    let lobe = cosine * cosine * (spread - 1.0) + 1.0;
    let distribution = spread / (PI * lobe * lobe); // [Walter2007 eq. 33]
    let masking = |cosine: f32| 2.0 * cosine / (cosine + (spread + (1.0 - spread) * cosine * cosine).sqrt());
    let grazing = (1.0 - to_eye.dot(half).max(0.0)).powi(5);
    let fresnel = finish.specular + (1.0 - finish.specular) * grazing;
    // The cosine of the irradiance cancels one in the denominator.
    distribution * fresnel * masking(light) * masking(eye) / (4.0 * eye)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_light_leaves_than_arrives() {
        let look =
            BodyLook { color: Vec3::ONE, wrap: 0.5, specular: 0.04, softness: 0.0, ..BodyLook::default() };
        let finish = Finish::new(&look, Vec3::ONE, None);
        let to_light = Vec3::new(0.6, 0.8, 0.0);
        let mut total = 0.0;
        let count = 200;
        for ring in 0..count {
            // Equal steps of the squared sine: equal shares of the cosine-weighted hemisphere.
            let sine = ((ring as f32 + 0.5) / count as f32).sqrt();
            let cosine = (1.0 - sine * sine).sqrt();
            for turn in 0..64 {
                let angle = turn as f32 / 64.0 * 2.0 * PI;
                let to_eye = Vec3::new(sine * angle.cos(), cosine, sine * angle.sin());
                total += reflectance(&finish, Vec3::Y, to_eye, to_light, 0.0).x * PI / (count * 64) as f32;
            }
        }
        // Irradiance is 0.8 of the light; the wrap shifts some of it, the highlight adds at most 4 %
        // and its grazing part.
        assert!(total > 0.5 && total < 0.8 * 1.08, "{total}");
    }

    #[test]
    fn light_from_behind_leaves_nothing() {
        let look = BodyLook { wrap: 0.0, softness: 0.0, ..BodyLook::default() };
        let finish = Finish::new(&look, Vec3::ONE, None);
        assert_eq!(reflectance(&finish, Vec3::Y, Vec3::Y, Vec3::new(0.1, -0.99, 0.0), 0.0), Vec3::ZERO);
    }

    #[test]
    fn soft_skin_is_red_at_the_edge_of_shadow_and_reflects_as_much() {
        let look = BodyLook { color: Vec3::ONE, specular: 0.0, ..BodyLook::default() };
        let at = |look: &BodyLook, facing: f32| wrapped(facing, Finish::new(look, Vec3::ONE, None).reach);
        let edge = at(&look, 0.0);
        assert!(edge.x > 1.5 * edge.y && edge.y > edge.z && edge.z > 0.0, "{edge}");
        let hard = BodyLook { softness: 0.0, wrap: 0.0, ..look };
        assert!(at(&hard, -0.01).max_element() == 0.0 && (at(&hard, 0.5) - 0.5).abs().max_element() < 1e-5);
        // Normals of a sphere have evenly spread cosines.
        for look in [look, hard] {
            let steps = 4000;
            let cosines = (0..steps).map(|step| (2 * step + 1) as f32 / steps as f32 - 1.0);
            let mean = cosines.map(|facing| at(&look, facing)).sum::<Vec3>() / steps as f32;
            assert!((mean - 0.25).abs().max_element() < 2e-4, "{mean}");
        }
        assert_eq!([bled(0.0, 0.5), bled(1.0, 0.5)], [Vec3::ZERO, Vec3::ONE]);
        let half = bled(0.5, 0.5);
        assert!(half.x > 1.15 * half.z && half.max_element() < 1.0, "{half}");
    }

    #[test]
    fn one_place_has_the_highlight_of_the_many_of_a_light() {
        // A square of 1.2 m at 1.75 m in one part, and in 400 that are points.
        let look = BodyLook { color: Vec3::ZERO, ..BodyLook::default() };
        let finish = Finish::new(&look, Vec3::ONE, None);
        let distance = 1.75;
        let whole = Light {
            kind: crate::LightKind::Rectangle,
            position: Vec3::Y * distance,
            width: 1.2,
            height: 1.2,
            samples: 1,
            ..Light::default()
        };
        let blur = SLOPE_SHARE * whole.part_area() / (distance * distance);
        let place = |at: usize| 1.2 * ((at as f32 + 0.5) / 20.0 - 0.5);
        for degrees in [0.0_f32, 10.0, 20.0, 30.0] {
            let angle = degrees.to_radians();
            let to_eye = Vec3::new(angle.sin(), angle.cos(), 0.0);
            let at = |to_light, blur| highlights(&finish, Vec3::Y, to_eye, to_light, blur).x;
            let ways = (0..400).map(|way| Vec3::new(place(way % 20), distance, place(way / 20)).normalize());
            let many = ways.map(|way| at(way, 0.0) / 400.0).sum::<f32>();
            let (one, point) = (at(Vec3::Y, blur), at(Vec3::Y, 0.0));
            assert!((one / many - 1.0).abs() < 0.1, "{degrees}: {one} {many} {point}");
            if degrees == 0.0 {
                assert!(point > 1.5 * many, "{point} {many}");
            }
        }
    }

    #[test]
    fn oil_narrows_the_highlight_of_skin_alone() {
        let peak = |oil: f32, painted: Option<&Painted>| {
            let look = BodyLook { oil, ..BodyLook::default() };
            let finish = Finish::new(&look, Vec3::ONE, painted);
            highlights(&finish, Vec3::Y, Vec3::Y, Vec3::Y, 0.0).x
        };
        assert!(peak(0.5, None) > 1.5 * peak(0.0, None));
        let cloth = Painted::of_color(Vec3::splat(0.5));
        assert_eq!(peak(0.5, Some(&cloth)), peak(0.0, Some(&cloth)));
    }
}
