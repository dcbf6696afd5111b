//! Air: the force of a flow on a metre of hair.

use super::real::Real;

/// Density \[kg/m^3\] and viscosity \[Pa s\] of air at 20 degrees.
pub(crate) const DENSITY: f64 = 1.2;
pub(crate) const VISCOSITY: f64 = 1.8e-5;
/// Reynolds number below which the force goes with the speed, as in Stokes' flow.
const SLOWEST: f64 = 0.1;
/// Reynolds number beyond which the force goes with the speed again, so that every speed has a finite force.
const FASTEST: f64 = 1e5;
/// Drag coefficient 11 / Re^(3/4) + 0.95 of a cylinder across a flow, as the force over viscosity and speed: within 3 % of
/// [Cheng2013] for Reynolds numbers of 0.1 to 100.
const SLOW: f64 = 5.5;
const FAST: f64 = 0.475;
/// Force along a cylinder over viscosity and speed, pi Nu with Nu = 1.1 (0.24 + 0.56 Re^0.45) [Collis1959], where
/// 0.3 Re^(1/4) + 0.7 Re^(1/2) stands for Re^0.45 (within 5 %).
const ALONG: f64 = 0.829;
const ALONG_QUARTER: f64 = 0.581;
const ALONG_HALF: f64 = 1.355;

/// The hair of a guide as the air meets it.
#[derive(Clone, Copy, Debug)]
pub struct Wisp<R> {
    /// Diameter of a hair \[m\].
    diameter: R,
    /// Hairs that the guide stands for, and share of them of which it has the mass.
    hairs: R,
    share: R,
    /// Diameter of the wisp over that of a hair, and its fourth root.
    wider: R,
    wider_root: R,
}

impl<R: Real> Wisp<R> {
    /// A wisp of `hairs` hairs of a diameter \[m\], which fill the share `packing` of its section. Its guide has the mass of
    /// `massive` hairs.
    #[inline(always)]
    pub fn new(diameter: R, hairs: R, massive: R, packing: R) -> Self {
        let wider = (hairs * (R::of(1.0) / packing)).root();
        Self { diameter, hairs, share: massive / hairs, wider, wider_root: wider.root().root() }
    }

    /// The same wisp where its hairs are as thick as a share of their diameter.
    #[inline(always)]
    pub fn thinned(&self, share: R) -> Self {
        Self { diameter: self.diameter * share, ..*self }
    }

    /// The same wisp, whose guide has the mass of all its hairs.
    #[inline(always)]
    pub fn together(&self) -> Self {
        Self { share: R::of(1.0), ..*self }
    }

    /// Force over speed of a metre of the guide \[N s/m^2\], across and along it, where the air crosses it at a speed
    /// \[m/s\].
    ///
    /// The air meets no more of the hairs than a cylinder as wide as the wisp would: 1 of 1, 4 of 50 at 1 m/s.
    #[inline(always)]
    pub fn drag(&self, speed: R) -> [R; 2] {
        let reynolds = (speed * self.diameter * R::of(DENSITY / VISCOSITY)).or_more(R::of(SLOWEST));
        let reynolds = reynolds.or_less(R::of(FASTEST));
        let half = reynolds.root();
        let quarter = half.root();
        let (slow, fast) = (quarter * R::of(SLOW), reynolds * R::of(FAST));
        let hair = slow + fast;
        let wisp = (self.hairs * hair).or_less(slow * self.wider_root + fast * self.wider);
        let across = wisp * self.share;
        let along = R::of(ALONG) + quarter * R::of(ALONG_QUARTER) + half * R::of(ALONG_HALF);
        let viscosity = R::of(VISCOSITY);
        [across * viscosity, across / hair * along * viscosity]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rods::RodSettings;

    /// Share of a wisp of dry hair that its hairs fill.
    const LOOSE: f64 = 0.3;

    /// Force \[N/m\] on a metre of hair with a diameter \[m\] at a speed \[m/s\], with [Cheng2013]'s coefficient.
    fn tabled(diameter: f64, speed: f64) -> f64 {
        let reynolds = speed * diameter * DENSITY / VISCOSITY;
        let coefficient = 11.0 * reynolds.powf(-0.75)
            + 0.9 * (1.0 - (-1000.0 / reynolds).exp())
            + 1.2 * (1.0 - (-(reynolds / 4500.0).powf(0.7)).exp());
        0.5 * coefficient * DENSITY * diameter * speed * speed
    }

    #[test]
    fn a_lone_hair_has_the_force_of_a_cylinder() {
        for diameter in [50e-6, 80e-6, 120e-6] {
            for speed in [0.5, 1.0, 3.0, 10.0] {
                let [across, along] = Wisp::new(diameter, 1.0, 1.0, LOOSE).drag(speed);
                let ratio = across * speed / tabled(diameter, speed);
                assert!((ratio - 1.0).abs() < 0.03, "{diameter} m, {speed} m/s: {ratio}");
                // From half in Stokes' flow down to a quarter of a coarse hair in a storm.
                assert!((0.25..0.55).contains(&(along / across)), "{}", along / across);
            }
        }
        // Stokes' flow: a force that goes with the speed.
        let slow = |speed: f64| Wisp::new(80e-6, 1.0, 1.0, LOOSE).drag(speed)[0];
        assert_eq!(slow(1e-3), slow(1e-9));
        assert!((slow(0.0) - 5.6e-5).abs() < 1e-6, "{}", slow(0.0));
        assert!(slow(1e30).is_finite());
    }

    #[test]
    fn the_air_reaches_few_hairs_of_a_wisp() {
        let reached = |hairs: f64| {
            Wisp::new(80e-6, hairs, hairs, LOOSE).drag(1.0)[0]
                / (hairs * Wisp::new(80e-6, 1.0, 1.0, LOOSE).drag(1.0)[0])
        };
        assert_eq!(reached(1.0), 1.0);
        assert!((reached(50.0) - 0.085).abs() < 0.01, "{}", reached(50.0));
        // A guide with the mass of one of them has the force on one.
        let [all, one] = [50.0, 1.0].map(|massive| Wisp::new(80e-6, 50.0, massive, LOOSE).drag(1.0)[0]);
        assert!((all / one - 50.0).abs() < 1e-9, "{}", all / one);
        assert!(reached(10.0) > reached(50.0) && reached(50.0) > reached(1000.0));
        // Twice as dense wisps are sqrt(2) times as thin.
        let [loose, dense] =
            [LOOSE, 2.0 * LOOSE].map(|packing| Wisp::new(80e-6, 50.0, 50.0, packing).drag(1.0)[0]);
        assert!((1.2..1.42).contains(&(loose / dense)), "{}", loose / dense);
        // The numbers of single precision, in which the default has no other bits than a constant.
        assert_eq!(1.0 / RodSettings::default().packing, (1.0 / LOOSE) as f32);
    }
}
