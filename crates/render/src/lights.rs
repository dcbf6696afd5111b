use glam::Vec3;
use strandline_base::{Group, Key, SettingError, choices, settings};

use crate::RenderError;

choices! {
    /// How a light's rays spread.
    pub enum LightKind as "light.kind" {
        /// Parallel rays from `position` toward `target`, as from the sun.
        Directional = "directional",
        /// A cone from `position` about the way to `target`.
        Spot = "spot",
        /// Every way from `position`.
        Point = "point",
    }
    default Spot
}

settings! {
    /// A light. Each may cast shadows of hair and body.
    pub struct Light: Copy {
        /// How its rays spread.
        kind: LightKind = LightKind::default();
        /// Where it stands, world space.
        position: Vec3 = Vec3::new(0.9, 0.9, 1.2), in [-1e6, 1e6] "m";
        /// What it points at, world space.
        target: Vec3 = Vec3::ZERO, in [-1e6, 1e6] "m";
        /// Colour, linear RGB.
        color: Vec3 = Vec3::ONE, in [0.0, 1000.0];
        /// Radiance of a white matte surface at the target that faces the light; spot and point
        /// lights fall off from there with the square of the distance.
        intensity: f32 = 1.0, in [0.0, 1e6], slider [0.0, 5.0], more "a brighter light";
        /// Angle between the axis and the rim of a spot light's cone.
        cone_angle: f32 = 30.0, in [1.0, 85.0] "degrees", more "a wider cone";
        /// Share of that angle over which the rim fades.
        cone_softness: f32 = 0.3, in [0.0, 1.0], more "a softer rim";
        /// Whether hair and body cast shadows in it.
        shadow: bool = true;
    }
    also Light::apart;
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
        Ok(self.check_as("light")?)
    }

    fn apart(&self, key: &Key) -> Result<(), SettingError> {
        if self.position.distance(self.target) > 1e-6 {
            return Ok(());
        }
        Err(SettingError::new(key.of("position"), self.position, "a place apart from the target"))
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

settings! {
    /// Light from all around: a sky above and a ground below, even between.
    pub struct Environment: Copy {
        /// Radiance from straight above, linear RGB.
        sky: Vec3 = Vec3::new(0.26, 0.29, 0.33), in [0.0, 1000.0];
        /// Radiance from straight below, linear RGB.
        ground: Vec3 = Vec3::new(0.13, 0.11, 0.10), in [0.0, 1000.0];
    }
}

impl Environment {
    /// Radiance from a unit direction, linear RGB.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        self.ground.lerp(self.sky, 0.5 + 0.5 * direction.y)
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
