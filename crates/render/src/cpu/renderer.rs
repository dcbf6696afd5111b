//! Pictures on the CPU.

use std::sync::Arc;

use strandline_base::timed;
use strandline_body::{Mesh, Solids};
use strandline_groom::{Binding, Guides};

use super::frame::{FrameRun, Scratch};
use super::strands::bind::Carried;
use crate::frame::motion::Before;
use crate::frame::samples::Samples;
use crate::frame::{DrawnStrands, Stage, stages};
use crate::lights::{at_samples, first_sample};
use crate::strands::check_strands;
use crate::{FrameInput, FrameReport, Picture, PictureSettings, RenderError};

/// Draws frames of one groom on one body; keeps its buffers from frame to frame.
#[derive(Debug)]
pub struct Renderer {
    pub(super) scratch: Scratch,
    pub(super) settings: PictureSettings,
    layers_of: Option<usize>,
    /// The last picture with channels.
    pub(super) before: Option<Before>,
}

impl Renderer {
    /// A renderer of pictures of a groom's guides on a body in head space.
    ///
    /// # Errors
    /// A setting outside its range; a picture that would take too much memory.
    pub fn new(
        guides: &Guides,
        body: Option<&Mesh>,
        settings: &PictureSettings,
    ) -> Result<Self, RenderError> {
        let mut renderer =
            Self { scratch: Scratch::new(guides, body), settings: *settings, layers_of: None, before: None };
        renderer.set_picture(settings)?;
        Ok(renderer)
    }

    /// Changes size, supersampling, exposure, tone map or background from the next picture on.
    ///
    /// # Errors
    /// As for [`Renderer::new`]; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), RenderError> {
        settings.validate()?;
        self.settings = *settings;
        let scale = settings.supersampling;
        self.scratch.samples.resize((settings.width * scale) as usize, (settings.height * scale) as usize);
        Ok(())
    }

    /// Lets guides carry the renderer's strands, which are those of `binding`: the points of its pictures are from
    /// now on those of the guides, and all that is drawn stays out of the solids, between points and about them. The
    /// first span of a strand, which leads out of the skin, stays as it is.
    ///
    /// # Errors
    /// Strands that are not the renderer's.
    pub fn bind(&mut self, binding: &Arc<Binding>, solids: &Solids) -> Result<(), RenderError> {
        check_strands(&self.scratch.guides, binding)?;
        self.scratch.carried = Some(Carried::new(binding.clone(), solids.clone()));
        Ok(())
    }

    /// The size and tone of the pictures.
    pub fn picture(&self) -> &PictureSettings {
        &self.settings
    }

    /// Draws a picture.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken.
    pub fn draw(&mut self, input: &FrameInput) -> Result<(Picture, FrameReport), RenderError> {
        let mut picture = Picture::default();
        let report = self.draw_into(input, &mut picture)?;
        Ok((picture, report))
    }

    /// Draws a picture into one that is there, whose memory is used again.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken.
    pub fn draw_into(
        &mut self,
        input: &FrameInput,
        picture: &mut Picture,
    ) -> Result<FrameReport, RenderError> {
        input.validate()?;
        let look = input.look.drawn(input.lights, self.scratch.own_colors.as_ref(), &self.scratch.guides);
        let input = &FrameInput { look: &look, ..*input };
        let mut report = self.run(input, Some(picture))?;
        if self.settings.layers {
            let lights = at_samples(input.lights, input.look.suns());
            report.layers = Some(Arc::new(self.channels(&FrameInput { lights: &lights, ..*input })));
        }
        Ok(report)
    }

    /// Draws without the last stage: the samples can be looked at with [`Renderer::samples`].
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken.
    pub fn draw_samples(&mut self, input: &FrameInput) -> Result<FrameReport, RenderError> {
        input.validate()?;
        let look = input.look.drawn(input.lights, self.scratch.own_colors.as_ref(), &self.scratch.guides);
        self.run(&FrameInput { look: &look, ..*input }, None)
    }

    /// Runs the stages of a frame, the last where there is a picture for it.
    fn run(&mut self, input: &FrameInput, picture: Option<&mut Picture>) -> Result<FrameReport, RenderError> {
        input.validate()?;
        input.check_body(self.scratch.draw.vertex_count())?;
        let level = input.level(self.scratch.bounds, self.settings.height, &self.scratch.guides);
        let (strand_count, points) =
            (self.scratch.guides.strand_count(), self.scratch.guides.points_per_strand());
        // Places of lights with an area are counted there.
        input.check_memory(strand_count, points, &level, &self.settings)?;
        let lights = at_samples(input.lights, input.look.suns());
        let layers_of = self.layers_of.map(|light| first_sample(input.lights, light));
        let drawn = if self.scratch.carried.is_some() { DrawnStrands::Carried } else { DrawnStrands::Guides };
        let last = picture.is_some();
        let input = &FrameInput { lights: &lights, ..*input };
        let mut frame = FrameRun {
            scratch: &mut self.scratch,
            settings: &self.settings,
            input,
            level,
            layers_of,
            picture,
        };
        let mut report = FrameReport { strands: level.drawn_strands(strand_count), ..FrameReport::default() };
        for stage in stages(drawn).filter(|stage| last || *stage != Stage::Resolve) {
            timed(&mut report.seconds, stage.name(), || frame.run(stage));
        }
        report.segments = report.strands * (self.scratch.strands.points_per_strand - 1);
        Ok(report)
    }

    /// Colours hair by the layer of a light's opacity map in which it lies instead of lighting it, from the
    /// next picture on [Chen2011 fig. 8]: red, green and blue from the first layer to the third, grey behind
    /// it. `None`, the default, lights it, and so does a light without shadow.
    pub fn show_layers(&mut self, light: Option<usize>) {
        self.layers_of = light;
    }

    /// The opacity map of a light of the last picture [Chen2011 fig. 9]: the share of light that its first
    /// layer takes away as red, its first two as green, all three as blue, so that the first is white, the
    /// second cyan and the third blue. `None` for a light without shadow, for a number that no light has,
    /// and before the first picture.
    pub fn opacity_map(&self, light: usize) -> Option<Picture> {
        Some(self.scratch.shadows.map(light)?.opacity_picture())
    }

    /// The depth of the first hair in that map as grey, white the nearest; `None` as there.
    pub fn depth_map(&self, light: usize) -> Option<Picture> {
        Some(self.scratch.shadows.map(light)?.depth_picture())
    }

    /// The samples of the last picture, before `resolve`.
    pub fn samples(&self) -> &Samples {
        &self.scratch.samples
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_body::BodyFrame;
    use strandline_groom::Groom;

    use super::*;
    use crate::surroundings::Surroundings;
    use crate::{BodyLook, Camera, Coat, LevelOfDetail, Light, LightKind, Look};

    #[test]
    fn places_of_lights_and_suns_are_counted_once() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::Y]);
        let guides = Guides::resample(&groom, 4).unwrap();
        let mut renderer = Renderer::new(&guides, None, &PictureSettings::sized(16, 16)).unwrap();
        let surroundings = Surroundings { field: Default::default(), suns: vec![Light::default(); 2] };
        let mut look = Look { surroundings: Some(Arc::new(surroundings)), ..Look::brown() };
        look.shadow.map_size = 4096;
        let soft = Light { kind: LightKind::Rectangle, samples: 4, ..Light::default() };
        let input = FrameInput {
            positions: guides.positions(),
            body: &BodyFrame::REST,
            camera: &Camera::front(),
            look: &look,
            body_look: &BodyLook::default(),
            lights: &[soft; 3],
            level_of_detail: &LevelOfDetail::default(),
        };
        let error = renderer.draw(&input).unwrap_err().to_string();
        assert!(error.contains("4096 for each of 50 lights with shadow"), "{error}");
    }

    #[test]
    fn a_coat_outside_its_range_is_refused() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::Y]);
        let guides = Guides::resample(&groom, 4).unwrap();
        let mut renderer = Renderer::new(&guides, None, &PictureSettings::sized(16, 16)).unwrap();
        for pigment in [-1.0, f32::NAN] {
            let look = Look { coat: Coat { pigment, ..Coat::NONE }, ..Look::brown() };
            let input = FrameInput {
                positions: guides.positions(),
                body: &BodyFrame::REST,
                camera: &Camera::front(),
                look: &look,
                body_look: &BodyLook::default(),
                lights: &[],
                level_of_detail: &LevelOfDetail::default(),
            };
            let error = renderer.draw(&input).unwrap_err().to_string();
            assert!(error.contains("coat.pigment"), "{error}");
        }
    }

    #[test]
    fn only_lights_with_shadow_have_maps_and_only_after_a_picture() {
        let mut groom = Groom::empty(8e-5);
        groom.push((0..8).map(|point| Vec3::Y * (0.02 * point as f32)));
        let guides = Guides::resample(&groom, 8).unwrap();
        let mut renderer = Renderer::new(&guides, None, &PictureSettings::sized(16, 16)).unwrap();
        assert!(renderer.opacity_map(0).is_none());
        let look = Look { follow_strands: 1, ..Look::brown() };
        let input = FrameInput {
            positions: guides.positions(),
            body: &BodyFrame::REST,
            camera: &Camera::front(),
            look: &look,
            body_look: &BodyLook::default(),
            lights: &[Light::default(), Light { shadow: false, ..Light::default() }],
            level_of_detail: &LevelOfDetail::default(),
        };
        renderer.draw(&input).unwrap();
        let (opacity, depth) = (renderer.opacity_map(0).unwrap(), renderer.depth_map(0).unwrap());
        assert_eq!((opacity.width, opacity.height), (512, 512));
        let greys = |picture: &Picture| picture.pixels.iter().step_by(3).copied().collect::<Vec<u8>>();
        let (opacity, depth) = (greys(&opacity), greys(&depth));
        // Texels have sizes of steps of a quarter at most: the strand crosses four fifths of the 512, but
        // for a border. The picture of them is turned, and shows a part of a line that is a texel wide.
        let crossed =
            renderer.scratch.shadows.map(0).unwrap().texels().iter().filter(|texel| texel.x > 0.0).count();
        assert!(crossed >= 400, "{crossed}");
        // Texels without depth have no hair.
        assert!(opacity.iter().zip(&depth).all(|(opacity, depth)| (*opacity > 0) == (*depth > 0)));
        // White is its nearest point, 0.15 its farthest.
        assert_eq!(depth.iter().max(), Some(&255));
        // A texel shows its nearest hair, so the farthest may be a grey nearer than 38.
        let farthest = depth.iter().filter(|&&grey| grey > 0).min();
        assert!(matches!(farthest, Some(38 | 39)), "{farthest:?}");
        for light in [1, 2] {
            assert!(renderer.opacity_map(light).is_none() && renderer.depth_map(light).is_none());
        }
    }
}
