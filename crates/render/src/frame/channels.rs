//! A picture as channels: linear light, depth, coverage, directions, motion and strands.

use glam::{Vec2, Vec3, Vec4};

use crate::{BodyLook, Layers, PictureSettings};

/// Values of every pixel, found on either backend; shape `[row][column]`.
pub(crate) struct Known {
    /// Radiance times opacity, and opacity.
    pub light: Vec<Vec4>,
    /// Share of the pixel that hair covers, and times that its depth along the view \[m\].
    pub covered: Vec<Vec4>,
    /// Tangent of the hair times the share that it covers.
    pub directions: Vec<Vec4>,
    /// Depth along the view \[m\] of the body, 0 where there is none.
    pub bodies: Vec<f32>,
    /// Displacement \[pixel\] of the hair since the picture before times the share that it covers.
    pub motions: Vec<Vec4>,
    /// Motion of the body, 0 where there is none.
    pub body_motions: Vec<Vec2>,
    /// Number of the nearest strand, from 1, 0 where there is none.
    pub strands: Vec<f32>,
}

/// The skin that is drawn to find them: black, with no light from anywhere.
pub(crate) const BLACK: BodyLook = BodyLook {
    materials: false,
    color: Vec3::ZERO,
    wrap: 0.0,
    softness: 0.0,
    oil: 0.0,
    specular: 0.0,
    roughness: 0.5,
    scalp: 0.0,
};

impl Known {
    /// The channels of a picture.
    pub fn layers(self, settings: &PictureSettings) -> Layers {
        let Self { light, covered, directions, bodies, motions, body_motions, strands } = self;
        let is_hair = |covered: f32, body: f32| covered >= 0.5 || (body == 0.0 && covered > 0.0);
        let depth = |(hair, body): (&Vec4, &f32)| match (hair.x, *body) {
            (covered, body) if is_hair(covered, body) => hair.y / covered,
            (_, 0.0) => f32::INFINITY,
            (_, body) => body,
        };
        let motion = |((hair, body), (own, of_body)): ((&Vec4, &f32), (&Vec4, &Vec2))| {
            if is_hair(hair.x, *body) { own.truncate().truncate() / hair.x } else { *of_body }
        };
        let motions: Vec<Vec2> =
            covered.iter().zip(&bodies).zip(motions.iter().zip(&body_motions)).map(motion).collect();
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
            ("motion.X", motions.iter().map(|motion| motion.x).collect()),
            ("motion.Y", motions.iter().map(|motion| motion.y).collect()),
            ("strand.id", strands),
        ];
        Layers {
            width: settings.width,
            height: settings.height,
            channels: channels.map(|(name, values)| (name.to_owned(), values)).into(),
        }
    }
}
