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

    /// A renderer of 64x64 channels, and the strands it draws.
    fn renderer(groom: &Groom) -> (Renderer, Guides) {
        let guides = Guides::resample(groom, 8).unwrap();
        let settings = PictureSettings { layers: true, ..PictureSettings::sized(64, 64) };
        (Renderer::new(&guides, None, &settings).unwrap(), guides)
    }

    /// The values of a channel.
    fn channel<'a>(layers: &'a Layers, name: &str) -> &'a [f32] {
        &layers.channels.iter().find(|(own, _)| own == name).unwrap().1
    }

    #[test]
    fn strands_keep_their_numbers_where_some_are_left_out() {
        // Sixteen strands beside each other, 1 mm wide, of which six of eight are left out.
        let mut groom = Groom::empty(0.001);
        let strand = |x: f32| (0..8).map(move |point| Vec3::new(x, 0.02 * point as f32 - 0.07, 0.0));
        (0..16).for_each(|index| groom.push(strand(0.01 * index as f32 - 0.075)));
        let (mut renderer, guides) = renderer(&groom);
        let look = Look { follow_strands: 1, hair_count: 0, tip_width: 1.0, ..Look::brown() };
        let camera = Camera { position: Vec3::Z * 0.5, target: Vec3::ZERO, ..Camera::front() };
        let few = LevelOfDetail { full_distance: 1e-3, least_strands: 0.25, ..LevelOfDetail::default() };
        let input = FrameInput {
            positions: guides.positions(),
            body: &BodyFrame::REST,
            camera: &camera,
            look: &look,
            body_look: &BodyLook::default(),
            lights: &[Light::default()],
            level_of_detail: &few,
        };
        let (_, report) = renderer.draw(&input).unwrap();
        assert_eq!(report.strands, 4);
        let layers = report.layers.unwrap();
        let numbers = channel(&layers, "strand.id").iter().map(|id| *id as usize).filter(|id| *id > 0);
        let found: std::collections::BTreeSet<usize> = numbers.collect();
        // Counted from 1: strands 0 and 4 of each eight.
        assert_eq!(found.into_iter().collect::<Vec<_>>(), [1, 5, 9, 13]);
        // Four strands lie 4 cm apart, of 27 cm that the picture is wide; each is 4 mm wide, a pixel.
        let column = |id: f32| channel(&layers, "strand.id").iter().position(|own| *own == id).unwrap() % 64;
        let apart = [5.0, 9.0, 13.0].map(|id| column(id) as f32 - column(1.0) as f32);
        let wanted = [0.04, 0.08, 0.12].map(|x: f32| 64.0 * x / 0.268);
        assert!(apart.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 2.0), "{apart:?}");
    }

    #[test]
    fn channels_say_what_a_strand_before_nothing_is() {
        // One strand, 5 cm wide, straight up in the middle, half a metre before the eye.
        let mut groom = Groom::empty(0.05);
        groom.push((0..8).map(|point| Vec3::Y * (0.02 * point as f32 - 0.07)));
        let (mut renderer, guides) = renderer(&groom);
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
        let of = |name: &str, at: usize| channel(&layers, name)[at];
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
