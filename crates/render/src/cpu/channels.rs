//! A picture as channels: the values that frame/channels.rs arranges.

use glam::{Vec3, Vec4};

use super::Renderer;
use super::shade::skin::Skin;
use super::{DrawInput, Radiances};
use crate::frame::channels::{BLACK, Known};
use crate::frame::filter::resolve_linear;
use crate::frame::known::{body_depths, depths, nearest_strands};
use crate::frame::motion::{Before, Motion};
use crate::strands::Strands;
use crate::{Environment, FrameInput, Layers, PictureSettings};

impl Renderer {
    /// The picture that was drawn last, from the same input, as channels: see [`Layers`]. The strands' light is lost.
    pub(super) fn channels(&mut self, input: &FrameInput) -> Layers {
        let settings = self.settings;
        let scale = settings.supersampling as usize;
        let depths = depths(&self.scratch.strands, input.camera, &self.scratch.samples);
        let bodies = body_depths(&self.scratch.samples, scale);
        let motion = Motion::new(self.before.as_ref(), input, &settings);
        let (motions, body_motions) =
            (motion.of_points(&self.scratch.strands.positions), motion.of_body(&bodies));
        self.before = Some(Before::new(input, self.scratch.strands.positions.clone()));
        let known = Known {
            light: resolve_linear(&self.scratch.samples, &settings),
            strands: nearest_strands(&self.scratch.strands, input.camera, &self.scratch.samples, scale),
            bodies,
            body_motions,
            covered: self.with_numbers(input, |_, point| Vec3::new(1.0, depths[point], 0.0)),
            directions: self.with_numbers(input, |strands, point| strands.tangents[point]),
            motions: self.with_numbers(input, |_, point| motions[point]),
        };
        known.layers(&settings)
    }

    /// Hair drawn over nothing, with numbers in the place of its light, before a black body.
    fn with_numbers(&mut self, input: &FrameInput, number: impl Fn(&Strands, usize) -> Vec3) -> Vec<Vec4> {
        let numbers = (0..self.scratch.strands.positions.len())
            .map(|point| number(&self.scratch.strands, point))
            .collect();
        self.scratch.strands.radiances = numbers;
        let draw_input = DrawInput {
            strands: &self.scratch.strands,
            light: Radiances::Known(&self.scratch.strands),
            camera: input.camera,
            background: None,
            supersampling: self.settings.supersampling,
            round: false,
        };
        let skin = Skin {
            look: &BLACK,
            lights: &[],
            shadows: &self.scratch.shadows,
            occlusion: &self.scratch.occlusion,
            scalp: Vec3::ONE,
            grid: None,
            environment: &Environment { sky: Vec3::ZERO, ground: Vec3::ZERO },
            eye: input.camera.position,
        };
        self.scratch.draw.draw(&draw_input, &skin, &mut self.scratch.samples);
        resolve_linear(&self.scratch.samples, &PictureSettings { transparent: true, ..self.settings })
    }
}

#[cfg(test)]
mod tests {
    use strandline_body::BodyFrame;
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::{BodyLook, Camera, LevelOfDetail, Light, Look};

    #[test]
    fn channels_say_what_a_strand_before_nothing_is() {
        // One strand, 5 cm wide, straight up in the middle, half a metre before the eye.
        let mut groom = Groom::empty(0.05);
        groom.push((0..8).map(|point| Vec3::Y * (0.02 * point as f32 - 0.07)));
        let guides = Guides::resample(&groom, 8).unwrap();
        let settings = PictureSettings { layers: true, ..PictureSettings::sized(64, 64) };
        let mut renderer = Renderer::new(&guides, None, &settings).unwrap();
        let look = Look { follow_strands: 1, hair_count: 0, tip_width: 1.0, ..Look::brown() };
        let camera = Camera { position: Vec3::Z * 0.5, target: Vec3::ZERO, ..Camera::front() };
        let input = FrameInput {
            positions: guides.positions(),
            body: &BodyFrame::REST,
            camera: &camera,
            look: &look,
            body_look: &BodyLook::default(),
            lights: &[Light::default()],
            level_of_detail: &LevelOfDetail::default(),
        };
        let (_, report) = renderer.draw(&input).unwrap();
        let layers = report.layers.unwrap();
        let of = |name: &str, at: usize| {
            layers.channels.iter().find(|(own, _)| own == name).map(|(_, values)| values[at]).unwrap()
        };
        let (middle, corner) = (32 * 64 + 32, 0);
        assert!((of("mask.hair", middle) - 1.0).abs() < 1e-3, "{}", of("mask.hair", middle));
        assert!((of("depth.Z", middle) - 0.5).abs() < 1e-3, "{}", of("depth.Z", middle));
        assert!((of("tangent.Y", middle) - 1.0).abs() < 1e-3, "{}", of("tangent.Y", middle));
        assert_eq!([of("mask.hair", corner), of("strand.id", corner)], [0.0; 2]);
        assert_eq!(of("depth.Z", corner), f32::INFINITY);
        assert!((0..64 * 64).any(|at| of("strand.id", at) == 1.0));
        // Light is there too, and hair is lit.
        assert!(of("R", middle) > 0.0 && of("A", corner) == 1.0);
        assert_eq!(renderer.draw(&input).unwrap().0, renderer.draw(&input).unwrap().0);
    }
}
