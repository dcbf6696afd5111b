//! Kinds of hair: what they are made of.

use super::hair_kind::HairKind;
use super::settings::{Rest, RodSettings};

impl RodSettings {
    /// Sets what a kind of hair is made of, and how its hairs rub and lie together; profile and solver settings stay. A
    /// groom is taken for dry hair where its hair is wet, unless it is unstressed.
    pub fn set_hair(&mut self, hair: HairKind) {
        let medium = Self { hair, ..Self::default() };
        let of = match hair {
            HairKind::Medium => medium,
            HairKind::Fine => Self { radius: 25.0, ..medium },
            HairKind::Coarse => Self { radius: 60.0, ..medium },
            HairKind::Wet => Self {
                radius: 45.0,
                youngs_modulus: 1.6,
                shear_modulus: Some(0.25),
                load: 0.5,
                damping: 0.008,
                packing: 0.6,
                rubbing: 0.4,
                ..medium
            },
            HairKind::Sprayed => {
                let glued = Self { wisp_hairs: 10, cohesion: 0.5, packing: 0.5, ..medium };
                Self { load: 0.1, damping: 0.004, rubbing: 0.6, ..glued }
            }
        };
        let rest = match (self.rest, hair) {
            (Rest::Unstressed, _) => Rest::Unstressed,
            (Rest::SagFree | Rest::Dry, HairKind::Wet) => Rest::Dry,
            (Rest::SagFree | Rest::Dry, _) => Rest::SagFree,
        };
        *self = Self {
            ellipticity: self.ellipticity,
            tip_radius: self.tip_radius,
            taper_start: self.taper_start,
            profile: self.profile,
            rest,
            substeps: self.substeps,
            newton_steps: self.newton_steps,
            tolerance: self.tolerance,
            ..of
        };
    }

    /// The same hair before it carried anything: wet hair has shrunk, and is as stiff as dry hair.
    pub(crate) fn dry(&self) -> Self {
        let unloaded = Self { load: 0.0, ..*self };
        if self.hair != HairKind::Wet {
            return unloaded;
        }
        let of = |hair| {
            let mut rods = Self::default();
            rods.set_hair(hair);
            rods
        };
        let [dry, wet] = [HairKind::Medium, HairKind::Wet].map(of);
        let shear = |rods: &Self| (rods.material().shear_modulus * 1e-9) as f32;
        Self {
            radius: self.radius * dry.radius / wet.radius,
            youngs_modulus: self.youngs_modulus * dry.youngs_modulus / wet.youngs_modulus,
            shear_modulus: self.shear_modulus.map(|modulus| modulus * shear(&dry) / shear(&wet)),
            ..unloaded
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bending stiffness over weight per length \[m^2\].
    fn firmness(rods: &RodSettings) -> f64 {
        let section = rods.material().section();
        section.bend[0] / section.mass
    }

    #[test]
    fn medium_hair_is_the_default_and_kinds_leave_shape_and_solve() {
        let own = RodSettings {
            tip_radius: 0.5,
            profile: [2.0, 1.0, 1.0],
            substeps: 3,
            tolerance: 1e-4,
            ..RodSettings::default()
        };
        for hair in HairKind::ALL {
            let mut rods = own;
            rods.set_hair(hair);
            assert_eq!(
                (rods.hair, rods.tip_radius, rods.profile, rods.substeps, rods.tolerance),
                (hair, 0.5, own.profile, 3, 1e-4)
            );
            assert_eq!(rods.rest == Rest::Dry, hair == HairKind::Wet);
            rods.set_hair(HairKind::Medium);
            assert_eq!(rods, own);
        }
    }

    #[test]
    fn kinds_are_as_firm_as_they_feel() {
        let of = |hair| {
            let mut rods = RodSettings::default();
            rods.set_hair(hair);
            firmness(&rods)
        };
        let [fine, medium, coarse, wet, sprayed] = HairKind::ALL.map(of);
        // Stiffness over weight goes with the square of the radius.
        assert!((fine / medium - (25.0_f64 / 40.0).powi(2)).abs() < 1e-6);
        assert!((coarse / medium - 2.25).abs() < 1e-6);
        assert!(wet < 0.5 * medium && sprayed > 2.0 * medium, "{wet}, {medium}, {sprayed}");
    }

    #[test]
    fn dry_hair_is_what_wet_hair_was() {
        let mut wet = RodSettings::default();
        wet.set_hair(HairKind::Wet);
        let [dry, medium] = [wet.dry(), RodSettings::default()].map(|rods| rods.material().section());
        for (found, expected) in
            [(dry.mass, medium.mass), (dry.bend[0], medium.bend[0]), (dry.twist, medium.twist)]
        {
            assert!((found / expected - 1.0).abs() < 1e-6, "{found}, expected {expected}");
        }
        let thin = RodSettings { radius: 30.0, ..wet };
        assert!((thin.dry().radius / thin.radius - 40.0 / 45.0).abs() < 1e-6);
        let mut unstressed = RodSettings { rest: Rest::Unstressed, ..RodSettings::default() };
        unstressed.set_hair(HairKind::Wet);
        assert_eq!(unstressed.rest, Rest::Unstressed);
    }
}
