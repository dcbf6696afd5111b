//! The samples of a picture, tile by tile: what `draw` fills and `resolve` reads.

use glam::Vec4;

/// Width and height of a tile \[sample\]: its colours (16 KiB) stay in the first-level cache.
pub const TILE: usize = 32;
/// Samples in a tile.
pub const TILE_SAMPLES: usize = TILE * TILE;
/// Largest ratio of the memory of a picture to that of the picture before it.
const SPARE: usize = 2;
/// The triangle of a sample that shows no body.
pub const NO_TRIANGLE: u32 = u32::MAX;

/// The body in samples.
#[derive(Clone, Copy, Debug)]
pub struct BodySamples<'a> {
    /// Width and height \[sample\].
    size: [usize; 2],
    columns: usize,
    inverse_depths: &'a [f32],
    triangles: &'a [u32],
}

impl<'a> BodySamples<'a> {
    /// One over the view depths \[1/m\] and the triangles of a tile.
    pub fn tile(&self, tile: usize) -> (&'a [f32], &'a [u32]) {
        let samples = tile * TILE_SAMPLES..(tile + 1) * TILE_SAMPLES;
        (&self.inverse_depths[samples.clone()], &self.triangles[samples])
    }

    /// Column and row of the first sample of a tile.
    pub fn corner(&self, tile: usize) -> [usize; 2] {
        [tile % self.columns * TILE, tile / self.columns * TILE]
    }

    /// Triangle and one over the view depth \[1/m\] of a sample; `None` where there is no body, and beside the picture.
    pub fn at(&self, [column, row]: [usize; 2]) -> Option<(u32, f32)> {
        if column >= self.size[0] || row >= self.size[1] {
            return None;
        }
        let index = index(self.columns, column, row);
        let triangle = self.triangles[index];
        (triangle != NO_TRIANGLE).then(|| (triangle, self.inverse_depths[index]))
    }
}

/// Index of a sample among so many columns of tiles.
fn index(columns: usize, column: usize, row: usize) -> usize {
    (row / TILE * columns + column / TILE) * TILE_SAMPLES + row % TILE * TILE + column % TILE
}

/// Samples, stored tile after tile, rows inside a tile: shape `[tile row][tile column][row][column]`.
/// Tiles at the right and lower edges are stored whole.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    width: usize,
    height: usize,
    columns: usize,
    rows: usize,
    /// Radiance, linear RGB, times opacity; opacity last.
    pub colors: Vec<Vec4>,
    /// One over the view depth \[1/m\] of the body, 0 where there is none.
    pub inverse_depths: Vec<f32>,
    /// The body's triangle, `NO_TRIANGLE` where there is none.
    pub triangles: Vec<u32>,
}

impl Samples {
    /// Takes a new size \[sample\]; keeps its memory when that suffices, unless it is more than twice as much: a window
    /// that was large once has hundreds of MB.
    pub fn resize(&mut self, width: usize, height: usize) {
        if self.colors.capacity() > SPARE * width.div_ceil(TILE) * height.div_ceil(TILE) * TILE_SAMPLES {
            *self = Self::default();
        }
        self.width = width;
        self.height = height;
        self.columns = width.div_ceil(TILE);
        self.rows = height.div_ceil(TILE);
        let count = self.tile_count() * TILE_SAMPLES;
        self.colors.resize(count, Vec4::ZERO);
        self.inverse_depths.resize(count, 0.0);
        self.triangles.resize(count, NO_TRIANGLE);
    }

    /// Width \[sample\].
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height \[sample\].
    pub fn height(&self) -> usize {
        self.height
    }

    /// Tiles across.
    pub fn tile_columns(&self) -> usize {
        self.columns
    }

    /// Tiles down.
    pub fn tile_rows(&self) -> usize {
        self.rows
    }

    /// Number of tiles.
    pub fn tile_count(&self) -> usize {
        self.columns * self.rows
    }

    /// Index of a sample.
    pub fn index(&self, column: usize, row: usize) -> usize {
        index(self.columns, column, row)
    }

    /// The colours, to be filled, and the body that is drawn.
    pub fn parts(&mut self) -> (&mut [Vec4], BodySamples<'_>) {
        let Self { width, height, columns, .. } = *self;
        let Self { colors, inverse_depths, triangles, .. } = self;
        (colors, BodySamples { size: [width, height], columns, inverse_depths, triangles })
    }

    /// Radiance times opacity, and opacity, of a sample.
    pub fn color(&self, column: usize, row: usize) -> Vec4 {
        self.colors[self.index(column, row)]
    }

    /// The colours of one row \[sample\], tile by tile.
    pub fn row(&self, row: usize) -> impl Iterator<Item = &[Vec4]> {
        let start = row / TILE * self.columns * TILE_SAMPLES + row % TILE * TILE;
        (0..self.columns).map(move |column| {
            let length = TILE.min(self.width - column * TILE);
            &self.colors[start + column * TILE_SAMPLES..][..length]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_memory_of_a_picture_that_was_far_larger_is_given_back() {
        let mut samples = Samples::default();
        samples.resize(2000, 2000);
        let large = samples.colors.capacity();
        samples.resize(1500, 1500);
        assert_eq!(samples.colors.capacity(), large);
        samples.resize(640, 400);
        assert!(samples.colors.capacity() < large / 8 && samples.colors.len() == 20 * 13 * TILE_SAMPLES);
        assert!(samples.triangles.capacity() < large / 8 && samples.inverse_depths.capacity() < large / 8);
    }
}
