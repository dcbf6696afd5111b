//! Boxes and sieve by AVX instructions where the processor has them, whatever target the program was compiled for: with
//! the same bits.
#![allow(unsafe_code)] // see Avx::scan

use std::arch::x86_64::{
    __m256, _CMP_GE_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_ps, _mm256_and_ps, _mm256_cmp_ps, _mm256_max_ps,
    _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_set1_ps, _mm256_setzero_ps, _mm256_sqrt_ps,
    _mm256_sub_ps, _mm256_xor_ps,
};

use glam::Vec3;
use wide::f32x8;

use super::eight::{Eight, Lone, PARALLEL};
use crate::strands::rods::real::Vector;
use crate::wisps::boxes::{Hit, Row};

/// A processor that has the instructions.
#[derive(Clone, Copy)]
pub(super) struct Avx(());

/// A vector of eight lanes.
type Eights = [__m256; 3];

impl Avx {
    /// None where this processor has none.
    pub(super) fn new() -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx").then_some(Self(()))
    }

    /// As [`Row::scan`].
    pub(super) fn scan(self, row: &Row<Eight>, moving: bool, hits: &mut Vec<Hit>) {
        // SAFETY: there is no Avx where the processor has no AVX.
        unsafe { scan(row, moving, hits) }
    }
}

#[target_feature(enable = "avx")]
fn scan(row: &Row<Eight>, moving: bool, hits: &mut Vec<Hit>) {
    let (own, lane) = row.own();
    let one = own.lone(lane);
    let [low, high] = row.corners().map(|corner| corner.map(|number| _mm256_set1_ps(number)));
    for group in row.groups() {
        let corners = &row.corners[group];
        let mut meets = _mm256_cmp_ps::<_CMP_LE_OQ>(of(corners.low[0]), high[0]);
        meets = _mm256_and_ps(meets, _mm256_cmp_ps::<_CMP_LE_OQ>(low[0], of(corners.high[0])));
        for axis in 1..3 {
            meets = _mm256_and_ps(meets, _mm256_cmp_ps::<_CMP_LE_OQ>(of(corners.low[axis]), high[axis]));
            meets = _mm256_and_ps(meets, _mm256_cmp_ps::<_CMP_LE_OQ>(low[axis], of(corners.high[axis])));
        }
        let lanes = row.lanes(group) & bits(meets);
        if lanes == 0 {
            continue;
        }
        let lanes = may_meet(&one, &row.eights[group], lanes, moving);
        if lanes != 0 {
            hits.push(Hit { group, lanes });
        }
    }
}

/// As `may_meet` of the plain sieve.
#[target_feature(enable = "avx")]
#[inline]
fn may_meet(one: &Lone, eight: &Eight, lanes: u32, moving: bool) -> u32 {
    let reach = _mm256_add_ps(_mm256_set1_ps(one.reach), of(eight.reach));
    let start = same(one.start);
    let (lower, upper) = (minus(all(eight.ends[0]), start), minus(all(eight.ends[1]), start));
    let ways = [all(eight.ways[0]), all(eight.ways[1])];
    let mut lanes = lanes;
    for (direction, least, most) in one.sights {
        let sight = (same(direction), _mm256_set1_ps(least), _mm256_set1_ps(most));
        lanes &= seen(sight, [lower, upper], ways, moving, reach);
        if lanes == 0 {
            return 0;
        }
    }
    let edge = minus(upper, lower);
    let across = cross(same(one.along), edge);
    let square = dot(across, across);
    let least = _mm256_mul_ps(dot(edge, edge), _mm256_set1_ps(PARALLEL));
    let parallel = bits(_mm256_cmp_ps::<_CMP_LT_OQ>(square, least));
    let (c, d) = (dot(across, same(one.ways[0])), dot(across, same(one.ways[1])));
    let sight = (across, _mm256_min_ps(c, d), _mm256_max_ps(c, d));
    let reach = _mm256_mul_ps(reach, _mm256_sqrt_ps(square));
    lanes & (parallel | seen(sight, [lower, upper], ways, moving, reach))
}

/// Bits of the lanes that are near along a direction.
#[target_feature(enable = "avx")]
#[inline]
fn seen(
    (direction, least, most): (Eights, __m256, __m256),
    [lower, upper]: [Eights; 2],
    ways: [Eights; 2],
    moving: bool,
    reach: __m256,
) -> u32 {
    let (c, d) = (dot(direction, lower), dot(direction, upper));
    let (mut low, mut high) = (_mm256_min_ps(c, d), _mm256_max_ps(c, d));
    if moving {
        let (c, d) = (dot(direction, ways[0]), dot(direction, ways[1]));
        let none = _mm256_setzero_ps();
        low = _mm256_add_ps(low, _mm256_min_ps(_mm256_sub_ps(_mm256_min_ps(c, d), most), none));
        high = _mm256_add_ps(high, _mm256_max_ps(_mm256_sub_ps(_mm256_max_ps(c, d), least), none));
    }
    let beyond = _mm256_xor_ps(reach, _mm256_set1_ps(-0.0));
    let (before, behind) =
        (_mm256_cmp_ps::<_CMP_LE_OQ>(low, reach), _mm256_cmp_ps::<_CMP_GE_OQ>(high, beyond));
    bits(_mm256_and_ps(before, behind))
}

#[target_feature(enable = "avx")]
#[inline]
fn same(vector: Vec3) -> Eights {
    vector.to_array().map(|number| _mm256_set1_ps(number))
}

#[target_feature(enable = "avx")]
#[inline]
fn of(numbers: f32x8) -> __m256 {
    bytemuck::cast(numbers.to_array())
}

#[target_feature(enable = "avx")]
#[inline]
fn all(vector: Vector<f32x8>) -> Eights {
    [of(vector.x), of(vector.y), of(vector.z)]
}

/// Bits of the lanes of a mask.
#[target_feature(enable = "avx")]
#[inline]
fn bits(mask: __m256) -> u32 {
    _mm256_movemask_ps(mask) as u32
}

#[target_feature(enable = "avx")]
#[inline]
fn minus(one: Eights, other: Eights) -> Eights {
    [_mm256_sub_ps(one[0], other[0]), _mm256_sub_ps(one[1], other[1]), _mm256_sub_ps(one[2], other[2])]
}

#[target_feature(enable = "avx")]
#[inline]
fn dot(one: Eights, other: Eights) -> __m256 {
    let first = _mm256_add_ps(_mm256_mul_ps(one[0], other[0]), _mm256_mul_ps(one[1], other[1]));
    _mm256_add_ps(first, _mm256_mul_ps(one[2], other[2]))
}

#[target_feature(enable = "avx")]
#[inline]
fn cross([x, y, z]: Eights, [u, v, w]: Eights) -> Eights {
    [
        _mm256_sub_ps(_mm256_mul_ps(y, w), _mm256_mul_ps(z, v)),
        _mm256_sub_ps(_mm256_mul_ps(z, u), _mm256_mul_ps(x, w)),
        _mm256_sub_ps(_mm256_mul_ps(x, v), _mm256_mul_ps(y, u)),
    ]
}
