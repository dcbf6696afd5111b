//! Lights about a head.

use glam::Vec3;
use strandline_base::choices;

use crate::Light;
use crate::lights::LightKind;

choices! {
    /// Lights about a head.
    pub enum LightRig as "look.light_rig" {
        /// The lights of a studio, or three spots where the fibre is that of the thesis.
        Auto = "auto",
        /// A soft box before the head, a strip behind it and a weak fill beside it.
        StudioLights = "studio",
        /// Soft boxes before, behind and at both sides: hair is dark from no side.
        AllSides = "all_sides",
        /// A warm key, a cool rim and a fill [Chen2011 §6].
        ThreePoint = "three_point",
    }
    default Auto
}

impl Light {
    /// A soft box before and above a head at `target` \[m\] that faces +z, a cool strip behind it and a large, weak fill
    /// on the far side of the soft box: the lights of a photographer's studio.
    pub fn studio(target: Vec3) -> [Self; 3] {
        let light = |x, y, z| Self {
            kind: LightKind::Rectangle,
            position: target + Vec3::new(x, y, z),
            target,
            ..Self::default()
        };
        [
            Self {
                color: Vec3::new(1.0, 0.96, 0.92),
                intensity: 1.3,
                width: 0.8,
                height: 0.8,
                ..light(-0.9, 1.25, 1.35)
            },
            Self {
                color: Vec3::new(0.9, 0.95, 1.0),
                intensity: 0.9,
                width: 0.3,
                height: 0.9,
                samples: 1,
                ..light(1.1, 1.2, -1.2)
            },
            Self {
                color: Vec3::new(0.95, 0.97, 1.0),
                intensity: 0.4,
                width: 1.2,
                height: 1.2,
                samples: 1,
                ..light(1.7, 0.25, 0.35)
            },
        ]
    }

    /// Soft boxes on all sides of a head at `target` \[m\] that faces +z: one before and above it, one at each side and one
    /// behind it. Hair is dark from no side. They have seven places with shadow.
    pub fn all_sides(target: Vec3) -> [Self; 4] {
        let light = |x, y, z, side, intensity| Self {
            kind: LightKind::Rectangle,
            position: target + Vec3::new(x, y, z),
            target,
            color: Vec3::new(1.0, 0.98, 0.95),
            width: side,
            height: side,
            intensity,
            samples: 1,
            ..Self::default()
        };
        [
            Self { samples: 2, ..light(-0.7, 1.25, 1.45, 0.8, 1.0) },
            light(1.8, 0.55, 0.1, 1.2, 0.8),
            light(-1.8, 0.55, -0.1, 1.2, 0.8),
            light(0.2, 0.9, -1.7, 1.2, 0.9),
        ]
    }

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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Look;
    use crate::lights::at_samples;

    /// The least irradiance over pi, green, of matte surfaces that face the sides and the back.
    fn least_side(lights: &[Light]) -> f32 {
        let facing =
            [Vec3::X, Vec3::NEG_X, Vec3::NEG_Z, Vec3::new(0.7, 0.0, -0.7), Vec3::new(-0.7, 0.0, -0.7)];
        let on = |normal: Vec3| -> f32 {
            let lit = lights.iter().map(|light| light.at(0.1 * normal));
            lit.map(|lit| lit.radiance.y * normal.normalize().dot(lit.to_light).max(0.0)).sum()
        };
        facing.map(on).into_iter().fold(f32::MAX, f32::min)
    }

    #[test]
    fn a_look_brings_the_lights_that_it_names() {
        let lights = |light_rig| Look { light_rig, ..Look::default() }.lights(Vec3::Y);
        assert_eq!(lights(LightRig::Auto), Light::studio(Vec3::Y));
        assert_eq!(lights(LightRig::AllSides), Light::all_sides(Vec3::Y));
        assert_eq!(lights(LightRig::ThreePoint), Light::three_point(Vec3::Y));
        let thesis = Look { light_rig: LightRig::Auto, ..Look::thesis() };
        assert_eq!(thesis.lights(Vec3::Y), Light::three_point(Vec3::Y));
        assert_eq!(
            Look { light_rig: LightRig::StudioLights, ..thesis }.lights(Vec3::Y),
            Light::studio(Vec3::Y)
        );
    }

    #[test]
    fn lights_of_all_sides_leave_no_side_dark() {
        let [all, studio] = [&Light::all_sides(Vec3::ZERO)[..], &Light::studio(Vec3::ZERO)].map(least_side);
        assert!(all > 0.5 && all > 1.5 * studio, "{all} {studio}");
        assert!(at_samples(&Light::all_sides(Vec3::ZERO), &[]).len() <= 8);
    }
}
