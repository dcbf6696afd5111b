//! Places at equal distances along a strand.

use glam::Vec3;

/// Distance of two points in a row over that along the strand up to which they coincide.
const COINCIDENT: f32 = 1e-3;

/// Points at equal distances along a polyline, both ends included.
pub(crate) fn equal_arcs(points: &[Vec3], count: usize) -> impl Iterator<Item = Vec3> + '_ {
    equal_places(points, count).map(|(segment, share)| match share {
        1.0 => points[segment + 1],
        _ => points[segment].lerp(points[segment + 1], share),
    })
}

/// Points as [`equal_arcs`], of which no two in a row coincide unless a strand of two points is closed: where a strand is
/// folded back upon itself, the first of two such points moves to the fold.
pub(crate) fn parted_arcs(points: &[Vec3], count: usize) -> Vec<Vec3> {
    let mut even: Vec<Vec3> = equal_arcs(points, count).collect();
    let length: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let least = COINCIDENT * length / (count - 1) as f32;
    if count < 3 || even.windows(2).all(|pair| pair[0].distance(pair[1]) > least) {
        return even;
    }
    // Twice as many places have the folds half-way.
    let halves: Vec<Vec3> = equal_arcs(points, 2 * count - 1).collect();
    for index in 0..count - 1 {
        if even[index].distance(even[index + 1]) <= least {
            let moved = if index == 0 { 1 } else { index };
            even[moved] = halves[if index == 0 { 3 } else { 2 * index + 1 }];
        }
    }
    even
}

/// Places at equal distances along a polyline, both ends included: a segment, and the share of it before
/// the place.
pub(crate) fn equal_places(points: &[Vec3], count: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
    let total: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let mut segment = 0;
    let mut passed = 0.0;
    (0..count).map(move |index| {
        if index + 1 == count {
            return (points.len() - 2, 1.0);
        }
        let wanted = total * index as f32 / (count - 1) as f32;
        loop {
            let length = points[segment].distance(points[segment + 1]);
            if passed + length >= wanted || segment + 2 == points.len() {
                let share = if length > 0.0 { ((wanted - passed) / length).clamp(0.0, 1.0) } else { 0.0 };
                return (segment, share);
            }
            passed += length;
            segment += 1;
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_folded_strand_part_and_all_others_stay() {
        let there: Vec<Vec3> = (0..8).map(|point| Vec3::X * point as f32).collect();
        let folded: Vec<Vec3> = there.iter().chain(there.iter().rev()).copied().collect();
        for count in [4, 6, 16] {
            let least = |points: &[Vec3]| {
                points.windows(2).map(|pair| pair[0].distance(pair[1])).fold(f32::INFINITY, f32::min)
            };
            assert!(least(&equal_arcs(&folded, count).collect::<Vec<_>>()) < 1e-5);
            let parted = parted_arcs(&folded, count);
            assert!(least(&parted) > 0.4 * 14.0 / count as f32, "{count}: {parted:?}");
            assert_eq!([parted[0], parted[count - 1]], [folded[0]; 2]);
        }
        assert_eq!(parted_arcs(&there, 5), equal_arcs(&there, 5).collect::<Vec<_>>());
        let closed = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::ZERO];
        assert_eq!(parted_arcs(&closed, 2), [Vec3::ZERO; 2], "a ring of two points");
    }
}
