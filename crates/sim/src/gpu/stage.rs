//! Resources of every stage of a step on a device.

use strandline_gpu::{Declaration, Dispatches, Gpu, GpuError, Scan};

use super::buffers::Buffers;
use crate::{Model, Preconditioner};

/// Targets of a stage's kernels.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    pub gpu: &'a Gpu,
    pub buffers: &'a Buffers,
    /// On which side the newer positions lie when the step starts.
    pub side: usize,
    pub scan: &'a Scan,
    pub preconditioner: Preconditioner,
}

/// The kernels of a stage.
pub(super) trait StageKernels: Sized {
    /// Their declarations, to be compared with their shaders.
    fn declarations() -> Vec<Declaration>;

    /// Compiles the kernels for strands and solids like those of a model, when a step first has the stage.
    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError>;

    /// Dispatches of a step, in order; empty for a stage without work.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError>;
}
