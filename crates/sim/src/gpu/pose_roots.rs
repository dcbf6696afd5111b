//! Rooted points follow the head.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use crate::Model;

kernel! {
    /// One thread is one strand.
    pub(super) struct PoseRoots in "pose_roots" (super::linked::POSE_ROOTS), entry "pose_roots" {
        0 step: Read Step,
        2 rest_positions: Read f32,
        3 rest: Read f32,
        4 positions: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
    }
}

pub(super) struct Stage(Kernel<PoseRoots<'static>>);

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![PoseRoots::declaration()]
    }

    fn new(gpu: &Gpu, _: &Model) -> Result<Self, GpuError> {
        Kernel::new(gpu, &[]).map(Self)
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let bound = self.0.bind(
            gpu,
            &PoseRoots {
                step: &buffers.step,
                rest_positions: &buffers.rest_positions,
                rest: &buffers.rest,
                positions: &buffers.places[side],
                predicted: &buffers.places[1 - side],
                velocities: &buffers.velocities,
            },
        )?;
        Ok(vec![bound.over(buffers.lane_count)])
    }
}
