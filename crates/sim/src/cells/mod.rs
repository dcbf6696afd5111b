//! Cells of a box that follows the hair, for both backends: the box, points sorted by cell, and the contents of cells.

pub mod grid;
mod kind;
pub(crate) mod packing;
pub(crate) mod set;
pub mod sort;

pub use grid::{Grid, NO_CELL};
pub use kind::Kind;
pub use sort::CellSort;

/// Contents of the cells of a volume, as a probe takes them from one backend to the other.
#[derive(Clone, Debug)]
pub struct Contents {
    /// The box.
    pub grid: Grid,
    /// Velocity and its change \[m/s\] on the lower faces, shape `[component][cell]`.
    pub faces: Vec<[f32; 2]>,
    /// Kind of each cell.
    pub kinds: Vec<Kind>,
}
