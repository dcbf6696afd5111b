//! Forces, then a prediction.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use crate::Model;

kernel! {
    /// One thread is one point.
    pub(super) struct Integrate in "integrate" (super::linked::INTEGRATE), entry "integrate" {
        0 step: Read Step,
        2 rest: Read f32,
        3 springs: Read f32,
        4 positions: Read f32,
        5 velocities: Read f32,
        6 predicted: ReadWrite f32,
    }
}

pub(super) struct Stage(Kernel<Integrate<'static>>);

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![Integrate::declaration()]
    }

    fn new(gpu: &Gpu, _: &Model) -> Result<Self, GpuError> {
        Kernel::new(gpu, &[]).map(Self)
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let bound = self.0.bind(
            gpu,
            &Integrate {
                step: &buffers.step,
                rest: &buffers.rest,
                springs: &buffers.springs,
                positions: &buffers.places[side],
                velocities: &buffers.velocities,
                predicted: &buffers.places[1 - side],
            },
        )?;
        Ok(vec![bound.over(buffers.point_count())])
    }
}
