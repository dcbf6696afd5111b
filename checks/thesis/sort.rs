//! The worked example of figures 28 to 30: points sorted by cell \[Chen2011\].

use strandline_sim::cells::CellSort;

/// Cell of each point, 4 x 3 x 1 cells.
const CELLS: [u32; 6] = [9, 6, 6, 4, 6, 4];

#[test]
fn the_worked_example_comes_out_exactly() {
    let mut sort = CellSort::new(12);
    sort.sort(&CELLS);
    assert_eq!(sort.order(), [3, 5, 1, 2, 4, 0]);
    assert_eq!(
        sort.order().iter().map(|&point| CELLS[point as usize]).collect::<Vec<_>>(),
        [4, 4, 6, 6, 6, 9]
    );
    assert_eq!(sort.start_index(), [6, 6, 6, 6, 0, 6, 2, 6, 6, 5, 6, 6]);
}

#[test]
fn the_comparison_can_fail() {
    let mut sort = CellSort::new(12);
    sort.sort(&[9, 6, 6, 4, 6, 5]);
    assert_ne!(sort.start_index(), [6, 6, 6, 6, 0, 6, 2, 6, 6, 5, 6, 6]);
}
