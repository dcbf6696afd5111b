//! Points take their velocities from the faces.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use super::volume::GridState;
use crate::Model;

kernel! {
    /// One thread is one point.
    pub(super) struct Gather in "gather" (super::linked::GATHER), entry "gather" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 predicted: Read f32,
        3 velocities: ReadWrite f32,
        4 faces: Read [f32; 2],
        5 rest: Read f32,
        6 kinds: Read u32,
    }
}

pub(super) struct Stage(Kernel<Gather<'static>>);

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![Gather::declaration()]
    }

    fn new(gpu: &Gpu, _: &Model) -> Result<Self, GpuError> {
        Kernel::new(gpu, &[]).map(Self)
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let Some(volume) = &buffers.volume else { return Ok(Vec::new()) };
        let bound = self.0.bind(
            gpu,
            &Gather {
                step: &buffers.step,
                grid: &volume.grid,
                predicted: &buffers.places[1 - side],
                velocities: &buffers.velocities,
                faces: &volume.faces,
                rest: &buffers.rest,
                kinds: &volume.kinds,
            },
        )?;
        Ok(vec![bound.over(buffers.point_count())])
    }
}
