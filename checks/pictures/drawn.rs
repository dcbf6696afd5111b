//! A few guides drawn on either backend, up to the light that each point sends to the eye.

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::On;
use strandline_groom::{Groom, Guides};
use strandline_render::cpu::{
    Curves, Occlusion, Shadows, Strands, interpolate, opacity_depth, opacity_layers, shade, tessellate,
};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{BodyLook, Camera, FrameInput, LevelOfDetail, Light, Look, PictureSettings};

/// What is drawn.
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
    fn middle(&self) -> Vec3 {
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for strand in 0..self.guides.strand_count() {
            for point in 0..self.guides.points_per_strand() {
                let place = self.guides.position(strand, point);
                (low, high) = (low.min(place), high.max(place));
            }
        }
        0.5 * (low + high)
    }

    /// The curves of all guides: position \[m\], tangent and normal, shape `[guide][point]`.
    pub fn curves(&self, on: &On) -> [Vec<Vec3>; 3] {
        match on {
            On::Cpu => {
                let curves = self.curves_on_cpu();
                let all = (0..curves.guide_count)
                    .flat_map(|guide| (0..curves.points_per_curve).map(move |point| (guide, point)));
                [0, 1, 2].map(|which| {
                    all.clone().map(|(guide, point)| curves.point(guide, point)[which]).collect()
                })
            }
            On::Gpu(_) => self.on_gpu(on).curves().unwrap(),
        }
    }

    fn curves_on_cpu(&self) -> Curves {
        let mut curves = Curves::default();
        let level = self.detail.level(self.eye.distance(self.middle()), self.look.follow_strands);
        tessellate(self.guides.positions(), &self.guides, &Pose::IDENTITY, &level, &mut curves);
        curves
    }

    /// The drawn strands with their radiances.
    pub fn strands(&self, on: &On) -> Strands {
        let On::Cpu = on else { return self.on_gpu(on).strands().unwrap() };
        let curves = self.curves_on_cpu();
        let level = self.detail.level(self.eye.distance(self.middle()), self.look.follow_strands);
        let (mut strands, mut shadows) = (Strands::default(), Shadows::default());
        interpolate(&curves, &self.guides, &Pose::IDENTITY, &self.look, &level, &mut strands);
        opacity_depth(&strands, None, &self.lights, self.middle(), &self.look.shadow, &mut shadows);
        opacity_layers(&strands, &mut shadows);
        shade(&mut strands, &shadows, &self.lights, &self.look, self.eye, &mut Occlusion::default());
        strands
    }

    fn on_gpu(&self, on: &On) -> GpuRenderer {
        let On::Gpu(gpu) = on else { unreachable!("asked for on a GPU") };
        let settings = PictureSettings::sized(16, 16);
        let mut renderer = GpuRenderer::new(gpu, &self.guides, None, &settings).unwrap();
        let camera = Camera { position: self.eye, target: Vec3::ZERO, ..Camera::front() };
        renderer
            .draw(&FrameInput {
                positions: self.guides.positions(),
                world_from_head: Pose::IDENTITY,
                camera: &camera,
                look: &self.look,
                body_look: &BodyLook::default(),
                lights: &self.lights,
                level_of_detail: &self.detail,
            })
            .unwrap();
        renderer
    }
}
