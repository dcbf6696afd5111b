//! Radiance of a fibre in light that changes slowly with direction.
//!
//! Radiance from a unit direction w is taken as a + b.w + w.C.w with a C without trace: spherical harmonics up to the
//! second order. With the fibre's direction t and u, across it toward the eye, what the fibre shows is
//! `m0 a + m1 b.t + m2 b.u + m3 t.C.t + m4 u.C.u + m5 t.C.u`: six numbers for each inclination of the eye.

use std::f64::consts::FRAC_PI_2;

use strandline_base::math;

use super::lobes::{LOBES, Lobes};
use super::ring::{Ring, turn_sums};

/// Moments of each channel.
pub const MOMENTS: usize = 6;
/// Inclinations of light that are summed.
const INCLINATIONS: usize = 360;

/// Means over the light's inclination of 1, s, c, s^2, c^2 and s c, its sine and cosine, of each kind of path.
pub(super) type Powers = [[f64; LOBES]; MOMENTS];

/// Those means for an inclination of the eye \[rad\].
pub(super) fn powers(lobes: &Lobes, eye: f64) -> Powers {
    let mut along = [[0.0; LOBES]; MOMENTS];
    for index in 0..INCLINATIONS {
        let light = FRAC_PI_2 * (2.0 * (index as f64 + 0.5) / INCLINATIONS as f64 - 1.0);
        let (s, c) = math::sin_cos(light);
        let densities = lobes.inclinations(eye, light);
        for (lobe, density) in densities.into_iter().enumerate() {
            for (sum, power) in along.iter_mut().zip([1.0, s, c, s * s, c * c, s * c]) {
                sum[lobe] += density * c * power;
            }
        }
    }
    let whole = along[0];
    for sums in &mut along {
        sums.iter_mut().zip(whole).for_each(|(sum, whole)| *sum /= whole);
    }
    along
}

/// The moments of the three channels for an inclination of the eye with its ring.
pub(super) fn moments(along: &Powers, ring: &Ring) -> [[f64; 3]; MOMENTS] {
    let around = [0.0, 1.0, 2.0].map(|order| turn_sums(ring, |turn| math::cos(order * turn)));
    let mut found = [[0.0; 3]; MOMENTS];
    let [one, s, c, ss, cc, sc] = *along;
    for lobe in 0..LOBES {
        for channel in 0..3 {
            let [whole, first, second] = [0, 1, 2].map(|order: usize| around[order][lobe][channel]);
            found[0][channel] += one[lobe] * whole;
            found[1][channel] += s[lobe] * whole;
            found[2][channel] += c[lobe] * first;
            found[3][channel] += ss[lobe] * whole - cc[lobe] * 0.5 * (whole - second);
            found[4][channel] += cc[lobe] * second;
            found[5][channel] += 2.0 * sc[lobe] * first;
        }
    }
    found
}
