//! What draws, and everything that is drawn but the hair itself.

use crate::{
    Error,
    body::Aabb,
    groom::Guides,
    painter::Painter,
    render::{BodyLook, Camera, FrameInput, FrameReport, LevelOfDetail, Light, Look, Picture, RenderError},
    sim::SimError,
};

use super::moment::Moment;

/// What draws, and everything that is drawn but the hair itself.
pub(crate) struct Studio {
    pub guides: Guides,
    pub bounds: Aabb,
    pub painter: Painter,
    pub camera: Camera,
    pub look: Look,
    pub lights: Vec<Light>,
    pub body_look: BodyLook,
    pub level_of_detail: LevelOfDetail,
}

impl Studio {
    /// Draws a moment where its points are: on their device, or from the host where `at_home`.
    fn draw_from(&mut self, moment: &Moment, at_home: bool) -> Result<(Picture, FrameReport), RenderError> {
        let input = FrameInput {
            positions: moment.positions(),
            world_from_head: moment.world_from_head,
            camera: &self.camera,
            look: &self.look,
            body_look: &self.body_look,
            lights: &self.lights,
            level_of_detail: &self.level_of_detail,
        };
        self.painter.draw(&input, moment.device_points().filter(|_| !at_home))
    }

    /// Draws a moment; where the GPU fails, and that is allowed, on the CPU: `bring_home` then has the points.
    pub fn draw(
        &mut self,
        moment: &mut Moment,
        bring_home: impl FnOnce(&mut Moment) -> Result<(), SimError>,
    ) -> Result<(Picture, FrameReport), Error> {
        let failure = match self.draw_from(moment, false) {
            Ok(drawn) => return Ok(drawn),
            Err(failure) => failure,
        };
        self.painter.recover_from(failure)?;
        bring_home(moment)?;
        Ok(self.draw_from(moment, true)?)
    }
}
