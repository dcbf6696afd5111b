//! Depths beyond which everything is hidden.

use glam::Vec4;

use crate::frame::samples::TILE;

/// Width and height of a block of samples with one occluder depth.
pub(super) const BLOCK: usize = 16;
/// Blocks across a tile.
pub(super) const TILE_BLOCKS: usize = TILE / BLOCK;

/// For each block of samples the depth beyond which everything is hidden.
#[derive(Debug, Default)]
pub struct Occluders {
    columns: usize,
    rows: usize,
    /// One over view depth \[1/m\], shape `[tile][block row][block column]`.
    pub(super) blocks: Vec<f32>,
}

impl Occluders {
    pub(super) fn resize(&mut self, columns: usize, rows: usize) {
        self.columns = columns;
        self.rows = rows;
        self.blocks.resize(columns * rows * TILE_BLOCKS * TILE_BLOCKS, 0.0);
    }

    /// Forgets every block: nothing is hidden.
    pub fn clear(&mut self) {
        self.resize(0, 0);
    }

    /// True if a ribbon between two screen points is hidden everywhere.
    pub fn hide(&self, start: Vec4, end: Vec4) -> bool {
        if self.blocks.is_empty() {
            return false;
        }
        // A ribbon reaches half its drawn width to each side and is widened by half a sample.
        let reach = start.w.max(end.w).max(1.0) + 1.0;
        let block = |at: f32, count: usize| {
            (at.max(0.0) as usize / BLOCK).min((count * TILE_BLOCKS).saturating_sub(1))
        };
        let (low, high) = (start.min(end) - reach, start.max(end) + reach);
        let (x0, x1) = (block(low.x, self.columns), block(high.x, self.columns));
        let (y0, y1) = (block(low.y, self.rows), block(high.y, self.rows));
        // Long segments cross much: they are left to the test sample by sample.
        if (x1 - x0 + 1) * (y1 - y0 + 1) > 64 {
            return false;
        }
        let nearest = start.z.max(end.z);
        (y0..=y1).all(|y| (x0..=x1).all(|x| nearest < self.block(x, y)))
    }

    fn block(&self, x: usize, y: usize) -> f32 {
        let tile = y / TILE_BLOCKS * self.columns + x / TILE_BLOCKS;
        self.blocks[(tile * TILE_BLOCKS + y % TILE_BLOCKS) * TILE_BLOCKS + x % TILE_BLOCKS]
    }
}
