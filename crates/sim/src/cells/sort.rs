//! Points sorted by cell, a counting sort [Chen2011 fig. 26, 28-30].

use super::grid::NO_CELL;
use super::set::CellSet;

/// Points sorted by the cell that holds them; points of one cell keep their order.
///
/// One serial pass counts and one places, a few nanoseconds a point; everything else costs by
/// occupied cell, not by cell of the box.
#[derive(Clone, Debug)]
pub struct CellSort {
    start_index: Vec<u32>,
    order: Vec<u32>,
    occupied: CellSet,
    cells: Vec<u32>,
    starts: Vec<u32>,
    /// Points counted in a cell, then where its next point goes; all 0 between sorts.
    cursor: Vec<u32>,
    point_count: u32,
}

impl CellSort {
    /// An empty sort over `cell_count` cells.
    pub fn new(cell_count: usize) -> Self {
        Self {
            start_index: vec![0; cell_count],
            order: Vec::new(),
            occupied: CellSet::new(cell_count),
            cells: Vec::new(),
            starts: vec![0],
            cursor: vec![0; cell_count],
            point_count: 0,
        }
    }

    /// Sorts points by cell; those in [`NO_CELL`] are left out.
    pub fn sort(&mut self, cell_of_point: &[u32]) {
        self.occupied.clear();
        let mut point_count = 0;
        for &cell in cell_of_point {
            if cell != NO_CELL {
                self.cursor[cell as usize] += 1;
                self.occupied.insert(cell as usize);
                point_count += 1;
            }
        }
        self.forget(point_count);
        self.occupied.list_into(&mut self.cells);
        self.starts.clear();
        let mut start = 0;
        for &cell in &self.cells {
            let cell = cell as usize;
            self.start_index[cell] = start;
            self.starts.push(start);
            start += std::mem::replace(&mut self.cursor[cell], start);
        }
        self.starts.push(start);
        self.order.resize(point_count as usize, 0);
        for (point, &cell) in cell_of_point.iter().enumerate() {
            if cell != NO_CELL {
                let slot = &mut self.cursor[cell as usize];
                self.order[*slot as usize] = point as u32;
                *slot += 1;
            }
        }
        for &cell in &self.cells {
            self.cursor[cell as usize] = 0;
        }
    }

    /// Marks every cell empty: `start_index` is the number of points there.
    fn forget(&mut self, point_count: u32) {
        if point_count == self.point_count {
            for &cell in &self.cells {
                self.start_index[cell as usize] = point_count;
            }
        } else {
            self.start_index.fill(point_count);
            self.point_count = point_count;
        }
    }

    /// Indices of the points, sorted by cell.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Per cell: place in [`Self::order`] of its first point, or the number of sorted points when
    /// the cell is empty [Chen2011 fig. 26].
    pub fn start_index(&self) -> &[u32] {
        &self.start_index
    }

    /// The cells that hold points, as a set.
    pub fn occupied(&self) -> &CellSet {
        &self.occupied
    }

    /// The cells that hold points, ascending.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// Points of the `index`-th occupied cell.
    #[inline]
    pub fn points_of(&self, index: usize) -> &[u32] {
        &self.order[self.starts[index] as usize..self.starts[index + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_sort_forgets_the_first() {
        let mut sort = CellSort::new(10);
        sort.sort(&[3, 1, 3]);
        assert_eq!(sort.order(), [1, 0, 2]);
        sort.sort(&[7, NO_CELL, 2, 7]);
        assert_eq!(sort.cells(), [2, 7]);
        assert_eq!(sort.points_of(1), [0, 3]);
        assert_eq!(sort.start_index(), [3, 3, 0, 3, 3, 3, 3, 1, 3, 3]);
        sort.sort(&[]);
        assert!(sort.cells().is_empty() && sort.order().is_empty());
        assert_eq!(sort.start_index(), [0; 10]);
    }
}
