//! LDL^T of a strand's system, from root to tip without pivoting: the unknowns of a node touch those of
//! the two nodes after it, so that a front of eleven rows moves along the strand.

use super::joint::{Slope, Turning};
use super::real::{Real, Vector};

/// Unknowns of a node: a displacement and the angle of the segment above it.
pub const UNKNOWNS: usize = 4;
/// Unknowns that a joint touches: those of two nodes and the displacement of a third.
pub const ROWS: usize = 11;
/// Share of inertia's moments that no moment exceeds.
pub const ALL: f64 = 1e30;
const ENTRIES: usize = ROWS * (ROWS + 1) / 2;

/// Calls a method once for each row, with the row as a constant, so that its loops unroll.
macro_rules! for_rows {
    ($front:ident.$method:ident($($argument:expr),*)) => {
        for_rows!(@ $front $method ($($argument),*) 0 1 2 3 4 5 6 7 8 9 10)
    };
    (@ $front:ident $method:ident $arguments:tt $($row:literal)*) => {
        $(for_rows!(! $front.$method::<$row> $arguments);)*
    };
    (! $front:ident.$method:ident::<$row:literal> ($($argument:expr),*)) => {
        $front.$method::<$row>($($argument),*)
    };
}

/// Position of a row and a column, row not above column, in the lower triangle of a front.
#[inline(always)]
const fn entry(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// A spring on a strain of a joint.
pub struct Spring<R> {
    /// Derivative of the strain.
    pub slope: Slope<R>,
    /// The same times the stiffness.
    pub scaled: Slope<R>,
    /// Force on the strain: stiffness times the strain that is missing.
    pub moment: R,
}

impl<R: Real> Spring<R> {
    /// A spring of a stiffness, from its missing strain.
    #[inline(always)]
    pub fn new(slope: Slope<R>, stiffness: R, lacks: R) -> Self {
        let scaled = Slope {
            lower: slope.lower * stiffness,
            upper: slope.upper * stiffness,
            lower_angle: slope.lower_angle * stiffness,
            upper_angle: slope.upper_angle * stiffness,
        };
        Self { slope, scaled, moment: stiffness * lacks }
    }
}

/// Contribution of a joint and the edge above it to a system.
pub struct Bends<R> {
    /// Springs on its two bends and its twist.
    pub springs: [Spring<R>; 3],
    /// Change of moments with the turns of the sections below and above.
    pub turnings: [Turning<R>; 2],
    /// Second derivative of the energy by the edge above \[N/m\], of what stretches it.
    pub stretch: [[R; 3]; 3],
    /// Force that pulls its ends together \[N\].
    pub pull: Vector<R>,
}

#[inline(always)]
fn sum<R: Real>(springs: &[Spring<R>; 3], term: impl Fn(&Spring<R>) -> R) -> R {
    term(&springs[0]) + term(&springs[1]) + term(&springs[2])
}

/// Position of a row and one of the first columns, row not above column, in what is kept of these columns.
#[inline(always)]
const fn kept(column: usize, row: usize) -> usize {
    column * ROWS - column * (column + 1) / 2 + row
}

/// Result of the elimination of a node, for the back substitution.
#[derive(Clone, Copy, Debug)]
pub struct Factors<R> {
    /// Entries below the diagonal of each column, by row; on it 1 over the pivot, 0 of what stays.
    below: [R; kept(UNKNOWNS - 1, ROWS - 1) + 1],
}

impl<R: Real> Factors<R> {
    /// No factors: unknowns that stay.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { below: [R::of(0.0); kept(UNKNOWNS - 1, ROWS - 1) + 1] }
    }

    /// Eliminates another right-hand side, whose rows below change. Returns what [`substitute`] begins with.
    #[inline(always)]
    pub(super) fn solve(&self, right: &mut [R; ROWS]) -> [R; UNKNOWNS] {
        [
            self.solve_column::<0>(right),
            self.solve_column::<1>(right),
            self.solve_column::<2>(right),
            self.solve_column::<3>(right),
        ]
    }

    #[inline(always)]
    fn solve_column<const COLUMN: usize>(&self, right: &mut [R; ROWS]) -> R {
        let own = right[COLUMN];
        for row in COLUMN + 1..ROWS {
            right[row] -= self.below[kept(COLUMN, row)] * own;
        }
        own * self.below[kept(COLUMN, COLUMN)]
    }
}

/// The active rows: those of the next node to be eliminated and of the unknowns that it touches.
pub struct Front<R> {
    entries: [R; ENTRIES],
    right: [R; ROWS],
}

impl<R: Real> Default for Front<R> {
    #[inline(always)]
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

    /// Adds a joint. Overwrites the rows of the angle above and of the point beyond, which are empty before.
    #[inline(always)]
    pub fn set_joint(&mut self, bends: &Bends<R>) {
        self.set_axis::<0>(bends);
        self.set_axis::<1>(bends);
        self.set_axis::<2>(bends);
        let springs = &bends.springs;
        let angles = |one: fn(&Slope<R>) -> R, other: fn(&Slope<R>) -> R| {
            sum(springs, |spring| one(&spring.slope) * other(&spring.scaled))
        };
        let [lower, upper] = &bends.turnings;
        self.entries[entry(3, 3)] +=
            angles(|slope| slope.lower_angle, |slope| slope.lower_angle) + lower.angle;
        self.entries[entry(7, 3)] = angles(|slope| slope.upper_angle, |slope| slope.lower_angle);
        self.entries[entry(7, 7)] =
            angles(|slope| slope.upper_angle, |slope| slope.upper_angle) + upper.angle;
        self.right[3] += sum(springs, |spring| spring.slope.lower_angle * spring.moment);
        self.right[7] = sum(springs, |spring| spring.slope.upper_angle * spring.moment);
    }

    /// The rows and columns of one axis: edges are differences of points.
    #[inline(always)]
    fn set_axis<const AXIS: usize>(&mut self, bends: &Bends<R>) {
        let (springs, [turning, _]) = (&bends.springs, &bends.turnings);
        let below = sum(springs, |spring| spring.scaled.lower.axis::<AXIS>() * spring.slope.lower_angle)
            + turning.lower.axis::<AXIS>();
        let above = sum(springs, |spring| spring.scaled.upper.axis::<AXIS>() * spring.slope.lower_angle)
            + turning.upper.axis::<AXIS>();
        self.entries[entry(3, AXIS)] += -below;
        self.entries[entry(4 + AXIS, 3)] += below - above;
        self.entries[entry(8 + AXIS, 3)] = above;
        let [_, turning] = &bends.turnings;
        let below = sum(springs, |spring| spring.scaled.lower.axis::<AXIS>() * spring.slope.upper_angle)
            + turning.lower.axis::<AXIS>();
        let above = sum(springs, |spring| spring.scaled.upper.axis::<AXIS>() * spring.slope.upper_angle)
            + turning.upper.axis::<AXIS>();
        self.entries[entry(7, AXIS)] = -below;
        self.entries[entry(7, 4 + AXIS)] = below - above;
        self.entries[entry(8 + AXIS, 7)] = above;
        let below = sum(springs, |spring| spring.slope.lower.axis::<AXIS>() * spring.moment);
        let above = sum(springs, |spring| spring.slope.upper.axis::<AXIS>() * spring.moment)
            - bends.pull.axis::<AXIS>();
        self.right[AXIS] += -below;
        self.right[4 + AXIS] += below - above;
        self.right[8 + AXIS] = above;
        self.set_pair::<AXIS, 0>(bends);
        self.set_pair::<AXIS, 1>(bends);
        self.set_pair::<AXIS, 2>(bends);
    }

    #[inline(always)]
    fn set_pair<const ROW: usize, const COLUMN: usize>(&mut self, bends: &Bends<R>) {
        let springs = &bends.springs;
        let lower =
            sum(springs, |spring| spring.slope.lower.axis::<ROW>() * spring.scaled.lower.axis::<COLUMN>());
        let mixed =
            sum(springs, |spring| spring.slope.upper.axis::<ROW>() * spring.scaled.lower.axis::<COLUMN>());
        let upper =
            sum(springs, |spring| spring.slope.upper.axis::<ROW>() * spring.scaled.upper.axis::<COLUMN>())
                + bends.stretch[ROW][COLUMN];
        self.entries[entry(4 + ROW, COLUMN)] += mixed - lower;
        self.entries[entry(8 + ROW, COLUMN)] = -mixed;
        self.entries[entry(8 + ROW, 4 + COLUMN)] = mixed - upper;
        if COLUMN <= ROW {
            let turned = sum(springs, |spring| {
                spring.slope.upper.axis::<COLUMN>() * spring.scaled.lower.axis::<ROW>()
            });
            self.entries[entry(ROW, COLUMN)] += lower;
            self.entries[entry(4 + ROW, 4 + COLUMN)] += lower - mixed + (upper - turned);
            self.entries[entry(8 + ROW, 8 + COLUMN)] = upper;
        }
    }

    /// Empties the rows of an upper angle and of a point beyond, for a node without a joint above it.
    #[inline(always)]
    pub fn clear_above(&mut self) {
        self.entries[entry(ROWS - UNKNOWNS, 0)..].fill(R::of(0.0));
        self.right[ROWS - UNKNOWNS..].fill(R::of(0.0));
    }

    /// Eliminates the first four rows and moves the others up; `solved` is what [`substitute`] begins with. `free` is 1 for
    /// unknowns that move and 0 for those that stay. Returns 1 where the pivots of all free unknowns are positive, as those
    /// of a positive definite system, else 0; NaN is not positive.
    #[inline(always)]
    pub fn eliminate(
        &mut self,
        factors: &mut Factors<R>,
        solved: &mut [R; UNKNOWNS],
        free: [R; UNKNOWNS],
    ) -> R {
        let mut whole = [[R::of(0.0); ROWS]; UNKNOWNS];
        let pivots = [
            self.eliminate_column::<0>(factors, solved, &mut whole, free[0]),
            self.eliminate_column::<1>(factors, solved, &mut whole, free[1]),
            self.eliminate_column::<2>(factors, solved, &mut whole, free[2]),
            self.eliminate_column::<3>(factors, solved, &mut whole, free[3]),
        ];
        self.move_up(factors, &whole);
        pivots.into_iter().fold(R::of(1.0), |sound, pivot| pivot.choose(sound, R::of(0.0)))
    }

    #[inline(always)]
    fn eliminate_column<const COLUMN: usize>(
        &mut self,
        factors: &mut Factors<R>,
        solved: &mut [R; UNKNOWNS],
        whole: &mut [[R; ROWS]; UNKNOWNS],
        free: R,
    ) -> R {
        let pivot = free.choose(self.entries[entry(COLUMN, COLUMN)], R::of(1.0));
        let inverse = free / pivot;
        let right = self.right[COLUMN];
        solved[COLUMN] = right * inverse;
        factors.below[kept(COLUMN, COLUMN)] = inverse;
        for row in COLUMN + 1..ROWS {
            let value = self.entries[entry(row, COLUMN)];
            let scaled = value * inverse;
            whole[COLUMN][row] = value;
            factors.below[kept(COLUMN, row)] = scaled;
            self.right[row] -= scaled * right;
        }
        // Updates of the rows that are eliminated here; the rest follows below.
        for other in COLUMN + 1..UNKNOWNS {
            for row in other..ROWS {
                self.entries[entry(row, other)] -= factors.below[kept(COLUMN, row)] * whole[COLUMN][other];
            }
        }
        free.choose(pivot, R::of(1.0))
    }

    /// The remaining rows, four rows up.
    #[inline(always)]
    fn move_up(&mut self, factors: &Factors<R>, whole: &[[R; ROWS]; UNKNOWNS]) {
        for_rows!(self.move_row(factors, whole));
    }

    #[inline(always)]
    fn move_row<const ROW: usize>(&mut self, factors: &Factors<R>, whole: &[[R; ROWS]; UNKNOWNS]) {
        if ROW < UNKNOWNS {
            return;
        }
        let scaled = &factors.below;
        let (a, b) = (scaled[kept(0, ROW)], scaled[kept(1, ROW)]);
        let (c, d) = (scaled[kept(2, ROW)], scaled[kept(3, ROW)]);
        for column in UNKNOWNS..=ROW {
            let taken =
                a * whole[0][column] + b * whole[1][column] + c * whole[2][column] + d * whole[3][column];
            self.entries[entry(ROW - UNKNOWNS, column - UNKNOWNS)] = self.entries[entry(ROW, column)] - taken;
        }
        self.right[ROW - UNKNOWNS] = self.right[ROW];
    }
}

/// Solves from tip to root: the unknowns of every node, in place of what elimination left.
#[inline(always)]
pub fn substitute<R: Real>(factors: &[Factors<R>], unknowns: &mut [[R; UNKNOWNS]]) {
    let mut known = [R::of(0.0); ROWS];
    for (factors, unknowns) in factors.iter().zip(unknowns).rev() {
        for row in (UNKNOWNS..ROWS).rev() {
            known[row] = known[row - UNKNOWNS];
        }
        known[3] = back::<R, 3>(factors, unknowns[3], &known);
        known[2] = back::<R, 2>(factors, unknowns[2], &known);
        known[1] = back::<R, 1>(factors, unknowns[1], &known);
        known[0] = back::<R, 0>(factors, unknowns[0], &known);
        unknowns.copy_from_slice(&known[..UNKNOWNS]);
    }
}

#[inline(always)]
fn back<R: Real, const COLUMN: usize>(factors: &Factors<R>, solved: R, known: &[R; ROWS]) -> R {
    let mut value = solved;
    for row in COLUMN + 1..ROWS {
        value -= factors.below[kept(COLUMN, row)] * known[row];
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
        let mut found = vec![[0.0; UNKNOWNS]; nodes];
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
            front.eliminate(&mut factors[node], &mut found[node], [1.0; UNKNOWNS]);
            front.clear_above();
        }
        substitute(&factors, &mut found);
        for (found, wanted) in found.concat().iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        }
    }
}
