//! Rods: a strand bends and twists in one thread, in all parts of a step.

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use crate::Model;

kernel! {
    /// One thread is one strand after another.
    pub(super) struct SolveRods in "solve_rods" (super::linked::SOLVE_RODS), entry "solve_rods" {
        0 step: Read Step,
        1 air: Read f32,
        2 rods: Read f32,
        3 rest: Read f32,
        4 positions: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
    }
}

pub(super) struct Stage(Kernel<SolveRods<'static>>);

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![SolveRods::declaration()]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        Kernel::new(gpu, &[skins_constant(&model.colliders)]).map(Self)
    }

    /// Nothing without rods.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let Some(rods) = &buffers.rods else { return Ok(Vec::new()) };
        let bound = self.0.bind(
            gpu,
            &SolveRods {
                step: &buffers.step,
                air: rods.shelter.as_ref().map_or(&rods.no_air, |shelter| &shelter.air),
                rods: &rods.nodes,
                rest: &buffers.rest,
                positions: &buffers.places[side],
                predicted: &buffers.places[1 - side],
                velocities: &buffers.velocities,
                work: &rods.work,
            },
        )?;
        Ok(vec![(bound, [rods.groups as u32, 1, 1])])
    }
}
