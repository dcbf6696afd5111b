//! The compiled kernels of all stages.

use std::sync::OnceLock;

use strandline_gpu::{Declaration, Dispatches, Gpu, GpuError, Scan};

use super::buffers::Buffers;
use super::stage::{StageKernels, Target};
use super::{
    advance, between, constrain, gather, integrate, lengths_alone, mark, pose_roots, shelter, slide,
    solve_pressure, solve_rods, splat,
};
use crate::Model;
use crate::step::Stage;

/// Names the module of each stage, once.
macro_rules! kernels {
    ($($stage:ident => $module:ident,)*) => {
        /// Kernels of a stage are compiled when a step first has it.
        pub(super) struct Kernels {
            scan: Scan,
            pub slide: slide::Slide,
            $($module: OnceLock<$module::Stage>,)*
        }

        impl Kernels {
            pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
                Ok(Self {
                    scan: Scan::new(gpu)?,
                    slide: slide::Slide::new(gpu)?,
                    $($module: OnceLock::new(),)*
                })
            }

            $(pub fn $module(&self, gpu: &Gpu, model: &Model) -> Result<&$module::Stage, GpuError> {
                if let Some(compiled) = self.$module.get() {
                    return Ok(compiled);
                }
                let compiled = $module::Stage::new(gpu, model)?;
                Ok(self.$module.get_or_init(|| compiled))
            })*

            fn stage(&self, stage: Stage, model: &Model, to: &Target) -> Result<Dispatches, GpuError> {
                match stage {
                    $(Stage::$stage => self.$module(to.gpu, model)?.bind(to),)*
                }
            }
        }

        /// Every kernel's declaration, to be held against its shader.
        pub fn declarations() -> Vec<Declaration> {
            let mut all: Vec<Declaration> = lengths_alone::declarations().into();
            all.push(slide::Slide::declaration());
            all.push(between::declaration());
            $(all.extend($module::Stage::declarations());)*
            all
        }
    };
}

kernels! {
    PoseRoots => pose_roots,
    Shelter => shelter,
    Integrate => integrate,
    Constrain => constrain,
    SolveRods => solve_rods,
    Splat => splat,
    Mark => mark,
    SolvePressure => solve_pressure,
    Gather => gather,
    Advance => advance,
}

impl Kernels {
    /// Binds a stage to buffers, for the steps of a model that start with the newer positions on a side.
    pub fn bind(
        &self,
        stage: Stage,
        (gpu, model): (&Gpu, &Model),
        buffers: &Buffers,
        side: usize,
    ) -> Result<Dispatches, GpuError> {
        let preconditioner = model.settings.volume.preconditioner;
        self.stage(stage, model, &Target { gpu, buffers, side, scan: &self.scan, preconditioner })
    }
}
