//! Walks strands through a light's texels.

use std::ops::Range;

use glam::{Vec2, Vec3, Vec4};
use strandline_base::par::prelude::*;
use wide::f32x4;

use crate::lanes::rounded_up;
use crate::shadow::{LightView, Window, part_count};
use crate::strands::Strands;

/// Width \[texel\] above which hair is laid out in rows, and the most of them.
const WIDE: f32 = 2.0;
const MOST_ROWS: f32 = 256.0;
/// Strands whose bounds are found together.
const CHUNK: usize = 4096;

/// Number of parts of the next among `maps` maps that are filled together. While there are as many maps as threads, each
/// thread fills a whole map, since parts have to be cleared and summed.
pub(crate) fn parts_of(map: usize, maps: usize) -> usize {
    let threads = part_count();
    let left = maps % threads;
    if map < maps - left { 1 } else { threads.div_ceil(left) }
}

/// Distance between rows of a map of `size` texels while it is filled. Rows a power of two apart share lines of the cache,
/// and hair hangs down across rows.
pub(crate) fn stride(size: usize) -> usize {
    size + 16
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
    /// Index of the texel, in rows of [`stride`].
    pub(crate) texel: usize,
    /// Depth \[m\].
    pub(crate) depth: f32,
    /// Share of the texel that the piece covers, times what its segment weighs.
    pub(crate) coverage: f32,
}

/// Cuts segments into pieces no longer than a texel along the axis that they follow most, and
/// hands each to `take`; hair of more than two texels' width in rows no wider than a texel. The pieces of a segment
/// cover width times length, whatever the map's size, times what `weigh` says of the segment's mean width \[texel\].
pub(crate) fn walk(
    strands: &Strands,
    range: Range<usize>,
    view: &LightView,
    window: &Window,
    size: usize,
    weigh: impl Fn(f32) -> f32,
    mut take: impl FnMut(Piece),
) {
    let count = strands.points_per_strand;
    for strand in range {
        let points = strand * count..(strand + 1) * count;
        let mut last: Option<(Vec3, f32)> = None;
        for (&position, &width) in strands.positions[points.clone()].iter().zip(&strands.widths[points]) {
            let next = view.project(position).map(|point| {
                let texel = window.texel(point.truncate());
                (texel.extend(point.z), width * view.scale(point.z) * window.density)
            });
            if let (Some(start), Some(end)) = (last, next) {
                cut(start, end, size, &weigh, &mut take);
            }
            last = next;
        }
    }
}

/// Cuts one segment; ends are texel coordinates with depth, and width \[texel\].
#[inline]
fn cut(
    start: (Vec3, f32),
    end: (Vec3, f32),
    size: usize,
    weigh: &impl Fn(f32) -> f32,
    take: &mut impl FnMut(Piece),
) {
    let (start, end) = (start.0.extend(start.1), end.0.extend(end.1));
    let way = end - start;
    let longest = way.x.abs().max(way.y.abs());
    let limit = size as f32;
    if longest.is_nan() || longest > 4.0 * limit {
        return;
    }
    let pieces = rounded_up(longest).max(1);
    let inverse = 1.0 / pieces as f32;
    let length = (way.x * way.x + way.y * way.y).sqrt() * inverse;
    let step = way * inverse;
    let weight = weigh(0.5 * (start.w + end.w));
    let line = Line { at: start + 0.5 * step, step, pieces, length: length * weight, size };
    let widest = start.w.max(end.w);
    if widest > WIDE && length > 0.0 {
        let rows = widest.min(MOST_ROWS).ceil();
        let aside = Vec2::new(way.x, way.y).perp().normalize_or_zero() / rows;
        return line.rows(rows, aside, take);
    }
    // Middles of pieces lie between the ends.
    let (low, high) = (start.min(end), start.max(end));
    if low.x >= 1.0 && low.y >= 1.0 && high.x < limit - 1.0 && high.y < limit - 1.0 {
        line.row(|_| true, take);
    } else {
        line.row(|at| is_within(Vec2::new(at.x, at.y), limit), take);
    }
}

/// A segment in pieces.
struct Line {
    /// Texel coordinates, depth \[m\] and width \[texel\] of the middle of the first piece, and what each adds.
    at: Vec4,
    step: Vec4,
    pieces: i32,
    /// Length of a piece \[texel\] times its weight.
    length: f32,
    /// Texels along a side of the map.
    size: usize,
}

impl Line {
    /// Hands out the pieces that are `seen`.
    #[inline]
    fn row(self, seen: impl Fn(Vec4) -> bool, take: &mut impl FnMut(Piece)) {
        let mut at = self.at;
        let stride = stride(self.size);
        for _ in 0..self.pieces {
            if seen(at) {
                let [column, row, ..] = f32x4::from(at.to_array()).fast_trunc_int().to_array();
                let texel = row as u32 as usize * stride + column as u32 as usize;
                take(Piece { texel, depth: at.z, coverage: self.length * at.w });
            }
            at += self.step;
        }
    }

    /// [`Line::row`] for each of a number of rows across the width; `aside` is the step from one row to the next.
    #[cold]
    fn rows(self, rows: f32, aside: Vec2, take: &mut impl FnMut(Piece)) {
        let mut at = self.at;
        for _ in 0..self.pieces {
            for row in 0..rows as usize {
                let place = Vec2::new(at.x, at.y) + aside * (at.w * (row as f32 + 0.5 - 0.5 * rows));
                if is_within(place, self.size as f32) {
                    let texel = place.y as usize * stride(self.size) + place.x as usize;
                    take(Piece { texel, depth: at.z, coverage: self.length * at.w / rows });
                }
            }
            at += self.step;
        }
    }
}

/// True if texel coordinates lie in the map.
#[inline]
fn is_within(place: Vec2, limit: f32) -> bool {
    place.x >= 0.0 && place.y >= 0.0 && place.x < limit && place.y < limit
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coverage of each texel by a segment.
    fn covered(width: f32) -> Vec<f32> {
        let mut texels = vec![0.0; 64 * stride(64)];
        let ends = [Vec3::new(20.0, 20.0, 1.0), Vec3::new(44.0, 38.0, 1.0)];
        cut((ends[0], width), (ends[1], width), 64, &|_| 1.0, &mut |piece: Piece| {
            texels[piece.texel] += piece.coverage
        });
        texels
    }

    #[test]
    fn wide_hair_covers_texels_beside_its_middle() {
        for width in [0.3, 1.9, 2.1, 8.0, 15.0] {
            let texels = covered(width);
            let (sum, most) = (texels.iter().sum::<f32>(), texels.iter().copied().fold(0.0, f32::max));
            assert!((sum - 30.0 * width).abs() < 1e-3 * sum, "{width}: {sum}");
            // Pieces of one row and of the next that fall into one texel; below two texels all lie on the middle.
            assert!(most < if width > WIDE { 2.6 } else { 4.0 }, "{width}: {most}");
            let touched = texels.iter().filter(|share| **share > 0.0).count();
            // Pieces of a row step over corners of texels.
            assert!(width < WIDE || touched as f32 > 0.7 * sum, "{width}: {touched} of {sum}");
        }
    }
}
