//! Reflection of the body: soft diffuse and a mild highlight.

use std::f32::consts::PI;

use glam::Vec3;

use crate::cpu::{LightGrid, Occlusion};
use crate::shadow::Shadows;
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
    /// Radiance toward the camera, linear RGB, of a point \[m\] with a unit normal, world space, where roots are so
    /// dense, 0 to 1, and with the paint that it has.
    pub(crate) fn radiance(&self, point: Vec3, normal: Vec3, rooted: f32, painted: Option<&Painted>) -> Vec3 {
        let finish = &Finish::new(self.look, Vec3::ONE.lerp(self.scalp, rooted), painted);
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
                let lit = self.lights[first + place].at(point);
                let reflected = reflectance(finish, normal, to_eye, lit.to_light) * lit.radiance;
                if reflected != Vec3::ZERO {
                    let map = self.shadows.map(first + place);
                    let passed = map.map_or(1.0, |map| map.on_skin(point, normal, [place, count]));
                    sum += reflected * (PI * passed);
                }
            }
            first += count;
        }
        sum
    }
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
    wrap: f32,
}

impl Finish {
    /// That of a look with a factor of its colour, or of paint.
    fn new(look: &BodyLook, tint: Vec3, painted: Option<&Painted>) -> Self {
        let color = painted.and_then(Painted::own_color).unwrap_or(look.color) * tint;
        let (metallic, own) = painted.map_or((0.0, -1.0), |painted| (painted.metallic, painted.roughness));
        let roughness = if own < 0.0 { look.roughness } else { own.max(LEAST_ROUGHNESS) };
        let specular = Vec3::splat(look.specular);
        Self {
            color,
            // Metal mirrors with its colour, and what is around it stays diffuse.
            diffuse: color * (1.0 - metallic),
            specular: specular + (color - specular) * metallic,
            roughness,
            wrap: look.wrap,
        }
    }
}

/// Least roughness of a material: the highlight of a smoother one is smaller than a sample.
pub(crate) const LEAST_ROUGHNESS: f32 = 0.2;

/// Share of a light's irradiance (on a surface that faces it) that leaves toward the camera
/// \[1/sr\], linear RGB. All directions are unit vectors away from the surface.
fn reflectance(finish: &Finish, normal: Vec3, to_eye: Vec3, to_light: Vec3) -> Vec3 {
    let facing = normal.dot(to_light);
    // Light wrapped around the edge of shadow, scaled so that no energy is gained.
    let wrap = finish.wrap;
    let diffuse = ((facing + wrap) / (1.0 + wrap)).max(0.0) / (1.0 + wrap);
    finish.diffuse * (diffuse / PI) + highlight(finish, normal, to_eye, to_light)
}

/// Microfacets with the distribution and masking of \[Walter2007\] and the Fresnel term of
/// \[Schlick1994\].
fn highlight(finish: &Finish, normal: Vec3, to_eye: Vec3, to_light: Vec3) -> Vec3 {
    let (light, eye) = (normal.dot(to_light), normal.dot(to_eye).max(1e-3));
    if light <= 0.0 {
        return Vec3::ZERO;
    }
    let half = (to_light + to_eye).normalize_or(normal);
    let spread = finish.roughness.powi(4);
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
        let look = BodyLook { color: Vec3::ONE, wrap: 0.5, specular: 0.04, ..BodyLook::default() };
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
                total += reflectance(&finish, Vec3::Y, to_eye, to_light).x * PI / (count * 64) as f32;
            }
        }
        // Irradiance is 0.8 of the light; the wrap shifts some of it, the highlight adds at most 4 %
        // and its grazing part.
        assert!(total > 0.5 && total < 0.8 * 1.08, "{total}");
    }

    #[test]
    fn light_from_behind_leaves_nothing() {
        let look = BodyLook { wrap: 0.0, ..BodyLook::default() };
        let finish = Finish::new(&look, Vec3::ONE, None);
        assert_eq!(reflectance(&finish, Vec3::Y, Vec3::Y, Vec3::new(0.1, -0.99, 0.0)), Vec3::ZERO);
    }
}
