//! Renderer of a session, with view, look and lights.

use crate::{
    body::{Aabb, Mesh},
    gpu::Gpu,
    groom::Guides,
    render::{BodyLook, Camera, FrameInput, FrameReport, LevelOfDetail, Light, Look, Picture, RenderError},
    session::painter::Painter,
};

use super::moment::Moment;

#[cfg(feature = "gpu")]
use strandline_gpu::wgpu;

/// A renderer, with the view, the look and the lights of its pictures.
pub(crate) struct View {
    pub(super) guides: Guides,
    pub(super) bounds: Aabb,
    pub(super) painter: Painter,
    pub(super) camera: Camera,
    pub(super) look: Look,
    pub(super) lights: Vec<Light>,
    pub(super) body_look: BodyLook,
    pub(super) level_of_detail: LevelOfDetail,
}

impl View {
    /// The simulated strands at rest.
    pub fn guides(&self) -> &Guides {
        &self.guides
    }

    /// The box around hair and body at rest \[m\], head space.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The body that is drawn, head space.
    pub fn body(&self) -> Option<&Mesh> {
        self.painter.mesh()
    }

    /// The view.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The look of the hair.
    pub fn look(&self) -> &Look {
        &self.look
    }

    /// The lights.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The look of the body.
    pub fn body_look(&self) -> &BodyLook {
        &self.body_look
    }

    /// The rule by which detail follows distance and the size of a pixel.
    pub fn level_of_detail(&self) -> LevelOfDetail {
        self.level_of_detail
    }

    /// The device of the pictures; none on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.painter.gpu()
    }

    /// Device of the last picture, human-readable.
    pub fn drawn_on(&self) -> String {
        self.painter.drawn_on()
    }

    /// The opacity map of a light, and the depths of its first hair.
    pub fn maps(&self, light: usize) -> Result<Option<[Picture; 2]>, RenderError> {
        self.painter.maps(light)
    }

    /// Draws a moment from its points on their device, or on the host where `at_home`.
    pub fn draw(&mut self, moment: &Moment, at_home: bool) -> Result<(Picture, FrameReport), RenderError> {
        self.with_input(moment, |painter, input| {
            painter.draw(input, moment.device_points().filter(|_| !at_home))
        })
    }

    /// Draws a moment into a texture of the host.
    #[cfg(feature = "gpu")]
    pub fn draw_to(
        &mut self,
        moment: &Moment,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<FrameReport, RenderError> {
        self.with_input(moment, |painter, input| {
            painter.draw_to(input, moment.device_points(), target, format)
        })
    }

    /// Passes the painter the input of a moment's picture.
    fn with_input<T>(&mut self, moment: &Moment, draw: impl FnOnce(&mut Painter, &FrameInput) -> T) -> T {
        let origin = moment.origin;
        let camera = self.camera.seen_from(origin);
        let lights: Vec<Light> = self.lights.iter().map(|light| light.seen_from(origin)).collect();
        let input = FrameInput {
            positions: moment.positions(),
            body: &moment.body,
            camera: &camera,
            look: &self.look,
            body_look: &self.body_look,
            lights: &lights,
            level_of_detail: &self.level_of_detail,
        };
        draw(&mut self.painter, &input)
    }
}
