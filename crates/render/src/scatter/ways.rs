//! Directions along which light is carried, and directions of hair for which scattering is known.

use glam::{IVec3, Vec3, Vec4};
use strandline_base::math;

/// Directions along which light is carried.
pub const DIRECTIONS: usize = 26;
/// Directions of hair for which scattering is known, on half of the sphere.
pub const TANGENTS: usize = 256;

/// Radiance of every direction.
pub type Rays = [Vec4; DIRECTIONS];

/// The directions: steps from cell to cell, with their shares of the sphere.
pub fn directions() -> [(IVec3, f32); DIRECTIONS] {
    let mut found = [(IVec3::ZERO, 0.0); DIRECTIONS];
    let mut count = 0;
    for index in 0..27 {
        let step = IVec3::new(index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1);
        // [Lebedev1976]: sums of polynomials up to the seventh order are exact.
        let share = match step.length_squared() {
            1 => 1.0 / 21.0,
            2 => 4.0 / 105.0,
            3 => 9.0 / 280.0,
            _ => continue,
        };
        found[count] = (step, share);
        count += 1;
    }
    found
}

/// Unit vectors spread evenly over half of the sphere.
pub(super) fn tangent(index: usize) -> Vec3 {
    let height = 1.0 - (index as f32 + 0.5) / TANGENTS as f32;
    let flat = (1.0 - height * height).sqrt();
    let turn = index as f32 * 2.399_963_2;
    Vec3::new(flat * math::cos(turn), height, flat * math::sin(turn))
}
