//! The least depths of a map's blocks: most of what rays to a light cross holds nothing before them, which one look per
//! block tells as exactly as four at texels.

use glam::Vec2;
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
    /// Squares of four blocks, squares of four of these and so on, up to one.
    squares: Vec<Vec<f32>>,
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
        self.join();
    }

    /// Joins blocks to squares.
    fn join(&mut self) {
        self.squares.clear();
        let mut columns = self.columns;
        while columns > 1 {
            let (below, side) = (self.squares.last().unwrap_or(&self.least), columns.div_ceil(2));
            let square = |index: usize| {
                let reach = |at: usize| 2 * at..(2 * at + 2).min(columns);
                let of_row = |row: usize| reach(index % side).map(move |column| row * columns + column);
                reach(index / side).flat_map(of_row).map(|at| below[at]).fold(NOTHING, f32::min)
            };
            let joined = (0..side * side).map(square).collect();
            self.squares.push(joined);
            columns = side;
        }
    }

    /// The least depth \[m\] of all texels.
    pub(crate) fn least(&self) -> f32 {
        self.squares.last().unwrap_or(&self.least).first().copied().unwrap_or(NOTHING)
    }

    /// No more than the least depth \[m\] of the four texels about every place, the first of which lies between two corners
    /// \[texel\]; [`NOTHING`] beside the map.
    pub(crate) fn within(&self, min: Vec2, max: Vec2) -> f32 {
        let side = (self.columns << SHIFT) as f32;
        if !(max.cmpge(Vec2::ZERO).all() && min.cmplt(Vec2::splat(side)).all()) {
            return NOTHING;
        }
        let block = |at: f32| (at.clamp(0.0, side - 1.0) as usize) >> SHIFT;
        let [columns, rows] = [[block(min.x), block(max.x)], [block(min.y), block(max.y)]];
        let apart = |[first, last]: [usize; 2], level: usize| (last >> level) - (first >> level);
        let is_fine = |level: &usize| apart(columns, *level).max(apart(rows, *level)) <= 1;
        let level = (0..self.squares.len()).find(is_fine).unwrap_or(self.squares.len());
        let least = if level == 0 { &self.least } else { &self.squares[level - 1] };
        let width = self.columns.div_ceil(1 << level);
        let reach = |[first, last]: [usize; 2]| first >> level..=last >> level;
        let at = reach(rows).flat_map(|row| reach(columns).map(move |column| row * width + column));
        at.map(|at| least[at]).fold(NOTHING, f32::min)
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
        // A texel is told of wherever a box holds a place about it.
        for size in [8, 30, 100] {
            let mut random = Random::new(4, size as u64);
            let mut nearest = Nearest::default();
            let depths: Vec<f32> = (0..size * size).map(|_| random.unit()).collect();
            nearest.take(size, |texel| depths[texel]);
            let corner = |random: &mut Random| Vec2::new(random.unit(), random.unit()) * 1.4 - 0.2;
            for _ in 0..300 {
                let (a, b) = (corner(&mut random) * size as f32, corner(&mut random) * size as f32);
                let (min, max) = (a.min(b), a.max(b));
                let is_in = |texel: &usize| {
                    let place = Vec2::new((texel % size) as f32, (texel / size) as f32);
                    place.cmpge(min.floor()).all() && place.cmple(max).all()
                };
                let least = (0..size * size).filter(is_in).map(|texel| depths[texel]);
                assert!(nearest.within(min, max) <= least.fold(NOTHING, f32::min), "{size} {min} {max}");
            }
            assert_eq!(nearest.within(Vec2::splat(-9.0), Vec2::splat(-1.0)), NOTHING);
            let all = depths.iter().copied().fold(NOTHING, f32::min);
            assert_eq!([nearest.within(Vec2::ZERO, Vec2::MAX), nearest.least()], [all; 2]);
        }
        // A texel is told of by its own block and by those before it alone.
        let mut nearest = Nearest::default();
        nearest.take(32, |texel| if texel == 16 * 32 + 16 { 1.0 } else { NOTHING });
        let blocks = (0..4).flat_map(|row| (0..4).map(move |column| [8 * column, 8 * row]));
        assert_eq!(blocks.filter(|&block| nearest.about(block) == 1.0).count(), 4);
    }
}
