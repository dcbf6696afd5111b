//! Terms around the fibre.

use std::f64::consts::PI;

use super::lobes::LOBES;

/// Nodes of the turn between light and eye, 0 to pi.
pub const TURNS: usize = 49;

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
