//! Strands drawn where a check wants them on the screen, without any look.

use glam::Vec3;
use strandline_body::{BodyFrame, Mesh};
use strandline_render::cpu::shade::skin::Skin;
use strandline_render::cpu::{Draw, DrawInput, Occlusion, Radiances};
use strandline_render::{BodyLook, Camera, Environment};
use strandline_render::{Samples, Shadows, Strands};

/// Distance \[m\] of the plane z = 0 from the camera.
pub const DISTANCE: f32 = 1.0;

/// A picture of `size` x `size` pixels.
pub struct Screen {
    /// Width and height \[pixel\].
    pub size: usize,
    /// Samples along each axis of a pixel.
    pub supersampling: u32,
}

impl Screen {
    fn camera() -> Camera {
        Camera { position: Vec3::Z * DISTANCE, target: Vec3::ZERO, field_of_view: 30.0, ..Camera::front() }
    }

    /// Size of a sample \[m\] in the plane z = 0.
    pub fn sample(&self) -> f32 {
        let height = 2.0 * DISTANCE * 15_f32.to_radians().tan();
        height / (self.size as f32 * self.supersampling as f32)
    }

    /// The point \[m\] in the plane z = 0 seen at a place \[sample\].
    pub fn point(&self, x: f32, y: f32) -> Vec3 {
        let middle = 0.5 * self.size as f32 * self.supersampling as f32;
        Vec3::new(x - middle, middle - y, 0.0) * self.sample()
    }

    /// The samples of a picture of strands, before a background, on a body that is black.
    pub fn draw(&self, strands: &Strands, body: Option<Mesh>) -> Samples {
        let mut samples = Samples::default();
        let side = self.size * self.supersampling as usize;
        samples.resize(side, side);
        let input = DrawInput {
            strands,
            light: Radiances::Known(strands),
            camera: &Self::camera(),
            background: None,
            supersampling: self.supersampling,
            round: false,
        };
        let skin = Skin {
            look: &BodyLook { color: Vec3::ZERO, specular: 0.0, ..BodyLook::default() },
            lights: &[],
            shadows: &Shadows::default(),
            occlusion: &Occlusion::default(),
            scalp: Vec3::ONE,
            grid: None,
            environment: &Environment { sky: Vec3::ZERO, ground: Vec3::ZERO },
            eye: Vec3::Z * DISTANCE,
        };
        let mut draw = Draw::new(body);
        draw.place_body(&BodyFrame::REST);
        draw.draw(&input, &skin, &mut samples);
        samples
    }
}

/// White strands, all with the same number of points, of one width \[m\].
pub fn white(lines: &[Vec<Vec3>], width: f32) -> Strands {
    let mut strands = Strands::default();
    strands.resize(lines.len(), 1, lines[0].len());
    strands.positions = lines.concat();
    strands.widths.fill(width);
    strands.radiances.fill(Vec3::ONE);
    strands
}

/// A line between two points, cut into equal segments.
pub fn line(start: Vec3, end: Vec3, segments: usize) -> Vec<Vec3> {
    (0..=segments).map(|point| start.lerp(end, point as f32 / segments as f32)).collect()
}

/// Opacity of all samples together.
pub fn covered(samples: &Samples) -> f64 {
    samples.colors.iter().map(|color| f64::from(color.w)).sum()
}
