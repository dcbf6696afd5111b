//! LDL^T of a strand's system, from root to tip without pivoting: the unknowns of a node touch those of
//! the two nodes after it, so that a front of eleven rows moves along the strand.

use super::real::Real;

/// Unknowns of a node: a displacement and the angle of the segment above it.
pub const UNKNOWNS: usize = 4;
/// Unknowns that a joint touches: those of two nodes and the displacement of a third.
pub const ROWS: usize = 11;
const ENTRIES: usize = ROWS * (ROWS + 1) / 2;

/// Calls a method once for each row, with the row as a constant, so that its loops unroll.
macro_rules! for_rows {
    ($front:ident.$method:ident $(::<$column:ident>)? ($($argument:expr),*)) => {
        for_rows!(@ $front $method ($($column)?) ($($argument),*) 0 1 2 3 4 5 6 7 8 9 10)
    };
    (@ $front:ident $method:ident () $arguments:tt $($row:literal)*) => {
        $(for_rows!(! $front.$method::<$row> $arguments);)*
    };
    (@ $front:ident $method:ident ($column:ident) $arguments:tt $($row:literal)*) => {
        $(for_rows!(! $front.$method::<$column, $row> $arguments);)*
    };
    (! $front:ident.$method:ident::<$($constant:tt),*> ($($argument:expr),*)) => {
        $front.$method::<$($constant),*>($($argument),*)
    };
}

/// Position of a row and a column, row not above column, in the lower triangle of a front.
#[inline(always)]
const fn entry(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// What elimination leaves of a node, for the way back.
#[derive(Clone, Copy, Debug)]
pub struct Factors<R> {
    /// Entries below the diagonal of each column, by row.
    below: [[R; ROWS]; UNKNOWNS],
    solved: [R; UNKNOWNS],
}

impl<R: Real> Factors<R> {
    /// No factors.
    pub fn zero() -> Self {
        Self { below: [[R::of(0.0); ROWS]; UNKNOWNS], solved: [R::of(0.0); UNKNOWNS] }
    }
}

/// The rows at work: of the node that is eliminated next, and of what it touches.
pub struct Front<R> {
    entries: [R; ENTRIES],
    right: [R; ROWS],
}

impl<R: Real> Default for Front<R> {
    fn default() -> Self {
        Self { entries: [R::of(0.0); ENTRIES], right: [R::of(0.0); ROWS] }
    }
}

impl<R: Real> Front<R> {
    /// Adds `value` where `row` meets `column`, row not above column.
    #[inline(always)]
    pub fn add(&mut self, row: usize, column: usize, value: R) {
        self.entries[entry(row, column)] += value;
    }

    /// Adds to the right-hand side.
    #[inline(always)]
    pub fn add_right(&mut self, row: usize, value: R) {
        self.right[row] += value;
    }

    /// Adds the squares of three row vectors, each times its stiffness.
    #[inline(always)]
    pub fn add_squares(&mut self, vectors: &[[R; ROWS]; 3], stiffness: [R; 3]) {
        for_rows!(self.add_row(vectors, stiffness));
    }

    #[inline(always)]
    fn add_row<const ROW: usize>(&mut self, vectors: &[[R; ROWS]; 3], stiffness: [R; 3]) {
        let [a, b, c] = vectors;
        let (x, y, z) = (a[ROW] * stiffness[0], b[ROW] * stiffness[1], c[ROW] * stiffness[2]);
        for column in 0..=ROW {
            self.entries[entry(ROW, column)] += x * a[column] + y * b[column] + z * c[column];
        }
    }

    /// Eliminates the first four rows and moves the others up. `free` is 1 for unknowns that move and
    /// 0 for those that stay. Returns the smallest pivot of the free unknowns: not positive where the
    /// system is not positive definite.
    #[inline(always)]
    pub fn eliminate(&mut self, factors: &mut Factors<R>, free: [R; UNKNOWNS]) -> R {
        let mut smallest = R::of(f64::from(f32::MAX));
        let mut columns = [[R::of(0.0); ROWS]; UNKNOWNS];
        smallest = smallest.or_less(self.eliminate_column::<0>(factors, &mut columns[0], free[0]));
        smallest = smallest.or_less(self.eliminate_column::<1>(factors, &mut columns[1], free[1]));
        smallest = smallest.or_less(self.eliminate_column::<2>(factors, &mut columns[2], free[2]));
        smallest = smallest.or_less(self.eliminate_column::<3>(factors, &mut columns[3], free[3]));
        self.shift();
        smallest
    }

    #[inline(always)]
    fn eliminate_column<const COLUMN: usize>(
        &mut self,
        factors: &mut Factors<R>,
        whole: &mut [R; ROWS],
        free: R,
    ) -> R {
        let pivot = free.choose(self.entries[entry(COLUMN, COLUMN)], R::of(1.0));
        let inverse = R::of(1.0) / pivot;
        let right = self.right[COLUMN] * free;
        for row in COLUMN + 1..ROWS {
            whole[row] = self.entries[entry(row, COLUMN)] * free;
            factors.below[COLUMN][row] = whole[row] * inverse;
            self.right[row] -= factors.below[COLUMN][row] * right;
        }
        factors.solved[COLUMN] = right * inverse;
        for_rows!(self.update_row::<COLUMN>(&factors.below[COLUMN], whole));
        free.choose(pivot, R::of(f64::from(f32::MAX)))
    }

    #[inline(always)]
    fn update_row<const COLUMN: usize, const ROW: usize>(&mut self, scaled: &[R; ROWS], whole: &[R; ROWS]) {
        for other in COLUMN + 1..=ROW {
            self.entries[entry(ROW, other)] -= scaled[ROW] * whole[other];
        }
    }

    #[inline(always)]
    fn shift(&mut self) {
        let kept = ROWS - UNKNOWNS;
        for row in 0..kept {
            let from = entry(row + UNKNOWNS, UNKNOWNS);
            self.entries.copy_within(from..=from + row, entry(row, 0));
        }
        self.entries[entry(kept, 0)..].fill(R::of(0.0));
        self.right.copy_within(UNKNOWNS.., 0);
        self.right[kept..].fill(R::of(0.0));
    }
}

/// Solves from tip to root: the unknowns of every node.
#[inline(always)]
pub fn substitute<R: Real>(factors: &[Factors<R>], unknowns: &mut [[R; UNKNOWNS]]) {
    let mut known = [R::of(0.0); ROWS];
    for (factors, unknowns) in factors.iter().zip(unknowns).rev() {
        for row in (UNKNOWNS..ROWS).rev() {
            known[row] = known[row - UNKNOWNS];
        }
        known[3] = back::<R, 3>(factors, &known);
        known[2] = back::<R, 2>(factors, &known);
        known[1] = back::<R, 1>(factors, &known);
        known[0] = back::<R, 0>(factors, &known);
        unknowns.copy_from_slice(&known[..UNKNOWNS]);
    }
}

#[inline(always)]
fn back<R: Real, const COLUMN: usize>(factors: &Factors<R>, known: &[R; ROWS]) -> R {
    let mut value = factors.solved[COLUMN];
    for row in COLUMN + 1..ROWS {
        value -= factors.below[COLUMN][row] * known[row];
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A symmetric positive system of `nodes` nodes with a band of the right width, by a fixed rule.
    fn system(nodes: usize) -> Vec<Vec<f64>> {
        let count = nodes * UNKNOWNS;
        let mut matrix = vec![vec![0.0; count]; count];
        for first in (0..count).step_by(UNKNOWNS) {
            for turn in 0..3 {
                let vector = vector(first + turn);
                for row in 0..ROWS.min(count - first) {
                    for column in 0..ROWS.min(count - first) {
                        matrix[first + row][first + column] += vector[row] * vector[column];
                    }
                }
            }
            for row in first..first + UNKNOWNS {
                matrix[row][row] += 0.5;
            }
        }
        matrix
    }

    fn vector(seed: usize) -> [f64; ROWS] {
        std::array::from_fn(|k| ((seed * 37 + k * 101) as f64 * 0.7).sin())
    }

    #[test]
    fn a_band_is_solved() {
        let nodes = 7;
        let matrix = system(nodes);
        let wanted: Vec<f64> = (0..nodes * UNKNOWNS).map(|k| (k as f64).cos()).collect();
        let right: Vec<f64> =
            matrix.iter().map(|row| row.iter().zip(&wanted).map(|(a, b)| a * b).sum()).collect();
        let mut front = Front::default();
        let mut factors = Vec::new();
        for node in 0..nodes {
            let first = node * UNKNOWNS;
            // Rows beyond the end are left out, as in `system`.
            let vectors = std::array::from_fn(|turn| {
                let mut vector = vector(first + turn);
                vector.iter_mut().skip(nodes * UNKNOWNS - first).for_each(|value| *value = 0.0);
                vector
            });
            front.add_squares(&vectors, [1.0; 3]);
            for row in 0..UNKNOWNS {
                front.add(row, row, 0.5);
                front.add_right(row, right[first + row]);
            }
            factors.push(Factors::zero());
            front.eliminate(&mut factors[node], [1.0; UNKNOWNS]);
        }
        let mut found = vec![[0.0; UNKNOWNS]; nodes];
        substitute(&factors, &mut found);
        for (found, wanted) in found.concat().iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        }
    }
}
