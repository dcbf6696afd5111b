//! Points of a smooth curve in terms of the points of its guide: the weights of a uniform cubic B-spline.

use glam::Vec3;

use crate::DetailLevel;

/// Place of a curve point in its guide: the first of four control points and their weights for position and
/// tangent. Control point 0 stands before the guide's first.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tap {
    pub(crate) first: usize,
    pub(crate) position: [f32; 4],
    pub(crate) tangent: [f32; 4],
}

/// Place of each point of a curve in its guide, and its parameter, 0 at the root to 1 at the tip.
pub(crate) fn taps(points_per_strand: usize, level: &DetailLevel) -> impl Iterator<Item = (Tap, f32)> {
    let span_count = points_per_strand - 1;
    let segments = level.segment_count(points_per_strand);
    let per_span = level.segments_per_span;
    (0..=segments).map(move |point| {
        let parameter = if point == segments { span_count as f32 } else { point as f32 / per_span };
        (tap(parameter, span_count), parameter / span_count as f32)
    })
}

/// Control points and weights at a parameter, 0 to the number of spans.
fn tap(parameter: f32, span_count: usize) -> Tap {
    let first = (parameter as usize).min(span_count - 1);
    let t = parameter - first as f32;
    let r = 1.0 - t;
    // [Chen2011 fig. 52]
    let position = [
        r * r * r / 6.0,
        (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
        (3.0 * r * r * r - 6.0 * r * r + 4.0) / 6.0,
        t * t * t / 6.0,
    ];
    let tangent = [-0.5 * r * r, 1.5 * t * t - 2.0 * t, 2.0 * r - 1.5 * r * r, 0.5 * t * t];
    Tap { first, position, tangent }
}

/// Two axes in the skin at a root, head space.
pub(crate) fn skin_axes(root_normal: Vec3) -> [Vec3; 2] {
    root_normal.any_orthonormal_pair().into()
}
