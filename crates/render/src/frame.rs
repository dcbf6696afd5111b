pub(crate) mod channels;
mod input;

pub use input::FrameInput;

use std::sync::Arc;

use glam::Vec3;
use strandline_base::timed;
use strandline_body::{Aabb, Mesh, Solids};
use strandline_groom::Guides;

use crate::cpu::shade::skin::Skin;
use crate::cpu::strands::scalp::root_densities;
use crate::cpu::{
    Curves, Draw, DrawInput, Found, Lit, Occlusion, OwnColors, Radiances, Resolve, Samples, Scattering,
    Scheuermann, Seen, Shading, Shadows, Strands, interpolate, keep_outside, layer_colors, opacity_depth,
    opacity_layers, tessellate,
};
use crate::fibre::FibreModel;
use crate::lights::{at_samples, first_sample};
use crate::{DetailLevel, Layers, Picture, PictureSettings, RenderError};

/// Wall-clock seconds of each stage.
type Seconds = Vec<(&'static str, f64)>;

/// What a picture cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Strands drawn, guides among them.
    pub strands: usize,
    /// Segments drawn.
    pub segments: usize,
    /// Wall-clock seconds of each stage, in order.
    pub seconds: Vec<(&'static str, f64)>,
    /// Linear light and more, where `picture.layers` asks for it.
    pub layers: Option<Arc<Layers>>,
}

/// Draws frames of one groom on one body; keeps its buffers from frame to frame.
#[derive(Debug)]
pub struct Renderer {
    guides: Guides,
    /// What curves stay out of.
    solids: Solids,
    /// Box around the guides at rest [m], head space.
    bounds: Aabb,
    settings: PictureSettings,
    curves: Curves,
    strands: Strands,
    shadows: Shadows,
    occlusion: Occlusion,
    scattering: Scattering,
    found: Found,
    layers_of: Option<usize>,
    /// The guides' colours.
    own_colors: Option<OwnColors>,
    samples: Samples,
    draw: Draw,
    resolve: Resolve,
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
        let mut renderer = Self {
            guides: guides.clone(),
            solids: Solids::default(),
            bounds: bounds(guides),
            curves: Curves::default(),
            settings: *settings,
            strands: Strands::default(),
            shadows: Shadows::default(),
            occlusion: Occlusion::default(),
            scattering: Scattering::default(),
            found: Found::default(),
            layers_of: None,
            own_colors: OwnColors::of(guides),
            samples: Samples::default(),
            draw: Draw::new(body.cloned()),
            resolve: Resolve::default(),
        };
        let densities = body.map(|body| root_densities(&body.positions, guides));
        renderer.draw.set_roots(densities.unwrap_or_default());
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
        self.samples.resize((settings.width * scale) as usize, (settings.height * scale) as usize);
        Ok(())
    }

    /// Keeps all that is drawn of strands out of solids, between their points and about them, from the next picture on. The first span of a strand, which leads out of the skin, stays as it is.
    pub fn keep_outside(&mut self, solids: Solids) {
        self.solids = solids;
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
        let mut report = self.draw_samples(input)?;
        timed(&mut report.seconds, "resolve", || {
            self.resolve.resolve(&self.samples, &self.settings, picture);
        });
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
        let (given, lights) = (input, at_samples(input.lights, input.look.suns()));
        let layers_of = self.layers_of.map(|light| first_sample(input.lights, light));
        let input = &FrameInput { lights: &lights, ..*input };
        let middle = input.body.world_from_head().point(middle(self.bounds));
        let level = input.level(self.bounds, self.settings.height, &self.guides);
        // It counts the places of the lights itself.
        let (strand_count, points) = (self.guides.strand_count(), self.guides.points_per_strand());
        given.check_memory(strand_count, points, &level, &self.settings)?;
        let mut times = Vec::new();
        let seconds = &mut times;
        self.lay_strands(input, &level, middle, seconds);
        let own_colors = self.own_colors;
        let Self { strands, shadows, occlusion, scattering, found, draw, samples, settings, .. } = self;
        occlusion.set_grid(middle, input.look.fibre.grid_cells());
        let (lights, look, eye) = (input.lights, input.look, input.camera.position);
        let map = layers_of.and_then(|light| shadows.map(light));
        let layered = map.map(|map| layer_colors(strands, map)).is_some();
        let (strands, shadows) = (&*strands, &*shadows);
        let lit = Lit { lights, shadows, body: None, look, own_colors: own_colors.as_ref(), eye };
        timed(seconds, "shade", || {
            let body = draw.shadow_body().map(|body| (body, input.body_look.color));
            prepare_light(strands, &Lit { body, ..lit }, occlusion, scattering);
            found.begin(strands);
        });
        let shading = shading(strands, &lit, occlusion, scattering);
        let light = match shading.as_deref() {
            Some(shading) if !layered => Radiances::Seen(Seen::new(strands, found, shading)),
            _ => Radiances::Known(strands),
        };
        let draw_input = DrawInput {
            strands,
            light,
            camera: input.camera,
            background: (!settings.transparent).then_some(settings.background),
            supersampling: settings.supersampling,
            round: !layered,
        };
        let skin = Skin {
            look: input.body_look,
            lights,
            shadows,
            occlusion,
            scalp: look.scalp(input.body_look.scalp, own_colors.map(|own| own.mean)),
            grid: look.fibre.model.scatters_many_times().then(|| scattering.grid()),
            environment: &look.gradient(),
            eye,
        };
        timed(seconds, "draw", || draw.draw(&draw_input, &skin, samples));
        let count = level.drawn_strands(strand_count);
        let segments = count * (strands.points_per_strand - 1);
        Ok(FrameReport { strands: count, segments, seconds: times, layers: None })
    }

    /// Finds all drawn strands, and what every light sees of them; `middle` is the middle of their box \[m\].
    fn lay_strands(&mut self, input: &FrameInput, level: &DetailLevel, middle: Vec3, seconds: &mut Seconds) {
        let Self { guides, solids, curves, strands, shadows, draw, .. } = self;
        let pose = &input.body.world_from_head();
        timed(seconds, "tessellate", || tessellate(input.positions, guides, pose, level, curves));
        timed(seconds, "interpolate", || {
            interpolate(curves, guides, pose, input.look, level, strands);
            keep_outside(strands, curves, guides.points_per_strand(), &solids.placed(input.body));
        });
        timed(seconds, "opacity_depth", || {
            draw.place_body(*pose);
            let (body, shadow) = (draw.shadow_body(), &input.look.hair_shadow());
            opacity_depth(strands, body, input.lights, middle, shadow, shadows);
        });
        timed(seconds, "opacity_layers", || opacity_layers(strands, shadows));
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
        Some(self.shadows.map(light)?.opacity_picture())
    }

    /// The depth of the first hair in that map as grey, white the nearest; `None` as there.
    pub fn depth_map(&self, light: usize) -> Option<Picture> {
        Some(self.shadows.map(light)?.depth_picture())
    }

    /// The samples of the last picture, before `resolve`.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }
}

/// What the light of every point needs of all the others, by the model of its fibre.
fn prepare_light(strands: &Strands, lit: &Lit, occlusion: &mut Occlusion, scattering: &mut Scattering) {
    match lit.look.fibre.model {
        FibreModel::Scheuermann => occlusion.fill(strands, &lit.look.shadow),
        FibreModel::Chiang => scattering.prepare(strands, lit, occlusion),
    }
}

/// How the light of a point is found then.
fn shading<'a>(
    strands: &'a Strands,
    lit: &'a Lit,
    occlusion: &'a Occlusion,
    scattering: &'a Scattering,
) -> Option<Box<dyn Shading + 'a>> {
    let Lit { shadows, lights, look, eye, .. } = *lit;
    match look.fibre.model {
        FibreModel::Scheuermann => {
            Some(Box::new(Scheuermann::new(strands, shadows, lights, look, eye, occlusion)))
        }
        FibreModel::Chiang => Some(Box::new(scattering.shading(strands, lit, occlusion)?)),
    }
}

/// Middle of a box \[m\].
pub(crate) fn middle(bounds: Aabb) -> Vec3 {
    0.5 * (bounds.min + bounds.max)
}

/// The box around all guide points \[m\].
pub(crate) fn bounds(guides: &Guides) -> Aabb {
    let points = (0..guides.strand_count())
        .flat_map(|strand| (0..guides.points_per_strand()).map(move |point| guides.position(strand, point)));
    let (min, max) =
        points.fold((Vec3::MAX, Vec3::MIN), |(min, max), point| (min.min(point), max.max(point)));
    Aabb { min, max }
}

#[cfg(test)]
mod tests {
    use strandline_groom::Groom;

    use strandline_body::BodyFrame;

    use super::*;
    use crate::surroundings::Surroundings;
    use crate::{BodyLook, Camera, LevelOfDetail, Light, LightKind, Look};

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
        assert_eq!((opacity.width, opacity.height), (look.shadow.map_size, look.shadow.map_size));
        let greys = |picture: &Picture| picture.pixels.iter().step_by(3).copied().collect::<Vec<u8>>();
        let (opacity, depth) = (greys(&opacity), greys(&depth));
        // Texels have sizes of steps of a quarter at most: the strand crosses four fifths of the 512, but
        // for a border. The picture of them is turned, and shows a part of a line that is a texel wide.
        let crossed = renderer.shadows.map(0).unwrap().texels().iter().filter(|texel| texel.x > 0.0).count();
        assert!(crossed >= 400, "{crossed}");
        // What has no depth has no hair.
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
