//! The fibre of \[Chiang2016\]: rough dielectric cylinder with absorption, in double precision.
//!
//! Directions are given by their inclination toward the tip and by the turn about the fibre between light and
//! eye; `h` is the offset of the line of sight from the axis, -1 to 1. There are four kinds of paths: R is reflected at
//! the surface, TT passes through, TRT is reflected once inside, and all others.

use std::f64::consts::{PI, TAU};

use strandline_base::math;

/// Kinds of paths: R, TT, TRT and the rest.
pub const LOBES: usize = 4;

/// The fibre with its settings worked out.
#[derive(Clone, Copy, Debug)]
pub struct Lobes {
    /// Variance of the inclination of each kind of path.
    variances: [f64; LOBES],
    /// Scale of the logistic distribution of the turn.
    scale: f64,
    /// Tilt of the scales of the fibre \[rad\].
    tilt: f64,
    index: f64,
}

impl Lobes {
    /// A fibre of roughness `along` and `around` itself (0 to 1), whose scales are tilted \[rad\].
    pub fn new(along: f64, around: f64, tilt: f64, index: f64) -> Self {
        // [Chiang2016 §4.1]
        let root = 0.726 * along + 0.812 * along * along + 3.7 * along.powi(20);
        let base = root * root;
        let turn = 0.265 * around + 1.194 * around * around + 5.372 * around.powi(22);
        Self {
            variances: [base, 0.25 * base, 4.0 * base, 4.0 * base],
            scale: (PI / 8.0).sqrt() * turn,
            tilt,
            index,
        }
    }

    /// The same with inclinations that spread more, by a variance.
    pub fn spread(&self, variance: f64) -> Self {
        Self { variances: self.variances.map(|own| own + variance), ..*self }
    }

    /// Variance of the inclination of light that is reflected at the surface.
    pub(super) fn variance(&self) -> f64 {
        self.variances[0]
    }

    /// Variances of the inclination of R, TT and TRT \[rad^2\].
    pub(crate) fn path_variances(&self) -> [f64; 3] {
        std::array::from_fn(|lobe| self.variances[lobe])
    }

    /// Share of the sine of its inclination that light keeps as R, TT and TRT, but for the scales' tilt.
    pub(crate) fn kept(&self) -> [f64; 3] {
        // The terms along the fibre [d'Eon2011] are von Mises-Fisher distributions of concentration 1 / v, turned about
        // it. Their mean is coth(1 / v) - v.
        self.path_variances().map(|variance| {
            let power = math::exp(-2.0 / variance);
            (1.0 + power) / (1.0 - power) - variance
        })
    }

    /// Share of light that goes each way, for the eye's inclination \[rad\] and offset `h`; absorption of each
    /// channel is per fibre radius.
    pub fn shares<const N: usize>(&self, eye: f64, h: f64, absorption: [f64; N]) -> [[f64; N]; LOBES] {
        let (sine, cosine) = (math::sin(eye), math::cos(eye).max(1e-6));
        let reflected = fresnel(cosine * (1.0 - h * h).max(0.0).sqrt(), self.index);
        let inside = (1.0 - (sine / self.index).powi(2)).max(1e-12).sqrt();
        let across = (1.0 - (h / self.bent_index(eye)).powi(2)).max(0.0).sqrt();
        let mut shares = [[0.0; N]; LOBES];
        for channel in 0..N {
            let through = math::exp(-absorption[channel] * 2.0 * across / inside);
            let first = (1.0 - reflected) * (1.0 - reflected) * through;
            let second = first * through * reflected;
            let rest = second * reflected * through / (1.0 - through * reflected).max(1e-12);
            let paths = [reflected, first, second, rest];
            (0..LOBES).for_each(|lobe| shares[lobe][channel] = paths[lobe]);
        }
        shares
    }

    /// The index that the cross section shows to an inclined ray \[Marschner2003 appendix B\].
    fn bent_index(&self, eye: f64) -> f64 {
        let (sine, cosine) = (math::sin(eye), math::cos(eye).max(1e-6));
        (self.index * self.index - sine * sine).sqrt() / cosine
    }

    /// Density of the turn \[1/rad\] between eye and light of each kind of path.
    pub fn turns(&self, eye: f64, h: f64, turn: f64) -> [f64; LOBES] {
        let outside = math::asin(h.clamp(-1.0, 1.0));
        let inside = math::asin((h / self.bent_index(eye)).clamp(-1.0, 1.0));
        let mut found = [1.0 / TAU; LOBES];
        for (lobe, density) in found.iter_mut().take(3).enumerate() {
            let straight = 2.0 * lobe as f64 * inside - 2.0 * outside + lobe as f64 * PI;
            *density = self.logistic(turn - straight);
        }
        found
    }

    /// The trimmed logistic distribution on one turn.
    fn logistic(&self, angle: f64) -> f64 {
        let angle = angle - TAU * (angle / TAU).round();
        let power = math::exp(-angle.abs() / self.scale);
        let cumulated = |x: f64| 1.0 / (1.0 + math::exp(-x / self.scale));
        let whole = cumulated(PI) - cumulated(-PI);
        power / (self.scale * (1.0 + power).powi(2)) / whole
    }

    /// The inclination of the eye that each kind of path sees on the tilted scales \[rad\].
    pub fn tilted(&self, eye: f64) -> [f64; LOBES] {
        self.tilts().map(|tilt| eye + tilt)
    }

    /// Angles by which the tilted scales turn each kind of path toward the root \[rad\].
    pub(crate) fn tilts(&self) -> [f64; LOBES] {
        [-2.0 * self.tilt, self.tilt, 4.0 * self.tilt, 0.0]
    }

    /// Density of the light's inclination for each kind of path: over the sphere, weighted with the cosine, it
    /// sums to 1 around the fibre's turn.
    pub fn inclinations(&self, eye: f64, light: f64) -> [f64; LOBES] {
        let tilted = self.tilted(eye);
        std::array::from_fn(|lobe| longitudinal(tilted[lobe], light, self.variances[lobe]))
    }

    /// Reflectance times the cosine of the light's inclination \[1/sr\] of each channel, with the eye at an
    /// offset `h`.
    pub fn scatter<const N: usize>(
        &self,
        eye: f64,
        h: f64,
        light: f64,
        turn: f64,
        absorption: [f64; N],
    ) -> [f64; N] {
        let shares = self.shares(eye, h, absorption);
        let (along, around) = (self.inclinations(eye, light), self.turns(eye, h, turn));
        std::array::from_fn(|channel| {
            (0..LOBES).map(|lobe| along[lobe] * around[lobe] * shares[lobe][channel]).sum()
        })
    }
}

/// [d'Eon2011 eq. 7], in a form that holds for small variances; |eye| may pass a right angle.
fn longitudinal(eye: f64, light: f64, variance: f64) -> f64 {
    let (a, b) =
        (math::cos(eye).abs() * math::cos(light) / variance, math::sin(eye) * math::sin(light) / variance);
    if variance <= 0.1 {
        math::exp(log_bessel(a) - b - 1.0 / variance + math::ln(1.0 / variance))
    } else {
        bessel(a) * math::exp(-b) / (math::sinh(1.0 / variance) * 2.0 * variance)
    }
}

/// I0, the modified Bessel function of the first kind.
fn bessel(x: f64) -> f64 {
    let square = 0.25 * x * x;
    let mut term = 1.0;
    let mut sum = 1.0;
    for order in 1..60 {
        term *= square / f64::from(order * order);
        sum += term;
        if term < 1e-17 * sum {
            break;
        }
    }
    sum
}

/// ln I0.
fn log_bessel(x: f64) -> f64 {
    if x <= 30.0 {
        return math::ln(bessel(x));
    }
    let inverse = 1.0 / x;
    let series = 1.0 + inverse * (1.0 / 8.0 + inverse * (9.0 / 128.0 + inverse * (225.0 / 3072.0)));
    x - 0.5 * math::ln(TAU * x) + math::ln(series)
}

/// Reflectance of a smooth dielectric for unpolarised light that meets it from outside.
fn fresnel(cosine: f64, index: f64) -> f64 {
    let cosine = cosine.clamp(0.0, 1.0);
    let inside = (1.0 - (1.0 - cosine * cosine) / (index * index)).max(0.0).sqrt();
    let parallel = (index * cosine - inside) / (index * cosine + inside);
    let across = (cosine - index * inside) / (cosine + index * inside);
    0.5 * (parallel * parallel + across * across)
}
