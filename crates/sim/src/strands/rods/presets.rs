//! Kinds of hair: what they are made of.

use super::hair_kind::HairKind;
use super::settings::RodSettings;

impl RodSettings {
    /// Sets the material of a kind of hair; profile, rest shape and solver settings stay.
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
                ..medium
            },
            HairKind::Sprayed => Self { load: 0.1, wisp_hairs: 10, cohesion: 0.5, damping: 0.004, ..medium },
        };
        *self = Self {
            ellipticity: self.ellipticity,
            tip_radius: self.tip_radius,
            taper_start: self.taper_start,
            profile: self.profile,
            rest: self.rest,
            substeps: self.substeps,
            newton_steps: self.newton_steps,
            tolerance: self.tolerance,
            rubbing: self.rubbing,
            ..of
        };
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
            rubbing: 0.0,
            ..RodSettings::default()
        };
        for hair in HairKind::ALL {
            let mut rods = own;
            rods.set_hair(hair);
            assert_eq!(
                (rods.hair, rods.tip_radius, rods.profile, rods.substeps, rods.tolerance, rods.rubbing),
                (hair, 0.5, own.profile, 3, 1e-4, 0.0)
            );
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
}
