use strandline_body::{Mesh, Pose};
use strandline_groom::{Guides, Vec3Lanes};

use crate::{Camera, LevelOfDetail, Light, Look, Picture, RenderError};

/// What one picture is made from.
#[derive(Clone, Copy)]
pub struct FrameInput<'a> {
    /// Guide points \[m\], world space, shape `[block][point]` of lanes.
    pub positions: &'a [Vec3Lanes],
    /// Pose of the head.
    pub world_from_head: Pose,
    /// The camera.
    pub camera: &'a Camera,
    /// The hair's look.
    pub look: &'a Look,
    /// The lights.
    pub lights: &'a [Light],
    /// Level of detail.
    pub level_of_detail: &'a LevelOfDetail,
}

/// What a picture cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Strands drawn, guides among them.
    pub strands: usize,
    /// Segments drawn.
    pub segments: usize,
    /// Wall-clock seconds of each stage, in order.
    pub seconds: Vec<(&'static str, f64)>,
}

/// Draws frames of one groom on one body; keeps its buffers from frame to frame.
pub struct Renderer {}

impl Renderer {
    /// A renderer of pictures `width` x `height` \[pixel\].
    ///
    /// # Errors
    /// A size of 0 or above 16,384.
    pub fn new(
        _guides: &Guides,
        _body: Option<&Mesh>,
        _width: u32,
        _height: u32,
    ) -> Result<Self, RenderError> {
        unimplemented!("renderer")
    }

    /// Draws a picture.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn draw(&mut self, _input: &FrameInput) -> Result<(Picture, FrameReport), RenderError> {
        unimplemented!("renderer")
    }
}
