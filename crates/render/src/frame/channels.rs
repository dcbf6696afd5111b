//! A picture as channels: linear light, depth, coverage, directions and strands.

use glam::{Vec3, Vec4};

use super::Renderer;
use crate::cpu::draw::known::{body_depths, depths, nearest_strands};
use crate::cpu::shade::skin::Skin;
use crate::cpu::{DrawInput, Radiances, Strands, resolve_linear};
use crate::{BodyLook, Environment, FrameInput, Layers, PictureSettings};

/// What is known of every pixel, on either backend; shape `[row][column]`.
pub(crate) struct Known {
    /// Radiance times opacity, and opacity.
    pub light: Vec<Vec4>,
    /// Share of the pixel that hair covers, and times that its depth along the view \[m\].
    pub covered: Vec<Vec4>,
    /// Tangent of the hair times the share that it covers.
    pub directions: Vec<Vec4>,
    /// Depth along the view \[m\] of the body, 0 where there is none.
    pub bodies: Vec<f32>,
    /// Number of the nearest strand, from 1, 0 where there is none.
    pub strands: Vec<f32>,
}

/// What is drawn to know it: a skin that is black, with no light from anywhere.
pub(crate) const BLACK: BodyLook =
    BodyLook { color: Vec3::ZERO, wrap: 0.0, specular: 0.0, roughness: 0.5, scalp: 0.0 };

impl Known {
    /// The channels of a picture.
    pub fn layers(self, settings: &PictureSettings) -> Layers {
        let Self { light, covered, directions, bodies, strands } = self;
        let depth = |(hair, body): (&Vec4, &f32)| {
            if hair.x >= 0.5 || (*body == 0.0 && hair.x > 0.0) { hair.y / hair.x } else { *body }
        };
        let tangent = |(way, hair): (&Vec4, &Vec4)| way.truncate() / hair.x.max(1e-6);
        let tangents: Vec<Vec3> = directions.iter().zip(&covered).map(tangent).collect();
        let of_light = |pick: fn(&Vec4) -> f32| light.iter().map(pick).collect::<Vec<f32>>();
        let of_tangents = |pick: fn(&Vec3) -> f32| tangents.iter().map(pick).collect::<Vec<f32>>();
        let channels = [
            ("R", of_light(|pixel| pixel.x)),
            ("G", of_light(|pixel| pixel.y)),
            ("B", of_light(|pixel| pixel.z)),
            ("A", of_light(|pixel| pixel.w)),
            ("depth.Z", covered.iter().zip(&bodies).map(depth).collect()),
            ("mask.hair", covered.iter().map(|pixel| pixel.x).collect()),
            ("tangent.X", of_tangents(|way| way.x)),
            ("tangent.Y", of_tangents(|way| way.y)),
            ("tangent.Z", of_tangents(|way| way.z)),
            ("strand.id", strands),
        ];
        Layers {
            width: settings.width,
            height: settings.height,
            channels: channels.map(|(name, values)| (name.to_owned(), values)).into(),
        }
    }
}

impl Renderer {
    /// The picture that was drawn last, from the same input, as channels: see [`Layers`]. The strands' light is lost.
    pub(super) fn channels(&mut self, input: &FrameInput) -> Layers {
        let settings = self.settings;
        let scale = settings.supersampling as usize;
        let depths = depths(&self.strands, input.camera, &self.samples);
        let known = Known {
            light: resolve_linear(&self.samples, &settings),
            strands: nearest_strands(&self.strands, input.camera, &self.samples, scale),
            bodies: body_depths(&self.samples, scale),
            covered: self.with_numbers(input, |_, point| Vec3::new(1.0, depths[point], 0.0)),
            directions: self.with_numbers(input, |strands, point| strands.tangents[point]),
        };
        known.layers(&settings)
    }

    /// Hair drawn over nothing, with numbers in the place of its light, before a black body.
    fn with_numbers(&mut self, input: &FrameInput, number: impl Fn(&Strands, usize) -> Vec3) -> Vec<Vec4> {
        let numbers = (0..self.strands.positions.len()).map(|point| number(&self.strands, point)).collect();
        self.strands.radiances = numbers;
        let draw_input = DrawInput {
            strands: &self.strands,
            light: Radiances::Known(&self.strands),
            camera: input.camera,
            background: None,
            supersampling: self.settings.supersampling,
            round: false,
        };
        let skin = Skin {
            look: &BLACK,
            lights: &[],
            shadows: &self.shadows,
            occlusion: &self.occlusion,
            scalp: Vec3::ONE,
            grid: None,
            environment: &Environment { sky: Vec3::ZERO, ground: Vec3::ZERO },
            eye: input.camera.position,
        };
        self.draw.draw(&draw_input, &skin, &mut self.samples);
        resolve_linear(&self.samples, &PictureSettings { transparent: true, ..self.settings })
    }
}

#[cfg(test)]
mod tests {
    use strandline_body::BodyFrame;
    use strandline_groom::{Groom, Guides};

    use crate::{Camera, LevelOfDetail, Light, Look};

    use super::*;

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
        assert_eq!([of("mask.hair", corner), of("depth.Z", corner), of("strand.id", corner)], [0.0; 3]);
        assert!((0..64 * 64).any(|at| of("strand.id", at) == 1.0));
        // Light is there too, and hair is lit.
        assert!(of("R", middle) > 0.0 && of("A", corner) == 1.0);
        assert_eq!(renderer.draw(&input).unwrap().0, renderer.draw(&input).unwrap().0);
    }
}
