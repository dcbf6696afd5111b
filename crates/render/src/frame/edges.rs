//! Edges of the body, smooth between samples.
//!
//! The body fills whole samples, so that a slanted outline is a staircase of them. Each step of it is followed to both of
//! its ends \[Reshetov2009\]: the outline runs from half a sample beside the step at one end, over its middle, to
//! half a sample beside it at the other. A sample takes what this line cuts off it from the sample beyond.

use glam::Vec4;
use strandline_base::par::prelude::*;

use super::samples::{Samples, TILE};

/// Two samples show surfaces that are apart if their inverse depths differ by this share of the nearer one.
const APART: f32 = 0.01;
/// Samples that a step is followed to either side.
const STEP_REACH: i32 = 16;

/// Ways from a sample to those beside it.
const SIDES: [(i32, i32); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];

/// Blends samples at edges of the body with those beyond, by the share of them that lies beyond.
pub(crate) fn smooth_edges(samples: &mut Samples) {
    let found: Vec<(usize, Vec4)> = {
        let edges = Edges { samples };
        let ranges: Vec<[f32; 2]> = (0..samples.tile_count()).map(|tile| edges.range(tile)).collect();
        let tiles = (0..samples.tile_count()).into_par_iter().filter(|tile| edges.differs(*tile, &ranges));
        tiles.flat_map_iter(|tile| edges.blended(tile)).collect()
    };
    for (index, color) in found {
        samples.colors[index] = color;
    }
}

/// Samples before they are blended.
#[derive(Clone, Copy)]
struct Edges<'a> {
    samples: &'a Samples,
}

impl<'a> Edges<'a> {
    /// Least and greatest inverse depth of a tile.
    fn range(self, tile: usize) -> [f32; 2] {
        let depths = self.samples.inverse_depths.chunks_exact(TILE * TILE).nth(tile).unwrap_or(&[]);
        depths.iter().fold([f32::MAX, 0.0], |[low, high], &depth| [low.min(depth), high.max(depth)])
    }

    /// True if a tile and those about it may hold surfaces that are apart.
    fn differs(self, tile: usize, ranges: &[[f32; 2]]) -> bool {
        let (columns, rows) = (self.samples.tile_columns() as i32, self.samples.tile_rows() as i32);
        let (column, row) = (tile as i32 % columns, tile as i32 / columns);
        let beside = SIDES.iter().chain([&(0, 0)]).filter_map(|(x, y)| {
            let (x, y) = (column + x, row + y);
            let is_inside = (0..columns).contains(&x) && (0..rows).contains(&y);
            is_inside.then(|| ranges[(y * columns + x) as usize])
        });
        let [low, high] =
            beside.fold([f32::MAX, 0.0_f32], |all, one| [all[0].min(one[0]), all[1].max(one[1])]);
        are_apart(low, high)
    }

    /// Samples of a tile that change: their index and new colour.
    fn blended(self, tile: usize) -> impl Iterator<Item = (usize, Vec4)> + 'a {
        let columns = self.samples.tile_columns();
        let (left, top) = (tile % columns * TILE, tile / columns * TILE);
        let (right, end) = ((left + TILE).min(self.samples.width()), (top + TILE).min(self.samples.height()));
        (top..end).flat_map(move |row| (left..right).map(move |column| (column, row))).filter_map(
            move |(column, row)| {
                let (share, beyond) = self.beyond(column as i32, row as i32)?;
                let color = |(x, y): (i32, i32)| self.samples.color(x as usize, y as usize);
                let own = color((column as i32, row as i32));
                Some((self.samples.index(column, row), own + (color(beyond) - own) * share))
            },
        )
    }

    /// Inverse depth at a place, the outermost one beyond the picture.
    fn depth(self, (x, y): (i32, i32)) -> f32 {
        let inside = |at: i32, count: usize| at.clamp(0, count as i32 - 1) as usize;
        let (width, height) = (self.samples.width(), self.samples.height());
        self.samples.inverse_depths[self.samples.index(inside(x, width), inside(y, height))]
    }

    /// Share of a sample that belongs to a surface beside it, and the sample that shows that one.
    fn beyond(self, x: i32, y: i32) -> Option<(f32, (i32, i32))> {
        let own = self.depth((x, y));
        let mut most = (0.0, (x, y));
        for (right, down) in SIDES {
            let other = (x + right, y + down);
            if are_apart(own, self.depth(other)) {
                let [first, last] =
                    [-1, 1].map(|way| self.end((x, y), other, (way * down.abs(), way * right.abs())));
                let share = cut_off(first, last);
                if share > most.0 {
                    most = (share, other);
                }
            }
        }
        (most.0 > 0.0).then_some(most)
    }

    /// The end of a step between a sample and the one beyond, in a direction along it: its distance \[sample\], and how far
    /// the outline lies there on the sample's side of the step.
    fn end(self, own: (i32, i32), beyond: (i32, i32), way: (i32, i32)) -> [f32; 2] {
        let at = |(x, y): (i32, i32), step: i32| self.depth((x + step * way.0, y + step * way.1));
        let mut last = [at(own, 0), at(beyond, 0)];
        for step in 1..=STEP_REACH {
            let next = [at(own, step), at(beyond, step)];
            let [crossed, crossed_beyond] = [0, 1].map(|side| are_apart(last[side], next[side]));
            if crossed || crossed_beyond || !are_apart(next[0], next[1]) {
                let aside = 0.5 * (f32::from(u8::from(crossed)) - f32::from(u8::from(crossed_beyond)));
                return [step as f32 - 0.5, aside];
            }
            last = next;
        }
        [STEP_REACH as f32 + 0.5, 0.0]
    }
}

/// True for inverse depths of surfaces that are apart.
fn are_apart(first: f32, second: f32) -> bool {
    (first - second).abs() > APART * first.max(second)
}

/// Share of a sample that an outline cuts off, by the two ends of its step: distance \[sample\] and offset.
fn cut_off([before, low]: [f32; 2], [after, high]: [f32; 2]) -> f32 {
    // Places along the step from its first end, over half of its length.
    let half = 0.5 * (before + after);
    let (start, end) = ((before - 0.5) / half, (before + 0.5) / half);
    // Offsets of the two halves of the outline: from `low` to 0, from 0 to `high`.
    let first = [low * (1.0 - start.min(1.0)), low * (1.0 - end.min(1.0))];
    let second = [high * (start.max(1.0) - 1.0), high * (end.max(1.0) - 1.0)];
    let inner = (1.0 - start).clamp(0.0, end - start) / (end - start);
    (mean_above(first) * inner + mean_above(second) * (1.0 - inner)).min(0.5)
}

/// Mean of what lies above 0 of a straight line between two values of one sign.
fn mean_above([from, to]: [f32; 2]) -> f32 {
    0.5 * (from.max(0.0) + to.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::samples::NO_TRIANGLE;

    /// Samples that show a white surface where a place \[sample\] is inside, over black.
    fn drawn(size: usize, inside: impl Fn(f32, f32) -> bool) -> Samples {
        let mut samples = Samples::default();
        samples.resize(size, size);
        for row in 0..size {
            for column in 0..size {
                let index = samples.index(column, row);
                let shows = inside(column as f32 + 0.5, row as f32 + 0.5);
                samples.inverse_depths[index] = if shows { 1.0 } else { 0.0 };
                samples.triangles[index] = if shows { 0 } else { NO_TRIANGLE };
                samples.colors[index] = if shows { Vec4::ONE } else { Vec4::W };
            }
        }
        samples
    }

    /// Root mean square of the error of samples about an outline, against the share of each that is inside.
    fn error(samples: &Samples, size: usize, inside: &impl Fn(f32, f32) -> bool) -> f32 {
        let (mut sum, mut count) = (0.0, 0.0);
        for row in 2..size - 2 {
            for column in 2..size - 2 {
                let part = |at: usize| (at as f32 + 0.5) / 16.0;
                let shown = (0..256).filter(|part_of| {
                    inside(column as f32 + part(part_of % 16), row as f32 + part(part_of / 16))
                });
                let share = shown.count() as f32 / 256.0;
                let found = samples.color(column, row).x;
                if share > 0.0 && share < 1.0 {
                    sum += (found - share).powi(2);
                    count += 1.0;
                } else {
                    assert!((found - share).abs() < 0.26, "{column} {row}: {found} {share}");
                }
            }
        }
        (sum / f32::max(count, 1.0)).sqrt()
    }

    #[test]
    fn outlines_of_every_slope_are_covered_as_they_lie() {
        let size = 96;
        for degrees in [2.0_f32, 5.0, 11.0, 20.0, 31.0, 45.0, 60.0, 83.0, 100.0, 170.0, 200.0, 290.0] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let inside = |x: f32, y: f32| (x - 47.3) * sine + (y - 48.1) * cosine > 0.0;
            let mut samples = drawn(size, inside);
            let stepped = error(&samples, size, &inside);
            smooth_edges(&mut samples);
            let smooth = error(&samples, size, &inside);
            assert!(smooth < 0.1 && smooth < 0.45 * stepped, "{degrees}: {smooth} {stepped}");
        }
    }

    #[test]
    fn a_disc_keeps_its_area_and_what_is_flat_its_bits() {
        let size = 100;
        let inside = |x: f32, y: f32| (x - 50.2).hypot(y - 49.7) < 33.4;
        let mut samples = drawn(size, inside);
        let stepped = error(&samples, size, &inside);
        smooth_edges(&mut samples);
        assert!(error(&samples, size, &inside) < 0.5 * stepped);
        let sum: f32 = (0..size * size).map(|at| samples.color(at % size, at / size).x).sum();
        let area = std::f32::consts::PI * 33.4 * 33.4;
        assert!((sum / area - 1.0).abs() < 2e-3, "{sum} {area}");
        // A slope of one surface, and an edge along a row, have nothing to smooth.
        let mut even = drawn(size, |_, y| y > 40.0);
        for row in 41..size {
            for column in 0..size {
                let index = even.index(column, row);
                even.inverse_depths[index] = 1.0 + 0.005 * column as f32;
            }
        }
        let before = even.colors.clone();
        smooth_edges(&mut even);
        assert_eq!(before, even.colors);
    }
}
