//! A few guides drawn on either backend: the light that each point sends to the eye, and whole pictures.

use glam::Vec3;
use strandline_body::{BodyFrame, Mesh, Pose};
use strandline_checks::On;
use strandline_groom::{Groom, Guides};
use strandline_render::cpu::{
    Curves, Lit, Occlusion, Scattering, interpolate, opacity_depth, opacity_layers, shade, tessellate,
};
use strandline_render::fibre::FibreModel;
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, DetailLevel, FrameInput, FrameReport, LevelOfDetail, Light, Look, Picture,
    PictureSettings, Renderer,
};
use strandline_render::{OwnColors, Shadows, Strands};

/// Contents of a picture.
pub struct Drawn {
    pub guides: Guides,
    pub look: Look,
    pub lights: Vec<Light>,
    /// The eye \[m\].
    pub eye: Vec3,
    pub detail: LevelOfDetail,
}

/// Guides 80 um thick along polylines, resampled to so many points.
pub fn guides(lines: impl IntoIterator<Item = Vec<Vec3>>, points: usize) -> Guides {
    let mut groom = Groom::empty(8e-5);
    lines.into_iter().for_each(|line| groom.push(line));
    Guides::resample(&groom, points).unwrap()
}

impl Drawn {
    /// Middle of the box around the guides [m].
    pub fn middle(&self) -> Vec3 {
        0.5 * self.bounds().into_iter().sum::<Vec3>()
    }

    /// Least and greatest of the guides' coordinates [m].
    pub fn bounds(&self) -> [Vec3; 2] {
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for strand in 0..self.guides.strand_count() {
            for point in 0..self.guides.points_per_strand() {
                let place = self.guides.position(strand, point);
                (low, high) = (low.min(place), high.max(place));
            }
        }
        [low, high]
    }

    /// The curves of all guides: position \[m\], tangent and normal, shape `[guide][point]`.
    pub fn curves(&self, on: &On) -> [Vec<Vec3>; 3] {
        match on {
            On::Cpu => {
                let curves = self.curves_on_cpu(&self.guides);
                let all = (0..curves.guide_count)
                    .flat_map(|guide| (0..curves.points_per_curve).map(move |point| (guide, point)));
                [0, 1, 2].map(|which| {
                    all.clone().map(|(guide, point)| curves.point(guide, point)[which]).collect()
                })
            }
            On::Gpu(_) => self.on_gpu(on).curves().unwrap(),
        }
    }

    fn curves_on_cpu(&self, moved: &Guides) -> Curves {
        let mut curves = Curves::default();
        tessellate(moved.positions(), &self.guides, &Pose::IDENTITY, &self.level(), &mut curves);
        curves
    }

    fn level(&self) -> DetailLevel {
        let ([low, high], eye) = (self.bounds(), self.eye);
        let nearest = (low - eye).max(eye - high).max(Vec3::ZERO).length();
        self.detail.level_from(eye.distance(self.middle()), nearest, self.look.follow_strands)
    }

    /// The drawn strands with their radiances.
    pub fn strands(&self, on: &On) -> Strands {
        self.frames(on, std::slice::from_ref(&self.guides)).remove(0)
    }

    /// As [`Drawn::strands`], picture by picture: each frame has the guides' points where they have moved to.
    pub fn frames(&self, on: &On, frames: &[Guides]) -> Vec<Strands> {
        let On::Gpu(gpu) = on else { return frames.iter().map(|moved| self.frame_on_cpu(moved)).collect() };
        let mut renderer =
            GpuRenderer::new(gpu, &self.guides, None, &PictureSettings::sized(16, 16)).unwrap();
        let mut frame = |moved| {
            self.input(moved, |input| renderer.draw(input).unwrap());
            renderer.strands().unwrap()
        };
        frames.iter().map(&mut frame).collect()
    }

    fn frame_on_cpu(&self, moved: &Guides) -> Strands {
        let curves = self.curves_on_cpu(moved);
        let (mut strands, mut shadows) = (Strands::default(), Shadows::default());
        let (middle, look) = (self.middle(), &self.look);
        interpolate(&curves, &self.guides, &Pose::IDENTITY, look, &self.level(), &mut strands);
        opacity_depth(&strands, None, &self.lights, middle, &look.hair_shadow(), &mut shadows);
        opacity_layers(&strands, &mut shadows);
        let mut occlusion = Occlusion::default();
        occlusion.set_grid(middle, look.fibre.chiang.cells);
        let (lights, eye) = (&self.lights, self.eye);
        match look.fibre.model {
            FibreModel::Scheuermann => shade(&mut strands, &shadows, lights, look, eye, &mut occlusion),
            FibreModel::Chiang => {
                let own_colors = OwnColors::of(&self.guides);
                let own_colors = own_colors.as_ref();
                let lit = Lit { lights, shadows: &shadows, body: None, look, own_colors, eye };
                Scattering::default().shade(&mut strands, &lit, &mut occlusion);
            }
        }
        strands
    }

    /// The whole picture.
    pub fn picture(&self, on: &On, settings: &PictureSettings) -> Picture {
        self.reported(on, settings).0
    }

    /// The whole picture, and its drawn strands.
    pub fn reported(&self, on: &On, settings: &PictureSettings) -> (Picture, FrameReport) {
        self.on_body(on, settings, None)
    }

    /// The same on a body.
    pub fn on_body(
        &self,
        on: &On,
        settings: &PictureSettings,
        body: Option<&Mesh>,
    ) -> (Picture, FrameReport) {
        self.input(&self.guides, |input| match on {
            On::Cpu => Renderer::new(&self.guides, body, settings).unwrap().draw(input).unwrap(),
            On::Gpu(gpu) => GpuRenderer::new(gpu, &self.guides, body, settings).unwrap().draw(input).unwrap(),
        })
    }

    fn on_gpu(&self, on: &On) -> GpuRenderer {
        let On::Gpu(gpu) = on else { unreachable!("asked for on a GPU") };
        let settings = PictureSettings::sized(16, 16);
        let mut renderer = GpuRenderer::new(gpu, &self.guides, None, &settings).unwrap();
        self.input(&self.guides, |input| renderer.draw(input).unwrap());
        renderer
    }

    fn input<T>(&self, moved: &Guides, draw: impl FnOnce(&FrameInput) -> T) -> T {
        draw(&FrameInput {
            positions: moved.positions(),
            body: &BodyFrame::REST,
            camera: &Camera { position: self.eye, target: Vec3::ZERO, ..Camera::front() },
            look: &self.look,
            body_look: &BodyLook::default(),
            lights: &self.lights,
            level_of_detail: &self.detail,
        })
    }
}
