//! The stages as kernels, through wgpu; every one has a twin in plain Rust under the same name.
//!
//! A [`GpuSolver`] is compiled once, a [`GpuState`] lies on the device. A step is one submission;
//! nothing is read back until it is asked for.

mod advance;
mod alone;
mod buffers;
mod constrain;
mod gather;
mod inputs;
mod integrate;
mod lengths_alone;
mod linked;
mod mark;
mod pcg;
mod pose_roots;
mod probe;
mod solids;
mod solve_pressure;
mod solve_rods;
mod solver;
mod splat;
mod state;
mod step;

mod volume;

use buffers::Buffers;
pub use lengths_alone::{LengthsForm, LengthsInput, lengths_alone};
pub use linked::modules;
pub use pcg::Spread;
pub use probe::Probe;
pub use solve_pressure::{Gradient, PressureState};
pub use solver::{GpuSolver, declarations};
pub use state::{Costs, GpuState};
use strandline_gpu::Dispatches;
use strandline_groom::LANES;

/// Threads of a workgroup, as in common.wesl.
const THREADS: usize = 64;
