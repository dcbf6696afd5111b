//! Replacement of the GPU renderer in a build without GPUs: it cannot be made.

use std::sync::Arc;

use strandline_body::{Mesh, Solids};
use strandline_gpu::{Buffer, Gpu};
use strandline_groom::{Binding, Guides};

use crate::{FrameInput, FrameReport, Picture, PictureSettings, RenderError};

/// Guide points that lie on a device.
#[derive(Clone, Copy, Debug)]
pub struct DevicePoints<'a> {
    /// Before the moment shown.
    pub before: &'a Buffer<f32>,
    /// After it.
    pub after: &'a Buffer<f32>,
    /// Place of the moment between them.
    pub share: f32,
}

/// Solids that lie on a device.
#[derive(Debug)]
pub struct DeviceSolids {
    /// Rows of four words.
    pub rows: Buffer<[u32; 4]>,
    /// Row from which others are counted.
    pub base: usize,
    /// Row of the first solid.
    pub first: usize,
}

/// A renderer on a GPU.
#[derive(Debug)]
pub enum GpuRenderer {}

/// No shader modules.
pub fn modules() -> Vec<(&'static str, &'static str)> {
    Vec::new()
}

#[expect(missing_docs, clippy::missing_errors_doc, reason = "none of it can be called")]
impl GpuRenderer {
    pub fn new(gpu: &Gpu, _: &Guides, _: Option<&Mesh>, _: &PictureSettings) -> Result<Self, RenderError> {
        match *gpu {}
    }

    pub fn gpu(&self) -> &Gpu {
        match *self {}
    }

    pub fn bind(&mut self, _: &Arc<Binding>, _: &Solids, _: Option<DeviceSolids>) -> Result<(), RenderError> {
        match *self {}
    }

    pub fn set_picture(&mut self, _: &PictureSettings) -> Result<(), RenderError> {
        match *self {}
    }

    pub fn show_layers(&mut self, _: Option<usize>) {
        match *self {}
    }

    pub fn draw_into(
        &mut self,
        _: &FrameInput,
        _: Option<DevicePoints>,
        _: &mut Picture,
    ) -> Result<FrameReport, RenderError> {
        match *self {}
    }

    pub fn opacity_map(&self, _: usize) -> Result<Option<Picture>, RenderError> {
        match *self {}
    }

    pub fn depth_map(&self, _: usize) -> Result<Option<Picture>, RenderError> {
        match *self {}
    }
}
