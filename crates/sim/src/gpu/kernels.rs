//! The compiled kernels of all stages.

use strandline_gpu::{Declaration, Dispatches, Gpu, GpuError, Scan};

use super::buffers::Buffers;
use super::stage::{StageKernels, Target};
use super::{
    advance, cells, constrain, gather, integrate, lengths_alone, mark, pose_roots, shelter, slide,
    solve_pressure, solve_rods, splat,
};
use crate::step::Stage;
use crate::{Model, Preconditioner};

/// Names the module of each stage, once.
macro_rules! kernels {
    ($($stage:ident => $module:ident,)*) => {
        pub(super) struct Kernels {
            scan: Scan,
            pub slide: slide::Slide,
            $(pub $module: $module::Stage,)*
        }

        impl Kernels {
            pub fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
                Ok(Self {
                    scan: Scan::new(gpu)?,
                    slide: slide::Slide::new(gpu)?,
                    $($module: $module::Stage::new(gpu, model)?,)*
                })
            }

            fn stage(&self, stage: Stage, to: &Target) -> Result<Dispatches, GpuError> {
                match stage {
                    $(Stage::$stage => self.$module.bind(to),)*
                }
            }
        }

        /// Every kernel's declaration, to be held against its shader.
        pub fn declarations() -> Vec<Declaration> {
            let mut all: Vec<Declaration> = lengths_alone::declarations().into();
            all.push(slide::Slide::declaration());
            $(all.extend($module::Stage::declarations());)*
            all
        }
    };
}

kernels! {
    PoseRoots => pose_roots,
    Cells => cells,
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
    /// Binds a stage to buffers, for the steps that start with the newer positions on a side.
    pub fn bind(
        &self,
        stage: Stage,
        gpu: &Gpu,
        buffers: &Buffers,
        side: usize,
        preconditioner: Preconditioner,
    ) -> Result<Dispatches, GpuError> {
        self.stage(stage, &Target { gpu, buffers, side, scan: &self.scan, preconditioner })
    }
}
