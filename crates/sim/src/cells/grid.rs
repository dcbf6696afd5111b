//! The box of cubic cells that follows the hair.

use glam::Vec3;
use strandline_base::math;
use strandline_groom::LANES;
use wide::{f32x8, i32x8};

use strandline_base::vec3x8::{Vec3x8, splat};

/// The cell of a point that takes no part.
pub const NO_CELL: u32 = u32::MAX;

/// Points further than this from the origin \[m\], or not finite, are left out of the volume: one
/// stray point would stretch the cells until the hair sat in a single one.
pub const REACH: f32 = 1e4;

/// Finest spacing \[m\]: below it a cell is smaller than the gap between neighbouring hairs.
pub(crate) const MIN_SPACING: f32 = 1e-3;

/// Spacings form a ladder with this many rungs per doubling.
const RUNGS_PER_DOUBLING: f32 = 8.0;

/// The spacing is kept while the hair needs at least this share of it.
const KEPT_SHARE: f32 = 0.8;

/// Nearest that a point comes to the border of its cell \[cells\], so that every face of a cell
/// that holds a point carries weight.
const EDGE: f32 = 1e-6;

/// Distance that a point may lie outside the box by rounding \[cells\].
const ROUNDING: f32 = 1e-3;

/// Cells of the points of eight strands, and their places in them.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// Index of the cell, `i + size.x (j + size.y k)`; [`NO_CELL`] outside the cells that may hold hair.
    pub cell: [u32; LANES],
    /// Distance from the cell's lower corner \[cells\], inside 0 to 1, for each axis.
    pub share: [f32x8; 3],
}

/// A box of `cells` cubic cells that may hold hair, and one ring of cells around it that never
/// does, so that every stencil fits. Indices count the ring.
///
/// Cells are cubes (one spacing makes the Laplacian uniform). The box starts at a whole number of
/// cells from the world's origin and the spacing moves along a ladder with hysteresis: as the hair
/// sways the cells stay where they are in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    cells: [usize; 3],
    /// Lower corner \[m\] of the box with its ring, world space.
    origin: Vec3,
    spacing: f32,
}

impl Grid {
    /// A box of `cells` cells with spacing 1 m, its first cell at the origin.
    pub fn new(cells: [usize; 3]) -> Self {
        assert!(cells.iter().all(|&count| count > 0), "a grid needs a cell along every axis");
        Self { cells, origin: -Vec3::ONE, spacing: 1.0 }
    }

    /// Cells that may hold hair along x, y and z.
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Cells along x, y and z with the ring.
    pub fn size(&self) -> [usize; 3] {
        self.cells.map(|count| count + 2)
    }

    /// Number of cells with the ring.
    pub fn cell_count(&self) -> usize {
        self.size().iter().product()
    }

    /// Index steps to the next cell along x, y and z.
    pub fn strides(&self) -> [usize; 3] {
        let size = self.size();
        [1, size[0], size[0] * size[1]]
    }

    /// Edge of a cell \[m\].
    pub fn spacing(&self) -> f32 {
        self.spacing
    }

    /// Lower corner \[m\] of the cells that may hold hair, world space.
    pub fn low_corner(&self) -> Vec3 {
        self.origin + Vec3::splat(self.spacing)
    }

    /// Lower corner with the ring \[m\], world space, and spacing \[m\].
    pub(crate) fn place_numbers(&self) -> [f32; 4] {
        self.origin.extend(self.spacing).to_array()
    }

    /// Takes over what [`Grid::place_numbers`] gave; a spacing that none has is left.
    pub(crate) fn set_place(&mut self, [x, y, z, spacing]: [f32; 4]) {
        if spacing.is_finite() && spacing >= MIN_SPACING {
            (self.origin, self.spacing) = (Vec3::new(x, y, z), spacing);
        }
    }

    /// Centre \[m\] of a cell, world space.
    pub fn center(&self, cell: usize) -> Vec3 {
        self.origin + (self.corner(cell) + Vec3::splat(0.5)) * self.spacing
    }

    /// Centre \[m\] of the lower face of a cell along an axis, world space.
    pub fn face_center(&self, axis: usize, cell: usize) -> Vec3 {
        let mut half = Vec3::splat(0.5);
        half[axis] = 0.0;
        self.origin + (self.corner(cell) + half) * self.spacing
    }

    fn corner(&self, cell: usize) -> Vec3 {
        let size = self.size();
        let rest = cell / size[0];
        Vec3::new((cell % size[0]) as f32, (rest % size[1]) as f32, (rest / size[1]) as f32)
    }

    /// Moves the box over points between two corners \[m\], world space.
    pub fn follow(&mut self, low: Vec3, high: Vec3) {
        let extent = high - low;
        let needed = (0..3)
            .map(|axis| match self.cells[axis] {
                1 => extent[axis],
                // A whole-cell origin wastes up to one cell.
                count => extent[axis] / (count - 1) as f32,
            })
            .fold(MIN_SPACING, f32::max);
        if needed > self.spacing || needed < KEPT_SHARE * self.spacing {
            self.spacing = rung_above(needed);
        }
        for axis in 0..3 {
            let first = match self.cells[axis] {
                1 => 0.5 * (low[axis] + high[axis]) / self.spacing - 0.5,
                _ => (low[axis] / self.spacing).floor(),
            };
            self.origin[axis] = (first - 1.0) * self.spacing;
        }
    }

    /// Finds the places of eight points \[m\], world space.
    #[inline]
    pub fn places(&self, points: Vec3x8) -> Places {
        let (least, spacing) = (splat(1.0 - ROUNDING), splat(self.spacing));
        let strides = self.strides();
        let mut inside = !f32x8::ZERO;
        let mut cell = i32x8::splat(0);
        let mut share = [f32x8::ZERO; 3];
        for (axis, coordinate) in points.array().into_iter().enumerate() {
            let count = self.cells[axis];
            let along = (coordinate - splat(self.origin[axis])) / spacing;
            // Written so that a coordinate that is not a number is outside.
            inside &= along.simd_gt(least) & along.simd_lt(splat((count + 1) as f32 + ROUNDING));
            let index = along.fast_max(splat(1.0)).fast_min(splat(count as f32 + 0.5)).fast_trunc_int();
            cell += index * i32x8::splat(strides[axis] as i32);
            share[axis] = (along - index.round_float()).fast_max(splat(EDGE)).fast_min(splat(1.0 - EDGE));
        }
        let inside = inside.to_bitmask();
        let cell = cell.to_array();
        let cell_of = |lane: usize| if inside & (1 << lane) != 0 { cell[lane] as u32 } else { NO_CELL };
        Places { cell: std::array::from_fn(cell_of), share }
    }
}

/// Every spacing \[m\] of the ladder that hair within [`REACH`] may need, ascending.
pub(crate) fn ladder() -> Vec<f32> {
    let mut rungs = vec![rung_above(MIN_SPACING)];
    while let Some(&last) = rungs.last().filter(|last| **last < 2.0 * REACH) {
        rungs.push(rung_above(last * math::exp2(0.5 / RUNGS_PER_DOUBLING)));
    }
    rungs
}

/// The smallest spacing of the ladder that is not below `needed`.
fn rung_above(needed: f32) -> f32 {
    let rung = math::exp2((math::log2(needed) * RUNGS_PER_DOUBLING).ceil() / RUNGS_PER_DOUBLING);
    // The logarithm may round a rung to just below what is needed.
    rung.max(needed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cell of a point and its place in it; none outside.
    fn place(grid: &Grid, point: Vec3) -> Option<(usize, Vec3)> {
        let places = grid.places(Vec3x8::splat(point));
        assert_eq!(places.cell, [places.cell[0]; LANES]);
        let share = places.share.map(|share| share.to_array()[0]);
        (places.cell[0] != NO_CELL).then_some((places.cell[0] as usize, share.into()))
    }

    fn corners(low: [f32; 3], high: [f32; 3]) -> (Vec3, Vec3) {
        (Vec3::from(low), Vec3::from(high))
    }

    #[test]
    fn the_box_holds_what_it_follows_for_any_cell_counts() {
        for cells in [[1, 1, 1], [2, 5, 9], [32, 32, 32], [1, 64, 3]] {
            let mut grid = Grid::new(cells);
            for (low, high) in [
                corners([0.1, 1.4, -0.2], [0.5, 1.9, 0.3]),
                corners([-7.03, -0.001, 3.0], [-7.03, 0.0, 3.0]),
                corners([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
            ] {
                grid.follow(low, high);
                for corner in 0..8 {
                    let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                    let point = Vec3::new(pick(0), pick(1), pick(2));
                    let (cell, share) = place(&grid, point).expect("a followed point is inside");
                    let back = grid.center(cell) + (share - Vec3::splat(0.5)) * grid.spacing();
                    // Rounding of coordinates of some metres, and the distance kept from borders.
                    assert!((back - point).abs().max_element() < 3e-6 + 2e-3 * grid.spacing());
                }
            }
        }
    }

    #[test]
    fn swaying_hair_keeps_the_cells_where_they_are() {
        let mut grid = Grid::new([32; 3]);
        grid.follow(Vec3::ZERO, Vec3::new(0.40, 0.30, 0.35));
        let (spacing, cell) = (grid.spacing(), place(&grid, Vec3::splat(0.2)).unwrap().0);
        let wanted = grid.center(cell);
        for step in 0..50 {
            let sway = 0.02 * (step as f32 * 0.3).sin();
            grid.follow(Vec3::new(sway, 0.0, 0.0), Vec3::new(0.39 + sway, 0.30, 0.35));
            assert_eq!(grid.spacing(), spacing);
            let cell = place(&grid, Vec3::splat(0.2)).unwrap().0;
            assert!((grid.center(cell) - wanted).length() < 1e-6);
        }
        grid.follow(Vec3::ZERO, Vec3::splat(0.1));
        assert!(grid.spacing() < 0.5 * spacing, "hair that shrinks gets finer cells");
    }

    #[test]
    fn points_outside_have_no_place() {
        let mut grid = Grid::new([4, 5, 6]);
        grid.follow(Vec3::ZERO, Vec3::ONE);
        assert!(place(&grid, Vec3::new(-0.3, 0.5, 0.5)).is_none());
        assert!(place(&grid, Vec3::new(0.5, 40.0, 0.5)).is_none());
        assert!(place(&grid, Vec3::new(0.5, f32::NAN, 0.5)).is_none());
    }
}
