//! What stands for the solver on a GPU in a build without GPUs: nothing of it can be made.

use strandline_body::Pose;
use strandline_gpu::{Buffer, Gpu};

use crate::{Drive, Settings, SimError, Solver, State, StepReport};

/// A solver on a GPU.
#[derive(Debug)]
pub enum GpuSolver {}

/// A state on a GPU.
#[derive(Debug)]
pub enum GpuState {}

/// No shader modules.
pub fn modules() -> Vec<(&'static str, &'static str)> {
    Vec::new()
}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl GpuSolver {
    pub fn new(gpu: &Gpu, _: Solver) -> Result<Self, SimError> {
        match *gpu {}
    }

    pub fn solver(&self) -> &Solver {
        match *self {}
    }

    pub fn gpu(&self) -> &Gpu {
        match *self {}
    }

    pub fn set_settings(&mut self, _: &Settings, _: &mut GpuState) -> Result<(), SimError> {
        match *self {}
    }

    pub fn rest_state(&self, _: Pose) -> Result<GpuState, SimError> {
        match *self {}
    }

    pub fn upload(&self, _: &State) -> Result<GpuState, SimError> {
        match *self {}
    }

    pub fn step(&self, _: &mut GpuState, _: &Drive) -> Result<(), SimError> {
        match *self {}
    }

    pub fn reports(&self, _: &mut GpuState) -> Result<Vec<StepReport>, SimError> {
        match *self {}
    }
}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl GpuState {
    pub fn time(&self) -> f64 {
        match *self {}
    }

    pub fn positions(&self) -> [&Buffer<f32>; 2] {
        match *self {}
    }

    pub fn read_into(&self, _: &mut State) -> Result<(), SimError> {
        match *self {}
    }

    pub fn write(&mut self, _: &GpuSolver, _: &State) -> Result<(), SimError> {
        match *self {}
    }

    pub fn write_grab(&mut self, _: &State) -> Result<(), SimError> {
        match *self {}
    }
}
