//! Replacement of GPU runs in a build without GPUs: no device is ever opened.

use strandline::Scene;

use super::gpu::{Device, Forms, GpuRun};

impl Device {
    /// Never called.
    pub fn measure(&self, _: &Scene, _: &'static str) -> anyhow::Result<GpuRun> {
        match self.gpu {}
    }

    /// Never called.
    pub fn forms(&self, _: bool) -> anyhow::Result<Vec<Forms>> {
        match self.gpu {}
    }
}
