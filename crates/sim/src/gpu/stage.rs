//! What every stage of a step has on a device.

use strandline_gpu::{Declaration, Dispatches, Gpu, GpuError, Scan};

use super::buffers::Buffers;
use crate::Preconditioner;

/// What the kernels of a stage are bound to.
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
    /// What they declare, to be held against their shaders.
    fn declarations() -> Vec<Declaration>;

    /// Compiles them, for strands of so many points.
    fn new(gpu: &Gpu, points_per_strand: usize) -> Result<Self, GpuError>;

    /// What a step starts, in order; nothing where it has nothing to do.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError>;
}
