//! Places at equal distances along a strand.

use glam::Vec3;

/// Points at equal distances along a polyline, both ends included.
pub(crate) fn equal_arcs(points: &[Vec3], count: usize) -> impl Iterator<Item = Vec3> + '_ {
    equal_places(points, count).map(|(segment, share)| match share {
        1.0 => points[segment + 1],
        _ => points[segment].lerp(points[segment + 1], share),
    })
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
