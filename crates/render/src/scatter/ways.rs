//! Directions along which light is carried, and directions of hair for which scattering is known.

use glam::{IVec3, Quat, Vec3, Vec4};
use strandline_base::math;

/// Directions along which light is carried from one scattering to the next.
pub const DIRECTIONS: usize = 50;
/// Sets of directions, which take turns: light that one set resolves badly is resolved by the next.
pub const SETS: usize = 2;
/// Directions of hair for which scattering is known, on half of the sphere.
pub const TANGENTS: usize = 256;

/// Radiance of every direction of a set.
pub type Rays = [Vec4; DIRECTIONS];

/// A set of directions: unit vectors in which light goes, with their shares of the sphere.
pub type Set = [(Vec3, f32); DIRECTIONS];

/// The directions of a set; the `n`-th last is opposite to the `n`-th.
pub fn directions(set: usize) -> Set {
    // Turned about an axis that no symmetry of the cells has.
    let turn = if set == 0 { Quat::IDENTITY } else { Quat::from_xyzw(0.8343, -0.0065, -0.2212, -0.5049) };
    let turn = turn.normalize();
    let mut found = [(Vec3::ZERO, 0.0); DIRECTIONS];
    let mut count = 0;
    for index in 0..343 {
        let step = IVec3::new(index % 7 - 3, index / 7 % 7 - 3, index / 49 - 3);
        // [Lebedev1976]: sums of polynomials up to the eleventh order are exact.
        let share = match (step.length_squared(), step.abs().max_element()) {
            (1, _) => 4.0 / 315.0,
            (2, _) => 64.0 / 2_835.0,
            (3, _) => 27.0 / 1_280.0,
            (11, 3) => 14_641.0 / 725_760.0,
            _ => continue,
        };
        found[count] = (turn * step.as_vec3().normalize(), share);
        count += 1;
    }
    found
}

/// Lines of cells along a direction: from plane to plane of the axis that it goes along most, and aside where the
/// direction passes into the next row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lines {
    /// The axis.
    pub(crate) axis: usize,
    backward: bool,
    /// Cells aside per plane, along the axes behind the first one.
    slopes: [f32; 2],
    /// Length from plane to plane over that of a cell.
    pub(crate) length: f32,
}

impl Lines {
    pub(crate) fn new(direction: Vec3) -> Self {
        let most = direction.abs().max_element();
        let axis = direction.abs().max_position();
        let slopes = [1, 2].map(|aside| direction[(axis + aside) % 3] / most);
        Self { axis, backward: direction[axis] < 0.0, slopes, length: 1.0 / most }
    }

    /// True if light goes toward lower numbers of planes.
    pub(crate) fn is_backward(&self) -> bool {
        self.backward
    }

    /// Cells by which a line lies aside at a plane, counted in the order in which light meets them.
    #[inline]
    pub(crate) fn aside(&self, plane: i32) -> [i32; 2] {
        // Just below a half: directions along diagonals of cells meet no edge between two of them.
        self.slopes
            .map(|slope| ((slope * plane as f32).abs() + 0.4999).floor() as i32 * slope.signum() as i32)
    }

    /// The plane of the axis that light meets as the `number`-th of so many, or the number of such a plane.
    #[inline]
    pub(crate) fn plane(&self, number: i32, count: i32) -> i32 {
        if self.backward { count - 1 - number } else { number }
    }

    /// The step to a plane from the one before it along the line, by the number in which light meets the plane.
    #[inline]
    pub(crate) fn step(&self, number: i32) -> IVec3 {
        let (here, before) = (self.aside(number), self.aside(number - 1));
        let mut step = IVec3::ZERO;
        step[self.axis] = if self.backward { -1 } else { 1 };
        step[(self.axis + 1) % 3] = here[0] - before[0];
        step[(self.axis + 2) % 3] = here[1] - before[1];
        step
    }
}

/// Unit vectors spread evenly over half of the sphere.
pub(super) fn tangent(index: usize) -> Vec3 {
    let height = 1.0 - (index as f32 + 0.5) / TANGENTS as f32;
    let flat = (1.0 - height * height).sqrt();
    let turn = index as f32 * 2.399_963_2;
    Vec3::new(flat * math::cos(turn), height, flat * math::sin(turn))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_sums_polynomials_and_holds_opposites() {
        for set in 0..SETS {
            let ways = directions(set);
            let sum = |of: fn(Vec3) -> f32| ways.iter().map(|(way, share)| of(*way) * share).sum::<f32>();
            for (found, expected) in [
                (sum(|_| 1.0), 1.0),
                (sum(|way| way.x), 0.0),
                (sum(|way| way.y.powi(10)), 1.0 / 11.0),
                (sum(|way| (way.x * way.z).powi(2)), 1.0 / 15.0),
                (sum(|way| way.x.powi(4) * way.y.powi(2) * way.z.powi(4)), 9.0 / 10_395.0),
            ] {
                assert!((found - expected).abs() < 1e-6, "{set}: {found} {expected}");
            }
            for (way, opposite) in ways.iter().zip(ways.iter().rev()) {
                assert!(way.0.abs_diff_eq(-opposite.0, 1e-6), "{way:?} {opposite:?}");
            }
        }
    }

    #[test]
    fn lines_stay_beside_their_direction() {
        for (way, _) in (0..SETS).flat_map(directions) {
            let lines = Lines::new(way);
            let mut place = IVec3::ZERO;
            for number in 1..44 {
                place += lines.step(number);
                let aside = place.as_vec3() - way * (lines.length * number as f32);
                assert!(aside.abs().max_element() < 0.502, "{way} {number}: {aside}");
                // Both backends agree on the cell whatever their rounding.
                let near = aside.abs().to_array().into_iter().any(|aside| (aside - 0.4999).abs() < 1e-5);
                assert!(!near || lines.slopes.contains(&0.0), "{way} {number}: {aside}");
            }
        }
    }
}
