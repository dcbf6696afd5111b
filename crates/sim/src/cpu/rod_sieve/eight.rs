//! Eight segments, and one of them against which others are tested.

use glam::Vec3;
use wide::f32x8;

use crate::strands::rods::real::Vector;

/// Square of a sine below which two segments count as parallel: what both are across is rounding.
pub(super) const PARALLEL: f32 = 1e-6;

/// A segment against which others are tested: where it begins and its direction, the ways of its ends, vectors across it with
/// the least and the most of these ways, and the distance \[m\] within which another without radius is near.
pub(super) struct Lone {
    pub(super) start: Vec3,
    pub(super) along: Vec3,
    pub(super) ways: [Vec3; 2],
    pub(super) sights: [(Vec3, f32, f32); 2],
    pub(super) reach: f32,
}

/// Ends of eight segments and their ways \[m\], and distances within which another is near.
#[derive(Clone)]
pub(in crate::cpu) struct Eight {
    pub(super) ends: [Vector<f32x8>; 2],
    pub(super) ways: [Vector<f32x8>; 2],
    pub(super) reach: f32x8,
}

impl Eight {
    /// One of them, against which others are tested.
    #[inline]
    pub(super) fn lone(&self, lane: usize) -> Lone {
        let of = |vector: &Vector<f32x8>| {
            Vec3::from([&vector.x, &vector.y, &vector.z].map(|numbers| numbers.as_array()[lane]))
        };
        let ([start, end], ways) = (self.ends.each_ref().map(of), self.ways.each_ref().map(of));
        let along = (end - start).normalize_or(Vec3::X);
        let across = along.any_orthonormal_vector();
        let sights = [across, along.cross(across)].map(|direction| {
            let (one, other) = (direction.dot(ways[0]), direction.dot(ways[1]));
            (direction, one.min(other), one.max(other))
        });
        Lone { start, along, ways, sights, reach: self.reach.as_array()[lane] }
    }
}
