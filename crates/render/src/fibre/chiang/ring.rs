//! Terms around the fibre.

use std::f64::consts::{FRAC_PI_2, PI};

use strandline_base::math;

use super::lobes::{LOBES, Lobes};

/// Nodes of the turn between light and eye, 0 to pi.
pub const TURNS: usize = 49;
/// Number of [`LEVELS`].
pub const LEVEL_COUNT: usize = 8;
/// Multiples of the pigment at the root for which there are entries; the first is white hair.
pub const LEVELS: [f32; LEVEL_COUNT] = [0.0, 1.0 / 64.0, 1.0 / 16.0, 0.25, 0.5, 1.0, 2.0, 4.0];
/// Offsets across the width that are summed.
const OFFSETS: usize = 96;

/// Terms around the fibre of one inclination of the eye, `[turn][lobe][channel]`.
pub(super) type Ring = Vec<[[f64; 3]; LOBES]>;

/// Sums a ring over the whole turn, weighted, with straight lines between its nodes.
pub(super) fn turn_sums(ring: &Ring, weight: impl Fn(f64) -> f64) -> [[f64; 3]; LOBES] {
    let mut sums = [[0.0; 3]; LOBES];
    let step = PI / (TURNS - 1) as f64;
    for (index, found) in ring.iter().enumerate() {
        let half = if index == 0 || index == TURNS - 1 { 0.5 } else { 1.0 };
        // Both sides of the eye.
        let share = 2.0 * step * half * weight(step * index as f64);
        for lobe in 0..LOBES {
            (0..3).for_each(|channel| sums[lobe][channel] += share * found[lobe][channel]);
        }
    }
    sums
}

/// Mean over the width of share times density of the turn, at each node of the turn, for each level of pigment.
pub(super) fn rings(lobes: &Lobes, eye: f64, absorption: [f64; 3]) -> [Ring; LEVEL_COUNT] {
    let absorptions = LEVELS.map(|level| absorption.map(|channel| channel * f64::from(level)));
    let mut rings = LEVELS.map(|_| vec![[[0.0; 3]; LOBES]; TURNS]);
    for offset in 0..OFFSETS {
        // Even steps of the angle at which the ray meets the surface; both sides are the same but for the turn's sign.
        let angle = FRAC_PI_2 * (offset as f64 + 0.5) / OFFSETS as f64;
        let (h, weight) = (math::sin(angle), math::cos(angle) * FRAC_PI_2 / OFFSETS as f64);
        let shares = absorptions.map(|absorption| lobes.shares(eye, h, absorption));
        for index in 0..TURNS {
            let turn = PI * index as f64 / (TURNS - 1) as f64;
            let (one, other) = (lobes.turns(eye, h, turn), lobes.turns(eye, h, -turn));
            for (ring, shares) in rings.iter_mut().zip(&shares) {
                for lobe in 0..LOBES {
                    let density = 0.5 * weight * (one[lobe] + other[lobe]);
                    (0..3).for_each(|channel| ring[index][lobe][channel] += density * shares[lobe][channel]);
                }
            }
        }
    }
    for (ring, absorption) in rings.iter_mut().zip(absorptions) {
        balance(ring, lobes, eye, absorption);
    }
    rings
}

/// Scales each kind of path so that the table, linear between nodes, integrates to the share of light on that path.
fn balance(ring: &mut Ring, lobes: &Lobes, eye: f64, absorption: [f64; 3]) {
    let mut shares = [[0.0; 3]; LOBES];
    for offset in 0..4 * OFFSETS {
        let angle = FRAC_PI_2 * (offset as f64 + 0.5) / (4 * OFFSETS) as f64;
        let weight = math::cos(angle) * FRAC_PI_2 / (4 * OFFSETS) as f64;
        let found = lobes.shares(eye, math::sin(angle), absorption);
        for lobe in 0..LOBES {
            (0..3).for_each(|channel| shares[lobe][channel] += weight * found[lobe][channel]);
        }
    }
    let whole = turn_sums(ring, |_| 1.0);
    for found in ring.iter_mut() {
        for lobe in 0..LOBES {
            for channel in 0..3 {
                found[lobe][channel] *= shares[lobe][channel] / whole[lobe][channel].max(1e-300);
            }
        }
    }
}
