//! Segments that may come to touch, eight at a time.

use glam::Vec3;
use strandline_groom::{LANES, Lanes};
use wide::f32x8;

use super::rod_pairs::Point;
use crate::strands::rods::real::Vector;
use crate::wisps::boxes::{Hit, Row, Sieve};
use crate::wisps::place::NEAR;

#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(not(target_arch = "x86_64"))]
#[path = "rod_sieve/no_avx.rs"]
mod avx;
mod eight;

pub(super) use eight::Eight;
use eight::{Lone, PARALLEL};

/// Distance \[m\] that is rounding.
pub(super) const ROUNDING: f32 = 1e-5;

/// Segments in a part of a step, seen along two directions across one of them and along that across both: where they
/// are, or if they are moving on all of their way.
pub(super) struct Across<'a> {
    /// Radii \[m\] of segments and inverse masses \[1/kg\] of points, by block and point.
    pub(super) radii: &'a [Lanes],
    pub(super) inverse_mass: &'a [Lanes],
    /// By the numbers of their lanes.
    pub(super) points: &'a [Point],
    /// Way of a segment \[m\] that keeps it in the list.
    pub(super) wider: &'a [f32],
    pub(super) moving: bool,
}

/// A [`Lone`] in each lane.
pub(super) struct One {
    start: Vector<f32x8>,
    along: Vector<f32x8>,
    ways: [Vector<f32x8>; 2],
    sights: [Sight; 2],
    /// Distance \[m\] within which another without radius is near.
    reach: f32x8,
}

/// A vector across a segment, and the least and the most of the ways of its ends along it.
struct Sight {
    direction: Vector<f32x8>,
    least: f32x8,
    most: f32x8,
}

impl Sight {
    #[inline]
    fn new(direction: Vector<f32x8>, ways: &[Vector<f32x8>; 2]) -> Self {
        let [one, other] = [direction.dot(ways[0]), direction.dot(ways[1])];
        Self { direction, least: one.fast_min(other), most: one.fast_max(other) }
    }
}

impl Across<'_> {
    fn radius(&self, segment: u32) -> f32 {
        self.radii[segment as usize / LANES].0[segment as usize % LANES]
    }

    fn is_free(&self, segment: u32) -> bool {
        let (index, lane) = (segment as usize / LANES, segment as usize % LANES);
        [index, index + 1].iter().any(|at| self.inverse_mass[*at].0[lane] > 0.0)
    }

    fn reach(&self, segment: u32) -> f32 {
        let more = if self.moving { 0.5 * ROUNDING } else { self.wider[segment as usize] };
        NEAR * self.radius(segment) + more
    }

    fn ends(&self, segment: u32) -> [Point; 2] {
        [self.points[segment as usize], self.points[segment as usize + LANES]]
    }
}

impl Sieve for Across<'_> {
    type One = One;
    type Eight = Eight;

    fn one(&self, eight: &Eight, lane: usize) -> One {
        let Lone { start, along, ways, sights, reach } = eight.lone(lane);
        let sights = sights.map(|(direction, least, most)| Sight {
            direction: Vector::splat(direction),
            least: f32x8::splat(least),
            most: f32x8::splat(most),
        });
        let (start, along) = (Vector::splat(start), Vector::splat(along));
        One { start, along, ways: ways.map(Vector::splat), sights, reach: f32x8::splat(reach) }
    }

    fn eight(&self, segments: [u32; LANES]) -> Eight {
        let mut ends = [[Vec3::ZERO; LANES]; 2];
        let mut ways = ends;
        for (lane, segment) in segments.into_iter().enumerate() {
            for (end, point) in self.ends(segment).into_iter().enumerate() {
                (ends[end][lane], ways[end][lane]) = (point.start, point.coast);
            }
        }
        Eight {
            ends: ends.map(strandline_base::vec3x8::lanes),
            ways: ways.map(strandline_base::vec3x8::lanes),
            reach: f32x8::from(segments.map(|segment| self.reach(segment))),
        }
    }

    #[inline]
    fn may_meet(&self, one: &One, eight: &Eight, lanes: u32) -> u32 {
        let reach = one.reach + eight.reach;
        let [lower, upper] = eight.ends.map(|end| end - one.start);
        let seen = |sight: &Sight, reach: f32x8| {
            let (c, d) = (sight.direction.dot(lower), sight.direction.dot(upper));
            let (mut low, mut high) = (c.fast_min(d), c.fast_max(d));
            if self.moving {
                let [c, d] = eight.ways.map(|way| sight.direction.dot(way));
                low += (c.fast_min(d) - sight.most).fast_min(f32x8::ZERO);
                high += (c.fast_max(d) - sight.least).fast_max(f32x8::ZERO);
            }
            (low.simd_le(reach) & high.simd_ge(-reach)).to_bitmask()
        };
        let lanes = lanes & seen(&one.sights[0], reach);
        if lanes == 0 {
            return 0;
        }
        let lanes = lanes & seen(&one.sights[1], reach);
        if lanes == 0 {
            return 0;
        }
        let edge = upper - lower;
        let across = one.along.cross(edge);
        let square = across.dot(across);
        let parallel = square.simd_lt(edge.dot(edge) * f32x8::splat(PARALLEL)).to_bitmask();
        lanes & (parallel | seen(&Sight::new(across, &one.ways), reach * square.sqrt()))
    }

    fn scan(&self, row: &Row<Eight>, hits: &mut Vec<Hit>) {
        match avx::Avx::new() {
            Some(avx) => avx.scan(row, self.moving, hits),
            None => self.scan_plain(row, hits),
        }
    }

    fn judge(&self, [one, other]: [u32; 2]) -> Option<f32> {
        (self.is_free(one) || self.is_free(other)).then_some(f32::NEG_INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use strandline_body::Random;

    use super::*;
    use crate::wisps::boxes::Corners;

    #[test]
    fn bits_are_those_of_any_processor() {
        const BLOCKS: usize = 40;
        let Some(avx) = avx::Avx::new() else { return };
        let mut random = Random::new(11, 0);
        let mut vector =
            |size: f32| Vec3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5) * size;
        let mut points = [Point::default(); 2 * BLOCKS * LANES];
        for point in &mut points {
            *point = Point { start: vector(0.02), coast: vector(0.004) };
        }
        // A way that is no number, a segment of no length, and one that is parallel to the first.
        points[9 * LANES].coast = Vec3::splat(f32::NAN);
        points[1 + LANES] = points[1];
        points[2 + LANES].start = points[2].start + (points[LANES].start - points[0].start);
        let segments: Vec<u32> =
            (0..(BLOCKS * LANES) as u32).map(|segment| segment + segment / 8 * 8).collect();
        let radii = [Lanes([3e-4; LANES]); 2 * BLOCKS];
        let wider = [1e-4; 2 * BLOCKS * LANES];
        let mut counts = [0; 2];
        for moving in [false, true] {
            let sieve = Across { radii: &radii, inverse_mass: &[], points: &points, wider: &wider, moving };
            let eights: Vec<Eight> = segments
                .chunks_exact(LANES)
                .map(|eight| sieve.eight(std::array::from_fn(|lane| eight[lane])))
                .collect();
            let corners: Vec<Corners> = (0..BLOCKS)
                .map(|_| {
                    let low = vector(0.02).to_array().map(f32x8::splat);
                    Corners { low, high: low.map(|low| low + f32x8::splat(0.01)) }
                })
                .collect();
            for (entry, segment) in segments.iter().enumerate() {
                let end = segments.len() - entry % 11;
                let row = Row { entry, end: end.max(entry + 1), corners: &corners, eights: &eights };
                let (mut plain, mut fast) = (Vec::new(), Vec::new());
                sieve.scan_plain(&row, &mut plain);
                avx.scan(&row, moving, &mut fast);
                assert_eq!(plain, fast, "{segment}");
                counts[usize::from(moving)] += plain.len();
            }
        }
        assert!(counts[0] > 100 && counts[1] > counts[0], "{counts:?}");
    }
}
