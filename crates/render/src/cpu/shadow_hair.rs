//! Walks strands through a light's texels.

use std::ops::Range;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::Strands;
use super::shadow::{LightView, Window};

/// Most parts that the strands are shared out to; each part fills a map of its own.
const MOST_PARTS: usize = 8;
/// Width \[texel\] above which hair is laid out in rows, and the most of them.
const WIDE: f32 = 2.0;
const MOST_ROWS: f32 = 256.0;
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
/// hands each to `take`; hair of more than two texels' width in rows no wider than a texel. The pieces of a segment
/// cover width times length, whatever the map's size.
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
    let widest = start.1.max(end.1);
    let rows = if widest > WIDE && length > 0.0 { widest.min(MOST_ROWS).ceil() } else { 1.0 };
    let aside = if rows > 1.0 { way.truncate().perp().normalize_or_zero() / rows } else { Vec2::ZERO };
    for _ in 0..pieces {
        for row in 0..rows as usize {
            let place = at.truncate() + aside * (width * (row as f32 + 0.5 - 0.5 * rows));
            if place.x >= 0.0 && place.y >= 0.0 && place.x < limit && place.y < limit {
                take(Piece {
                    texel: place.y as usize * size + place.x as usize,
                    depth: at.z,
                    coverage: length * width / rows,
                    width,
                });
            }
        }
        at += step;
        width += widening;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a segment covers of each texel.
    fn covered(width: f32) -> Vec<f32> {
        let mut texels = vec![0.0; 64 * 64];
        let ends = [Vec3::new(20.0, 20.0, 1.0), Vec3::new(44.0, 38.0, 1.0)];
        cut((ends[0], width), (ends[1], width), 64, &mut |piece: Piece| {
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
