use strandline_body::Pose;
use strandline_groom::Vec3Lanes;

use crate::memory::{Drawn, check_lights};

use crate::{BodyLook, Camera, DetailLevel, LevelOfDetail, Light, Look, PictureSettings, RenderError};

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
    /// The body's look.
    pub body_look: &'a BodyLook,
    /// The lights.
    pub lights: &'a [Light],
    /// Level of detail.
    pub level_of_detail: &'a LevelOfDetail,
}

impl FrameInput<'_> {
    /// Checks everything but the points.
    ///
    /// # Errors
    /// A setting outside its range.
    pub(crate) fn validate(&self) -> Result<(), RenderError> {
        self.camera.validate()?;
        self.look.validate()?;
        self.body_look.validate()?;
        self.level_of_detail.validate()?;
        check_lights(self.lights)
    }

    /// Refuses more than can be drawn, before anything is allocated for it.
    pub(crate) fn check_memory(
        &self,
        guide_count: usize,
        points_per_strand: usize,
        level: &DetailLevel,
        picture: &PictureSettings,
    ) -> Result<(), RenderError> {
        let Self { look, lights, .. } = *self;
        Drawn { guide_count, points_per_strand, look, lights, picture }.check(level)
    }
}
