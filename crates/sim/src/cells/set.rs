//! A set of cells, one bit each: what hair occupies and the cells around it.

/// A set of cells of a grid with a ring, as bits in index order.
#[derive(Clone, Debug, Default)]
pub struct CellSet {
    words: Vec<u64>,
}

impl CellSet {
    /// An empty set over `cell_count` cells.
    pub fn new(cell_count: usize) -> Self {
        Self { words: vec![0; cell_count.div_ceil(64)] }
    }

    /// Takes every cell out.
    pub fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Puts a cell in.
    #[inline]
    pub fn insert(&mut self, cell: usize) {
        self.words[cell / 64] |= 1 << (cell % 64);
    }

    /// Becomes a copy of another set.
    pub fn copy_from(&mut self, other: &Self) {
        self.words.copy_from_slice(&other.words);
    }

    /// Puts in the cells `stride` before and after each cell of another set. The ring keeps
    /// neighbours from wrapping into the next row.
    pub fn insert_neighbours(&mut self, other: &Self, stride: usize) {
        let (whole, bits) = (stride / 64, stride % 64);
        let count = self.words.len();
        for index in 0..count.saturating_sub(whole) {
            let word = other.words[index];
            if word == 0 {
                continue;
            }
            self.words[index + whole] |= word << bits;
            if bits > 0 && index + whole + 1 < count {
                self.words[index + whole + 1] |= word >> (64 - bits);
            }
        }
        for index in whole..count {
            let word = other.words[index];
            if word == 0 {
                continue;
            }
            self.words[index - whole] |= word >> bits;
            if bits > 0 && index > whole {
                self.words[index - whole - 1] |= word << (64 - bits);
            }
        }
    }

    /// Takes out the cells of another set.
    pub fn remove_all(&mut self, other: &Self) {
        for (word, other) in self.words.iter_mut().zip(&other.words) {
            *word &= !other;
        }
    }

    /// Replaces `cells` by the cells of this set in ascending order.
    pub fn list_into(&self, cells: &mut Vec<u32>) {
        cells.clear();
        for (index, &word) in self.words.iter().enumerate() {
            let mut rest = word;
            while rest != 0 {
                cells.push(index as u32 * 64 + rest.trailing_zeros());
                rest &= rest - 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_by_any_stride() {
        let cells = [0_usize, 5, 63, 64, 127, 200, 299];
        let mut set = CellSet::new(300);
        cells.iter().for_each(|&cell| set.insert(cell));
        for stride in [1, 17, 64, 70, 128, 150] {
            let mut grown = CellSet::new(300);
            grown.insert_neighbours(&set, stride);
            let mut expected: Vec<u32> = cells
                .iter()
                .flat_map(|&cell| [cell.checked_sub(stride), Some(cell + stride)])
                .flatten()
                // The last word of the set has room for cells beyond the grid.
                .filter(|&cell| cell < 320)
                .map(|cell| cell as u32)
                .collect();
            expected.sort_unstable();
            expected.dedup();
            let mut found = Vec::new();
            grown.list_into(&mut found);
            assert_eq!(found, expected, "stride {stride}");
        }
    }

    #[test]
    fn removed_cells_are_gone() {
        let mut set = CellSet::new(130);
        [3, 70, 129].into_iter().for_each(|cell| set.insert(cell));
        let mut some = CellSet::new(130);
        some.insert(70);
        set.remove_all(&some);
        let mut found = Vec::new();
        set.list_into(&mut found);
        assert_eq!(found, [3, 129]);
    }
}
