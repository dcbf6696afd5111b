//! Structs shared by kernels and host, and the layout of the work.

use strandline_gpu::mirror;

use crate::PressureReport;

/// Most workgroups of a round: each sums what all of them found.
pub(super) const MOST_WORKGROUPS: usize = 256;
/// Vectors of four numbers that a point takes while its strand is solved.
pub(super) const SLOTS: usize = 19;
/// Further vectors of a point among strands that push each other, and those of a strand.
pub(super) const EXTRAS: usize = 6;
pub(super) const STATES: usize = 4;

mirror! {
    /// Report of a step. Mirrors `Report` in report.wesl.
    pub(super) struct Report {
        pub stretch_sum: f32,
        pub stretch_max: f32,
        pub penetration_max: f32,
        /// A number of points.
        pub non_finite: f32,
        /// Of rods: see `RodReport`.
        pub residual: f32,
        pub unsolved: f32,
        pub resting: f32,
        pub speed_sum: f32,
        pub speed_max: f32,
        /// Of strands that push each other: see `ContactReport`.
        pub pairs: f32,
        pub deepest: f32,
        pub crossed: f32,
        pub pressure: PressureState,
    }
}

mirror! {
    /// Measures over the strands of a workgroup. Mirrors `Outcome` in advance.wesl.
    pub(super) struct Outcome {
        /// Sum of stretch, largest stretch, deepest point \[m\], points that are not finite.
        pub found: [f32; 4],
        /// Of rods the largest residual \[rad\], strands not solved, strands at rest.
        pub solved: [f32; 4],
        /// Sum and largest of the speeds \[m/s\].
        pub speed: [f32; 4],
    }
}

mirror! {
    /// A box around the points of a workgroup. Mirrors `PointBox` in follow.wesl.
    pub(super) struct PointBox {
        pub low: [f32; 4],
        pub high: [f32; 4],
    }
}

mirror! {
    /// Progress of the solve. Mirrors `PressureState` in pressure.wesl.
    pub struct PressureState {
        /// Residual in the preconditioner's norm.
        pub rate: f32,
        /// Largest component of the residual \[m/s\].
        pub residual: f32,
        /// The same before the first iteration.
        pub first: f32,
        /// 1 once there is nothing left to do.
        pub done: u32,
        /// Iterations so far.
        pub iterations: u32,
        /// Iterations until the tolerance was met as an absolute one.
        pub iterations_absolute: u32,
        /// Unknowns.
        pub fluid_cells: u32,
        /// 1 once it was met.
        pub met: u32,
    }
}

impl From<PressureState> for PressureReport {
    fn from(state: PressureState) -> Self {
        let solved = state.fluid_cells > 0 && state.first > 0.0;
        Self {
            iterations: state.iterations as usize,
            iterations_absolute: state.iterations_absolute as usize,
            relative_residual: if solved { state.residual / state.first } else { 0.0 },
            absolute_residual: state.residual,
            fluid_cells: state.fluid_cells as usize,
        }
    }
}

/// Subtraction of the gradient [Chen2011 table 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gradient {
    /// One kernel for all components.
    #[default]
    Joint,
    /// A kernel for each component.
    Split,
}

/// Distribution of the solve over workgroups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// Small grids on one workgroup, others on many.
    #[default]
    Auto,
    /// On one workgroup.
    One,
    /// On many.
    Many,
}
