//! Replacement of the GPU runner in a build without GPUs: it cannot be made.

use strandline_body::BodyFrame;
use strandline_gpu::{Buffer, Gpu, GpuError};
use strandline_groom::Vec3Lanes;

use crate::grab::Grab;
use crate::length_scale::Lengths;
use crate::{Drive, Model, Settings, SimError, State, StepReport};

/// A runner on a GPU.
#[derive(Debug)]
pub enum GpuRunner {}

/// A pending copy of a state to the host.
#[derive(Debug)]
pub enum ComingState {}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl ComingState {
    pub fn has_arrived(&self) -> Result<bool, SimError> {
        match *self {}
    }

    pub fn write(self, _: &mut State) -> Result<(), SimError> {
        match self {}
    }
}

/// Positions of two states on their way to the host.
#[derive(Debug)]
pub enum ComingPoints {}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl ComingPoints {
    pub fn begin([before, _]: [&Buffer<f32>; 2]) -> Result<Self, GpuError> {
        match *before.gpu() {}
    }

    pub fn has_arrived(&self) -> Result<bool, GpuError> {
        match *self {}
    }

    pub fn write(self, _: f32, _: &mut Vec<Vec3Lanes>) -> Result<(), GpuError> {
        match self {}
    }
}

/// Carries points between two states.
#[derive(Debug)]
pub enum PointCarrier {}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl PointCarrier {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        match *gpu {}
    }

    pub fn carry(
        &mut self,
        _: [&Buffer<f32>; 2],
        _: [&BodyFrame; 3],
        _: f32,
        _: [usize; 2],
        _: &Buffer<f32>,
    ) -> Result<(), GpuError> {
        match *self {}
    }
}

/// No shader modules.
pub fn modules() -> Vec<(&'static str, &'static str)> {
    Vec::new()
}

/// Positions between two states on a device.
///
/// # Errors
/// None.
pub fn read_between([before, _]: [&Buffer<f32>; 2], _: f32, _: &mut Vec<Vec3Lanes>) -> Result<(), GpuError> {
    match *before.gpu() {}
}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl GpuRunner {
    pub fn new(gpu: &Gpu, _: Model) -> Result<Self, SimError> {
        match *gpu {}
    }

    pub fn model(&self) -> &Model {
        match *self {}
    }

    pub fn gpu(&self) -> &Gpu {
        match *self {}
    }

    pub fn time(&self) -> f64 {
        match *self {}
    }

    pub fn body(&self) -> &BodyFrame {
        match *self {}
    }

    pub fn solids(&self) -> (Buffer<[u32; 4]>, [usize; 2]) {
        match *self {}
    }

    pub fn positions(&self) -> [&Buffer<f32>; 2] {
        match *self {}
    }

    pub fn set_settings(&mut self, _: &Settings) -> Result<(), SimError> {
        match *self {}
    }

    pub(crate) fn set_settings_at(&mut self, _: &Settings, _: &State) -> Result<(), SimError> {
        match *self {}
    }

    pub(crate) fn runs_on_way(&self) -> usize {
        match *self {}
    }

    pub fn step(&mut self, _: &Drive) -> Result<(), SimError> {
        match *self {}
    }

    pub fn arrived_reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        match *self {}
    }

    pub fn forget_reports(&mut self) {
        match *self {}
    }

    pub fn begin_read(&self) -> Result<ComingState, SimError> {
        match *self {}
    }

    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        match *self {}
    }

    pub fn state(&self) -> Result<State, SimError> {
        match *self {}
    }

    pub fn read_into(&self, _: &mut State) -> Result<(), SimError> {
        match *self {}
    }

    pub fn write(&mut self, _: &State) -> Result<(), SimError> {
        match *self {}
    }

    pub(crate) fn set_lengths(&mut self, _: &Lengths) -> Result<(), SimError> {
        match *self {}
    }

    pub(crate) fn write_grab(&mut self, _: &Grab) -> Result<(), SimError> {
        match *self {}
    }
}
