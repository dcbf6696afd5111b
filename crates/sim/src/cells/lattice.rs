//! Cells of one edge that fill space, for both backends: a cell is three whole numbers, and a hash gives it a bucket.

use glam::Vec3;
use strandline_base::SettingError;

use super::grid::REACH;

/// Least edge of a cell \[m\]: whole numbers of 32 bits count the cells within reach.
const MIN_EDGE: f32 = 1e-4;
/// Greatest edge of a cell \[m\].
const MAX_EDGE: f32 = 100.0;

/// Factors of a cell's whole numbers in the hash of its bucket [Teschner2003]. Products are added: joined by exclusive
/// or, as published, cells on both sides of the origin share buckets.
const HASH_X: u32 = 73_856_093;
const HASH_Y: u32 = 19_349_663;
const HASH_Z: u32 = 83_492_791;

/// Cells of one edge from the origin of the world on, and as many buckets as hair of a number of points needs.
///
/// Cells have no border and do not follow the hair, so that the cell of a point is a function of its position alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    per_metre: f32,
    bucket_count: u32,
}

impl Lattice {
    /// Cells with an edge \[m\], for a number of points.
    pub fn new(edge: f32, point_count: usize) -> Self {
        Self { per_metre: 1.0 / edge, bucket_count: (2 * point_count.max(1)).next_power_of_two() as u32 }
    }

    /// Checks an edge \[m\].
    ///
    /// # Errors
    /// An edge that is not finite, too short or too long.
    pub(crate) fn check(edge: f32) -> Result<(), SettingError> {
        if (MIN_EDGE..=MAX_EDGE).contains(&edge) {
            return Ok(());
        }
        Err(SettingError::new("simulation.cells", edge, format!("{MIN_EDGE} to {MAX_EDGE} m")))
    }

    /// Cells per metre.
    pub(crate) fn per_metre(&self) -> f32 {
        self.per_metre
    }

    /// Number of buckets, a power of two.
    pub fn bucket_count(&self) -> usize {
        self.bucket_count as usize
    }

    /// The cell that holds a point \[m\], world space; `None` for a point that is not finite or out of reach.
    #[inline]
    pub fn cell(&self, point: Vec3) -> Option<[i32; 3]> {
        // False for a coordinate that is not a number.
        let reached = point.abs().cmplt(Vec3::splat(REACH)).all();
        // A product, which every device rounds alike.
        let cell = (point * self.per_metre).floor();
        reached.then(|| cell.to_array().map(|number| number as i32))
    }

    /// The bucket of a cell. Cells may share one.
    #[inline]
    pub fn bucket(&self, [x, y, z]: [i32; 3]) -> u32 {
        let [x, y, z] = [x as u32, y as u32, z as u32];
        let [x, y, z] = [x.wrapping_mul(HASH_X), y.wrapping_mul(HASH_Y), z.wrapping_mul(HASH_Z)];
        x.wrapping_add(y).wrapping_add(z) & (self.bucket_count - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_those_of_the_world_and_have_no_border() {
        let lattice = Lattice::new(0.5, 100);
        assert_eq!(lattice.bucket_count(), 256);
        assert_eq!(lattice.cell(Vec3::new(0.25, -0.25, 1.5)), Some([0, -1, 3]));
        assert_eq!(lattice.cell(Vec3::new(9000.0, 0.0, 0.0)), Some([18_000, 0, 0]));
        assert_eq!(lattice.cell(Vec3::new(2.0 * REACH, 0.0, 0.0)), None);
        assert_eq!(lattice.cell(Vec3::new(0.0, f32::NAN, 0.0)), None);
        let buckets: std::collections::BTreeSet<u32> =
            (0..64).map(|cell| lattice.bucket([cell % 4 - 2, cell / 4 % 4 - 2, cell / 16 - 2])).collect();
        // A random hash gives 57 of 64 cells a bucket of their own.
        assert!(buckets.len() > 57 && buckets.iter().all(|bucket| *bucket < 256), "{buckets:?}");
    }

    #[test]
    fn edges_out_of_range_are_refused() {
        for edge in [0.0, -1.0, 5e-5, 1e3, f32::NAN, f32::INFINITY] {
            assert!(Lattice::check(edge).is_err(), "{edge}");
        }
        assert!(Lattice::check(0.002).is_ok());
    }
}
