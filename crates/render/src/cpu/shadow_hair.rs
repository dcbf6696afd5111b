//! Walks strands through a light's texels.

use std::ops::Range;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::Strands;
use super::shadow::{LightView, Window};

/// Most parts that the strands are shared out to; each part fills a map of its own.
const MOST_PARTS: usize = 8;
/// Strands whose bounds are found together.
const CHUNK: usize = 4096;

/// Number of parts: results do not depend on it.
pub(crate) fn part_count() -> usize {
    rayon::current_num_threads().min(MOST_PARTS)
}

/// The strands of a part.
pub(crate) fn part_strands(strands: &Strands, part: usize, parts: usize) -> Range<usize> {
    strands.strand_count * part / parts..strands.strand_count * (part + 1) / parts
}

/// Least and greatest plane coordinates of points \[m\] that the light sees.
pub(crate) fn plane_bounds(points: &[Vec3], view: &LightView) -> (Vec2, Vec2) {
    let empty = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    points
        .par_chunks(CHUNK)
        .map(|chunk| {
            chunk
                .iter()
                .filter_map(|&point| view.project(point))
                .fold(empty, |(min, max), point| (min.min(point.truncate()), max.max(point.truncate())))
        })
        .reduce(|| empty, |one, other| (one.0.min(other.0), one.1.max(other.1)))
}

/// A piece of hair in one texel.
pub(crate) struct Piece {
    /// Index of the texel.
    pub(crate) texel: usize,
    /// Depth \[m\].
    pub(crate) depth: f32,
    /// Share of the texel that the piece covers.
    pub(crate) coverage: f32,
    /// Width of the hair \[texel\].
    pub(crate) width: f32,
}

/// Cuts segments into pieces no longer than a texel along the axis that they follow most, and
/// hands each to `take`. The pieces of a segment cover width times length, whatever the map's size.
pub(crate) fn walk(
    strands: &Strands,
    range: Range<usize>,
    view: &LightView,
    window: &Window,
    size: usize,
    mut take: impl FnMut(Piece),
) {
    let count = strands.points_per_strand;
    for strand in range.filter(|strand| strands.is_drawn(*strand)) {
        let points = strand * count..(strand + 1) * count;
        let mut last: Option<(Vec3, f32)> = None;
        for (&position, &width) in strands.positions[points.clone()].iter().zip(&strands.widths[points]) {
            let next = view.project(position).map(|point| {
                let texel = window.texel(point.truncate());
                (texel.extend(point.z), width * view.scale(point.z) * window.density)
            });
            if let (Some(start), Some(end)) = (last, next) {
                cut(start, end, size, &mut take);
            }
            last = next;
        }
    }
}

/// Cuts one segment; ends are texel coordinates with depth, and width \[texel\].
#[inline]
fn cut(start: (Vec3, f32), end: (Vec3, f32), size: usize, take: &mut impl FnMut(Piece)) {
    let way = end.0 - start.0;
    let longest = way.x.abs().max(way.y.abs());
    let limit = size as f32;
    if longest.is_nan() || longest > 4.0 * limit {
        return;
    }
    let pieces = (longest.ceil() as usize).max(1);
    let inverse = 1.0 / pieces as f32;
    let length = (way.x * way.x + way.y * way.y).sqrt() * inverse;
    let step = way * inverse;
    let mut at = start.0 + 0.5 * step;
    let widening = (end.1 - start.1) * inverse;
    let mut width = start.1 + 0.5 * widening;
    for _ in 0..pieces {
        if at.x >= 0.0 && at.y >= 0.0 && at.x < limit && at.y < limit {
            take(Piece {
                texel: at.y as usize * size + at.x as usize,
                depth: at.z,
                coverage: length * width,
                width,
            });
        }
        at += step;
        width += widening;
    }
}
