//! Rods: a strand bends and twists in one thread, in all parts of a step.

use std::sync::OnceLock;

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::rod_crowd::Crowd;
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

pub(super) struct Stage {
    alone: Kernel<SolveRods<'static>>,
    /// Of strands that push each other, compiled when a step first has them.
    crowd: OnceLock<Crowd>,
    skins: (&'static str, f64),
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        let mut all = vec![SolveRods::declaration()];
        all.extend(Crowd::declarations());
        all
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        let skins = skins_constant(&model.colliders);
        Ok(Self { alone: Kernel::new(gpu, &[skins])?, crowd: OnceLock::new(), skins })
    }

    /// Nothing without rods.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let Some(rods) = &buffers.rods else { return Ok(Vec::new()) };
        if let Some(crowd) = &rods.crowd {
            let kernels = match self.crowd.get() {
                Some(compiled) => compiled,
                None => {
                    let compiled = Crowd::new(gpu, self.skins, buffers.point_count())?;
                    self.crowd.get_or_init(|| compiled)
                }
            };
            return kernels.bind(to, rods, crowd);
        }
        let bound = self.alone.bind(
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
