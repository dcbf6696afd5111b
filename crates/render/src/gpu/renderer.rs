use std::sync::Arc;

use glam::Vec3;
use strandline_base::SettingError;
use strandline_body::{Aabb, Mesh, Solids};
use strandline_gpu::{Buffer, Gpu, Recorder, Timer, wgpu};
use strandline_groom::{Binding, Guides, LaneSet};

use super::buffers::{Groom, MAX_POINTS, Maps, Strands, Targets, floats};
use super::channel_state::Channels;
use super::frame::{FrameKernels, KeptResources, record};
use super::resolve::{Own, PICTURE, ToFormat};
use super::scatter::light_grid::LightGrid;
use super::scene::Scene;
use super::shade::LayerColoring;
use super::skin::Skin;
use super::stages::{Kernels, Stages};
use super::strands::bound_solids::DeviceSolids;
use super::strands::{device_points::DevicePoints, points::GuidePoints, tessellate};
use super::{MAX_LIGHTS, MAX_SHADOWS, draw};
use crate::frame::bounds;
use crate::lights::at_samples;
use crate::scatter::source::{OwnColors, Source};
use crate::{FrameInput, FrameReport, Light, Picture, PictureSettings, RenderError, Shadow};

/// Draws frames of one groom on one body on a GPU; keeps its buffers from frame to frame.
pub struct GpuRenderer {
    pub(super) gpu: Gpu,
    pub(super) guides: Guides,
    /// Box around the guides at rest \[m\], head space.
    pub(super) bounds: Aabb,
    /// The body.
    pub(super) skin: Skin,
    pub(super) settings: PictureSettings,
    pub(super) kernels: Kernels,
    pub(super) groom: Groom,
    pub(super) strands: Option<Strands>,
    pub(super) maps: Option<Maps>,
    pub(super) targets: Targets,
    own: Option<Own>,
    formats: Vec<ToFormat>,
    pub(super) indices: Buffer<u32>,
    pub(super) stages: Option<Stages>,
    /// Scattered light, once a look asks for it.
    light_grid: Option<LightGrid>,
    points: GuidePoints,
    timer: Option<Timer>,
    layer_coloring: LayerColoring,
    pub(super) channels: Channels,
    pub(super) drawn: LastFrame,
    /// Lights, shadow settings and middle of the hair \[m\] in the last picture.
    pub(super) lit: (Vec<Light>, Shadow, Vec3),
    /// The guides' colours.
    pub(super) own_colors: Option<OwnColors>,
}

/// Contents of the last frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LastFrame {
    pub strands_per_guide: usize,
    /// Of each eight guides those whose strands are drawn; the device has room for all.
    pub lanes: LaneSet,
    pub curve_points: usize,
    pub shadows: usize,
}

impl LastFrame {
    /// Place on the device of a point of the drawn strands.
    pub fn place(&self, index: usize) -> usize {
        let per_guide = self.strands_per_guide * self.curve_points;
        self.lanes.strand(index / per_guide) * per_guide + index % per_guide
    }
}

impl GpuRenderer {
    /// A renderer of pictures of a groom's guides on a body in head space.
    ///
    /// # Errors
    /// A setting outside its range; whatever the device refuses, such as a picture or a groom that is too
    /// large for it.
    pub fn new(
        gpu: &Gpu,
        guides: &Guides,
        body: Option<&Mesh>,
        settings: &PictureSettings,
    ) -> Result<Self, RenderError> {
        settings.validate()?;
        let mut skin = Skin::new(body, guides);
        let groom = Groom::new(gpu, guides, &skin)?;
        skin.forget_surfaces();
        let made = Self {
            bounds: bounds(guides),
            settings: *settings,
            kernels: Kernels::new(gpu)?,
            groom,
            skin,
            strands: None,
            maps: None,
            targets: Targets::new(gpu, settings)?,
            own: None,
            formats: Vec::new(),
            indices: draw::indices(gpu)?,
            stages: None,
            light_grid: None,
            points: GuidePoints::default(),
            timer: Timer::new(gpu)?,
            layer_coloring: LayerColoring::default(),
            channels: Channels::default(),
            drawn: LastFrame::default(),
            lit: (Vec::new(), Shadow::default(), Vec3::ZERO),
            own_colors: OwnColors::of(guides),
            guides: guides.clone(),
            gpu: gpu.clone(),
        };
        gpu.check()?;
        Ok(made)
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The size and tone of the pictures.
    pub fn picture(&self) -> &PictureSettings {
        &self.settings
    }

    /// Changes size, supersampling, exposure, tone map or background from the next picture on.
    ///
    /// # Errors
    /// As for [`GpuRenderer::new`]; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), RenderError> {
        settings.validate()?;
        let size = |settings: &PictureSettings| (settings.width, settings.height, settings.supersampling);
        if size(settings) != size(&self.settings) {
            let targets = Targets::new(&self.gpu, settings)?;
            let bind = |format: &ToFormat| format.bind(&self.gpu, &self.groom, &targets);
            let bound = self.formats.iter().map(bind).collect::<Result<Vec<_>, _>>()?;
            for (format, bound) in self.formats.iter_mut().zip(bound) {
                format.bound = bound;
            }
            self.targets = targets;
            self.own = None;
            self.unbind();
        }
        self.settings = *settings;
        Ok(())
    }

    /// Lets guides carry the renderer's strands, which are those of `binding`: the points of its pictures are from
    /// now on those of the guides, and the device places the strands, out of the solids. A simulation may have these on
    /// the device already.
    ///
    /// # Errors
    /// Strands that are not the renderer's; whatever the device refuses.
    pub fn bind(
        &mut self,
        binding: &Arc<Binding>,
        solids: &Solids,
        on_device: Option<DeviceSolids>,
    ) -> Result<(), RenderError> {
        self.points.bind(&self.gpu, &self.groom, &self.guides, binding, (solids, on_device))
    }

    /// As [`Renderer::show_layers`](crate::Renderer::show_layers).
    pub fn show_layers(&mut self, light: Option<usize>) {
        self.layer_coloring.light = light;
    }

    /// Draws a picture.
    ///
    /// # Errors
    /// A setting outside its range; whatever the device refuses.
    pub fn draw(&mut self, input: &FrameInput) -> Result<(Picture, FrameReport), RenderError> {
        let mut picture = Picture::default();
        let report = self.draw_into(input, None, &mut picture)?;
        Ok((picture, report))
    }

    /// Draws a picture into one that is there, whose memory is used again. Guide points on the device
    /// stand for those of the input.
    ///
    /// # Errors
    /// As [`GpuRenderer::draw`].
    pub fn draw_into(
        &mut self,
        input: &FrameInput,
        points: Option<DevicePoints>,
        picture: &mut Picture,
    ) -> Result<FrameReport, RenderError> {
        self.gpu.check_wait("a picture in memory")?;
        input.validate()?;
        let look = input.look.drawn(input.lights, self.own_colors.as_ref(), &self.guides);
        let input = &FrameInput { look: &look, ..*input };
        let own = match self.own.take() {
            Some(own) => own,
            None => Own::new(&self.gpu, &self.settings)?,
        };
        let drawn = self.submit(input, points, own.texture.view(), PICTURE, Some(&own));
        let own = self.own.insert(own);
        let (report, submission) = drawn?;
        let seconds = own.read(submission, self.timer.as_ref(), self.settings.transparent, picture)?;
        let layers = if self.settings.layers { Some(Arc::new(self.channels(input)?)) } else { None };
        Ok(FrameReport { seconds, layers, ..report })
    }

    /// Draws into a texture of the host's, of the picture's size and seen in a format, and does not wait for
    /// it: the report has neither times nor layers.
    ///
    /// # Errors
    /// As [`GpuRenderer::draw`]; a texture of another size.
    pub fn draw_to(
        &mut self,
        input: &FrameInput,
        points: Option<DevicePoints>,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<FrameReport, RenderError> {
        let texture = target.texture();
        if [texture.width(), texture.height()] != [self.settings.width, self.settings.height] {
            let found = format!("{} x {}", texture.width(), texture.height());
            let expected = "the width and height of the picture";
            return Err(SettingError::new("the target texture", found, expected).into());
        }
        Ok(self.submit(input, points, target, format, None)?.0)
    }

    fn submit(
        &mut self,
        input: &FrameInput,
        points: Option<DevicePoints>,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
        own: Option<&Own>,
    ) -> Result<(FrameReport, wgpu::SubmissionIndex), RenderError> {
        input.validate()?;
        let (given, lights) = (input.lights, at_samples(input.lights, input.look.suns()));
        input.validate()?;
        let look = input.look.drawn(input.lights, self.own_colors.as_ref(), &self.guides);
        let input = &FrameInput { look: &look, lights: &lights, ..*input };
        self.points.check(&self.gpu, &self.groom, input, points)?;
        input.check_body(self.skin.vertex_count())?;
        self.skin.take(input.body, &self.groom.vertices)?;
        self.points.take(&self.groom, &self.guides, input.body)?;
        let settings = self.settings;
        let scene = self.scene(input, &settings, points.map_or(1.0, |points| points.share));
        self.prepare(&scene)?;
        self.prepare_format(format)?;
        self.write(&scene, points.is_none())?;
        let (Some(stages), Some(maps), Some(strands)) = (&self.stages, &self.maps, &self.strands) else {
            unreachable!("prepared above")
        };
        let (gpu, groom, count) = (&self.gpu, &self.groom, scene.strand_count());
        let bound = self.points.stages(gpu, groom, points)?;
        let tessellate = self.points.tessellate(gpu, &self.kernels.tessellate, groom, strands, points)?;
        let keep_outside = self.points.keep_outside(gpu, groom, strands, count)?;
        let layer_colors = self.layer_coloring.bind(gpu, given, groom, strands, maps)?;
        let resolve =
            &self.formats.iter().find(|known| known.format == format).expect("prepared above").bound;
        let bounds = FrameKernels {
            bound,
            tessellate,
            keep_outside,
            layer_colors,
            resolve,
            maps,
            target,
            held: self.held(stages),
        };
        let submission = self.gpu.ask("a frame", || {
            let mut recorder = Recorder::new(&self.gpu, self.timer.as_ref());
            self.timer.iter().for_each(Timer::restart);
            record(&mut recorder, &scene, &bounds);
            let commands = recorder.finish(|encoder| {
                if let Some(own) = own {
                    own.copy(encoder, self.timer.as_ref());
                }
            });
            self.gpu.queue().submit([commands])
        })?;
        self.note(&scene);
        let strands = scene.level.drawn_strands(scene.guide_count);
        let segments = strands * (scene.curve_points() - 1);
        Ok((FrameReport { strands, segments, ..FrameReport::default() }, submission))
    }

    /// Remembers what a frame drew.
    fn note(&mut self, scene: &Scene) {
        self.drawn = LastFrame {
            strands_per_guide: scene.level.strand_count(),
            curve_points: scene.curve_points(),
            shadows: scene.shadow_count(),
            lanes: scene.level.drawn_lanes(),
        };
        self.lit.0.clear();
        self.lit.0.extend_from_slice(scene.input.lights);
        (self.lit.1, self.lit.2) = (scene.input.look.hair_shadow(), scene.middle);
    }

    /// State kept from frame to frame, with the stages bound.
    pub(super) fn held<'a>(&'a self, stages: &'a Stages) -> KeptResources<'a> {
        KeptResources {
            groom: &self.groom,
            stages,
            light_grid: self.light_grid.as_ref(),
            indices: &self.indices,
            samples: &self.targets,
        }
    }

    /// Makes room for a frame, and binds the stages where that changed.
    pub(super) fn prepare(&mut self, scene: &Scene) -> Result<(), RenderError> {
        let limit = |what, found: usize, most: usize| {
            if found > most { Err(RenderError::TooMany { what, found, most }) } else { Ok(()) }
        };
        let shadows = scene.shadow_count();
        limit("lights", scene.input.lights.len(), MAX_LIGHTS)?;
        limit("lights with shadow", shadows, MAX_SHADOWS)?;
        // Room for full detail, so that a change of distance asks for memory once: the first time that hair is close.
        let full = scene.input.fullest(&scene.level, &self.guides);
        let curve_points = (full.segment_count(scene.guide_points) + 1).max(scene.curve_points());
        let strands_per_guide = full.strand_count().max(scene.level.strand_count());
        let points = scene.guide_count * strands_per_guide * curve_points;
        limit("points of strands", points, MAX_POINTS)?;
        if self.strands.as_ref().is_none_or(|strands| {
            strands.strands_per_guide < strands_per_guide || strands.curve_points < curve_points
        }) {
            self.forget();
            self.points.forget();
            self.strands = None;
            self.strands = Some(Strands::new(&self.gpu, scene.guide_count, strands_per_guide, curve_points)?);
        }
        let size = scene.input.look.shadow.size();
        if self.maps.as_ref().is_none_or(|maps| maps.size != size || maps.shadows < shadows) {
            self.forget();
            self.maps = None;
            self.maps = Some(Maps::new(&self.gpu, size, shadows.max(1))?);
        }
        if self.stages.is_none()
            && let (Some(strands), Some(maps)) = (&self.strands, &self.maps)
        {
            let Self { gpu, kernels, groom, targets, .. } = &*self;
            self.stages = Some(Stages::new(gpu, kernels, groom, strands, maps, targets)?);
        }
        if scene.input.look.fibre.model.scatters_many_times() {
            self.prepare_light(Source::new(scene.input.look, self.own_colors.as_ref()))?;
        }
        Ok(())
    }

    /// Makes room for scattered light, and the fibre's tables.
    fn prepare_light(&mut self, source: Source) -> Result<(), RenderError> {
        if self.light_grid.is_none() {
            self.light_grid = Some(LightGrid::new(&self.gpu)?);
        }
        if let (Some(grid), Some(strands), Some(maps)) = (&mut self.light_grid, &self.strands, &self.maps) {
            grid.prepare(&self.gpu, source, &self.groom, strands, maps, &self.targets)?;
        }
        Ok(())
    }

    /// The last picture is lost with its buffers.
    fn forget(&mut self) {
        self.unbind();
        self.drawn = LastFrame::default();
        self.lit.0.clear();
    }

    /// The stages are bound anew for the next picture.
    fn unbind(&mut self) {
        self.stages = None;
        self.light_grid.iter_mut().for_each(LightGrid::forget);
    }

    fn prepare_format(&mut self, format: wgpu::TextureFormat) -> Result<(), RenderError> {
        if self.formats.iter().all(|known| known.format != format) {
            self.formats.push(ToFormat::new(&self.gpu, format, &self.groom, &self.targets)?);
        }
        Ok(())
    }

    /// Writes what the host knows of a frame.
    pub(super) fn write(&self, scene: &Scene, host_points: bool) -> Result<(), RenderError> {
        let Some(strands) = &self.strands else { unreachable!("made before") };
        let groom = &self.groom;
        groom.write_frame(scene)?;
        groom.bounds.write(&Groom::no_bounds())?;
        let clump = &scene.input.look.clump;
        strands.tables.write(&tessellate::tables(scene.guide_points, &scene.level, clump))?;
        let level = &scene.level;
        let scales: Vec<f32> = (0..level.strand_count()).map(|index| level.width_scale(index)).collect();
        strands.scales.write(&scales)?;
        if host_points {
            self.points.of_host(groom).write(floats(scene.input.positions))?;
        }
        Ok(())
    }
}
