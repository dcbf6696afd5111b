//! Sorts things into the tiles that they touch, keeping their order.

use strandline_base::par::prelude::*;

use crate::frame::samples::{Samples, TILE};

/// Things handled together by one thread. Fixed, so that nothing depends on the number of threads.
const CHUNK: usize = 16_384;

/// Tiles that a thing touches: columns `x0..=x1`, rows `y0..=y1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRect {
    /// First column.
    pub x0: u16,
    /// First row.
    pub y0: u16,
    /// Last column.
    pub x1: u16,
    /// Last row.
    pub y1: u16,
}

impl TileRect {
    /// The tiles under a box \[sample\]; `None` when it lies outside the picture or is not finite.
    pub fn of_box(samples: &Samples, min: [f32; 2], max: [f32; 2]) -> Option<Self> {
        let (width, height) = (samples.width() as f32, samples.height() as f32);
        // Written so that a NaN fails.
        let inside = max[0] > 0.0 && max[1] > 0.0 && min[0] < width && min[1] < height;
        if !(inside && min[0] <= max[0] && min[1] <= max[1]) {
            return None;
        }
        let tile = |at: f32, size: f32| (at.clamp(0.0, size - 1.0) as usize / TILE) as u16;
        Some(Self {
            x0: tile(min[0], width),
            y0: tile(min[1], height),
            x1: tile(max[0], width),
            y1: tile(max[1], height),
        })
    }

    fn for_each_tile(&self, columns: usize, mut visit: impl FnMut(usize)) {
        for y in self.y0..=self.y1 {
            (self.x0..=self.x1).for_each(|x| visit(usize::from(y) * columns + usize::from(x)));
        }
    }
}

/// For each tile the things that touch it, in their own order. Kept as one list for each run of
/// [`CHUNK`] things: the runs are filled in parallel and read one after the other.
#[derive(Debug, Default)]
pub struct Tiles {
    runs: Vec<Run>,
    used: usize,
}

#[derive(Debug, Default)]
struct Run {
    rects: Vec<Option<(TileRect, u32)>>,
    starts: Vec<u32>,
    things: Vec<u32>,
}

impl Tiles {
    /// Sorts the things `0..count` into tiles by the rectangle that `rect` gives for each, beside the
    /// number by which the thing is listed.
    pub fn fill(
        &mut self,
        samples: &Samples,
        count: usize,
        rect: impl Fn(usize) -> Option<(TileRect, u32)> + Sync,
    ) {
        self.used = count.div_ceil(CHUNK);
        if self.runs.len() < self.used {
            self.runs.resize_with(self.used, Run::default);
        }
        self.runs[..self.used].par_iter_mut().enumerate().for_each(|(index, run)| {
            let first = index * CHUNK;
            run.rects.clear();
            run.rects.extend((first..count.min(first + CHUNK)).map(&rect));
            run.sort(samples.tile_columns(), samples.tile_count());
        });
    }

    /// The things that touch a tile, in their order.
    pub fn things(&self, tile: usize) -> impl Iterator<Item = u32> + '_ {
        self.runs[..self.used]
            .iter()
            .flat_map(move |run| &run.things[run.starts[tile] as usize..run.starts[tile + 1] as usize])
            .copied()
    }
}

impl Run {
    /// A counting sort: starts hold counts first, then the end of each tile's list, then its start.
    fn sort(&mut self, columns: usize, tile_count: usize) {
        self.starts.clear();
        self.starts.resize(tile_count + 1, 0);
        let Self { rects, starts, things } = self;
        for (rect, _) in rects.iter().flatten() {
            rect.for_each_tile(columns, |tile| starts[tile] += 1);
        }
        let mut total = 0;
        for start in starts.iter_mut() {
            total += *start;
            *start = total;
        }
        things.clear();
        things.resize(total as usize, 0);
        // Backwards, so that each list ends up in order.
        for (rect, thing) in rects.iter().flatten().rev() {
            rect.for_each_tile(columns, |tile| {
                starts[tile] -= 1;
                things[starts[tile] as usize] = *thing;
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tile_lists_what_touches_it_in_order() {
        let mut samples = Samples::default();
        samples.resize(100, 70);
        let count = CHUNK + 50;
        let rect = |thing: usize| {
            let (x, y) = ((thing * 37 % 140) as f32 - 20.0, (thing * 91 % 100) as f32 - 20.0);
            TileRect::of_box(&samples, [x, y], [x + 30.0, y + 10.0])
        };
        let mut tiles = Tiles::default();
        tiles.fill(&samples, count, |thing| Some((rect(thing)?, thing as u32)));
        for row in 0..samples.tile_rows() as u16 {
            for column in 0..samples.tile_columns() as u16 {
                let expected = (0..count as u32).filter(|&thing| {
                    rect(thing as usize).is_some_and(|rect| {
                        (rect.x0..=rect.x1).contains(&column) && (rect.y0..=rect.y1).contains(&row)
                    })
                });
                let tile = usize::from(row) * samples.tile_columns() + usize::from(column);
                assert!(tiles.things(tile).eq(expected));
            }
        }
        tiles.fill(&samples, 0, |_| None);
        assert_eq!(tiles.things(0).count(), 0);
    }

    #[test]
    fn boxes_outside_and_boxes_that_are_not_finite_touch_nothing() {
        let mut samples = Samples::default();
        samples.resize(100, 70);
        assert_eq!(TileRect::of_box(&samples, [-5.0, 0.0], [-1.0, 9.0]), None);
        assert_eq!(TileRect::of_box(&samples, [f32::NAN, 0.0], [1.0, 9.0]), None);
        let all = TileRect::of_box(&samples, [-1e30, -1e30], [f32::INFINITY, 1e30]);
        assert_eq!(all, Some(TileRect { x0: 0, y0: 0, x1: 3, y1: 2 }));
    }
}
