//! The least depths of a map's blocks: most of what rays to a light cross holds nothing before them, which one look per
//! block tells as exactly as four at texels.

use strandline_base::par::prelude::*;

/// Depth \[m\] of a texel that holds nothing.
pub(crate) const NOTHING: f32 = 1e30;
/// Texels along a side of a block, as a power of two.
const SHIFT: usize = 3;

/// Least depths \[m\] of blocks of a square map, each with the texels behind its last row and column, so that the four
/// about any place in it are in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nearest {
    columns: usize,
    least: Vec<f32>,
}

impl Nearest {
    /// Takes the depths of a map of so many texels along each side.
    pub(crate) fn take(&mut self, size: usize, depth: impl Fn(usize) -> f32 + Sync) {
        self.columns = size.div_ceil(1 << SHIFT);
        self.least.clear();
        self.least.resize(self.columns * self.columns, NOTHING);
        let reach = |block: usize| block << SHIFT..(((block + 1) << SHIFT) + 1).min(size);
        self.least.par_chunks_mut(self.columns.max(1)).enumerate().for_each(|(down, row)| {
            for (across, least) in row.iter_mut().enumerate() {
                let places = reach(down).flat_map(|row| reach(across).map(move |column| row * size + column));
                *least = places.map(&depth).fold(NOTHING, f32::min);
            }
        });
    }

    /// The least depth \[m\] of the four texels of which the first is given, and of some beside them.
    #[inline]
    pub(crate) fn about(&self, [column, row]: [usize; 2]) -> f32 {
        self.least[(row >> SHIFT) * self.columns + (column >> SHIFT)]
    }
}

#[cfg(test)]
mod tests {
    use strandline_base::Random;

    use super::*;

    #[test]
    fn no_texel_of_four_lies_before_what_their_block_says_and_blocks_are_small() {
        for size in [1, 8, 16, 30, 33] {
            let mut random = Random::new(9, size as u64);
            let depths: Vec<f32> = (0..size * size).map(|_| random.unit()).collect();
            let mut nearest = Nearest::default();
            nearest.take(size, |texel| depths[texel]);
            for (row, column) in (0..size - 1).flat_map(|row| (0..size - 1).map(move |column| (row, column)))
            {
                let four = [(0, 0), (0, 1), (1, 0), (1, 1)];
                let least = four.map(|(down, right)| depths[(row + down) * size + column + right]);
                assert!(nearest.about([column, row]) <= least.into_iter().fold(NOTHING, f32::min));
            }
        }
        // A texel is told of by its own block and by those before it alone.
        let mut nearest = Nearest::default();
        nearest.take(32, |texel| if texel == 16 * 32 + 16 { 1.0 } else { NOTHING });
        let blocks = (0..4).flat_map(|row| (0..4).map(move |column| [8 * column, 8 * row]));
        assert_eq!(blocks.filter(|&block| nearest.about(block) == 1.0).count(), 4);
    }
}
