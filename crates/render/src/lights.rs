use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::RenderError;
use crate::look::{require, require_range};

/// How a light's rays spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LightKind {
    /// Parallel rays from `position` toward `target`, as from the sun.
    Directional,
    /// A cone from `position` about the way to `target`.
    #[default]
    Spot,
    /// Every way from `position`.
    Point,
}

/// A light. Each may cast shadows of hair and body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Light {
    /// How its rays spread: `directional`, `spot` or `point`. Default spot.
    pub kind: LightKind,
    /// Where it stands \[m\], world space. Default (0.9, 0.9, 1.2).
    pub position: Vec3,
    /// What it points at \[m\], world space. Default the origin.
    pub target: Vec3,
    /// Colour, linear RGB. Default white.
    pub color: Vec3,
    /// Radiance of a white matte surface at the target that faces the light; spot and point
    /// lights fall off from there with the square of the distance. Default 1.
    pub intensity: f32,
    /// Angle \[degrees\] between the axis and the rim of a spot light's cone, 1 to 85. Default 30.
    pub cone_angle: f32,
    /// Share of that angle over which the rim fades, 0 to 1. Default 0.3.
    pub cone_softness: f32,
    /// Whether hair and body cast shadows in it. Default true.
    pub shadow: bool,
}

impl Default for Light {
    fn default() -> Self {
        Self {
            kind: LightKind::Spot,
            position: Vec3::new(0.9, 0.9, 1.2),
            target: Vec3::ZERO,
            color: Vec3::ONE,
            intensity: 1.0,
            cone_angle: 30.0,
            cone_softness: 0.3,
            shadow: true,
        }
    }
}

/// What a light sends to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Unit direction from the point to the light, world space.
    pub to_light: Vec3,
    /// Radiance, linear RGB, of a white matte surface at the point that faces the light; pi times
    /// this is the irradiance. Shadows are not in it.
    pub radiance: Vec3,
}

impl Light {
    /// Three lights about a head at `target` \[m\] that faces +z [Chen2011 §6]: a warm key and a cool rim, two spot lights
    /// with shadows, and a fill without.
    pub fn three_point(target: Vec3) -> [Self; 3] {
        let light = |x, y, z| Self { position: target + Vec3::new(x, y, z), target, ..Self::default() };
        [
            Self { color: Vec3::new(1.0, 0.95, 0.88), intensity: 1.35, ..light(-0.9, 1.25, 1.35) },
            Self { color: Vec3::new(0.85, 0.93, 1.0), intensity: 1.7, ..light(1.1, 1.2, -1.2) },
            Self {
                kind: LightKind::Directional,
                color: Vec3::new(0.9, 0.95, 1.0),
                intensity: 0.22,
                shadow: false,
                ..light(1.5, 0.2, 1.2)
            },
        ]
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// The first setting outside its range; a light that stands on its target.
    pub fn validate(&self) -> Result<(), RenderError> {
        let place = |vector: Vec3| vector.is_finite() && vector.abs().max_element() < 1e6;
        require(place(self.position), "light.position", &self.position, "three finite lengths")?;
        require(place(self.target), "light.target", &self.target, "three finite lengths")?;
        let apart = self.position.distance(self.target) > 1e-6;
        require(apart, "light.position", &self.position, "a place apart from the target")?;
        let sound = self.color.is_finite() && self.color.min_element() >= 0.0;
        require(sound, "light.color", &self.color, "three finite numbers, none negative")?;
        require_range("light.intensity", self.intensity, 0.0, 1e6, "0 to 1000000")?;
        require_range("light.cone_angle", self.cone_angle, 1.0, 85.0, "1 to 85 degrees")?;
        require_range("light.cone_softness", self.cone_softness, 0.0, 1.0, "0 to 1")
    }

    /// What the light sends to a point \[m\], world space.
    pub fn at(&self, point: Vec3) -> Illumination {
        let axis = self.position - self.target;
        let radiance = self.color * self.intensity;
        if self.kind == LightKind::Directional {
            return Illumination { to_light: axis.normalize_or(Vec3::Y), radiance };
        }
        let way = self.position - point;
        let to_light = way.normalize_or(Vec3::Y);
        let falloff = axis.length_squared() / way.length_squared().max(1e-6);
        let cone = if self.kind == LightKind::Spot {
            self.cone(to_light.dot(axis.normalize_or(Vec3::Y)))
        } else {
            1.0
        };
        Illumination { to_light, radiance: radiance * (falloff * cone) }
    }

    /// Share of a spot light at a cosine from its axis.
    fn cone(&self, cosine: f32) -> f32 {
        let [rim, full] = self.cone_cosines();
        let share = ((cosine - rim) / (full - rim)).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }

    /// Cosines of a spot light's rim and of where it begins to fade.
    pub(crate) fn cone_cosines(&self) -> [f32; 2] {
        let rim = self.cone_angle.to_radians();
        let full = rim * (1.0 - self.cone_softness.clamp(1e-3, 1.0));
        [rim.cos(), full.cos()]
    }
}

/// Light from all around: a sky above and a ground below, even between.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// Radiance from straight above, linear RGB. Default (0.26, 0.29, 0.33).
    pub sky: Vec3,
    /// Radiance from straight below, linear RGB. Default (0.13, 0.11, 0.10).
    pub ground: Vec3,
}

impl Default for Environment {
    fn default() -> Self {
        Self { sky: Vec3::new(0.26, 0.29, 0.33), ground: Vec3::new(0.13, 0.11, 0.10) }
    }
}

impl Environment {
    /// Radiance from a unit direction, linear RGB.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        self.ground.lerp(self.sky, 0.5 + 0.5 * direction.y)
    }

    pub(crate) fn validate(&self) -> Result<(), RenderError> {
        for (name, color) in [("environment.sky", self.sky), ("environment.ground", self.ground)] {
            let sound = color.is_finite() && color.min_element() >= 0.0;
            require(sound, name, &color, "three finite numbers, none negative")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spot_fades_to_its_rim_and_with_distance() {
        let light = Light { position: Vec3::Y, ..Light::default() };
        assert_eq!(light.at(Vec3::ZERO).radiance, Vec3::ONE);
        let below = light.at(Vec3::NEG_Y).radiance.x;
        assert!((below - 0.25).abs() < 1e-6);
        assert_eq!(light.at(Vec3::X).radiance, Vec3::ZERO);
        let half = light.at(Vec3::new(0.5, 0.0, 0.0)).radiance.x;
        assert!(half > 0.05 && half < 0.8, "{half}");
    }

    #[test]
    fn bad_lights_are_refused() {
        assert!(Light::three_point(Vec3::ZERO).iter().all(|light| light.validate().is_ok()));
        assert!(Light { position: Vec3::ZERO, ..Light::default() }.validate().is_err());
        assert!(Light { intensity: -1.0, ..Light::default() }.validate().is_err());
        assert!(Light { color: Vec3::splat(f32::NAN), ..Light::default() }.validate().is_err());
        assert!(Light { cone_angle: 0.0, ..Light::default() }.validate().is_err());
    }
}
