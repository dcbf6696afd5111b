//! The thesis's fibre: a function of directions, fitted to how hair looks.
//!
//! Diffuse light about the strand \[Kajiya1989\] and two highlights from shifted tangents, the second one
//! coloured \[Scheuermann2004\]. Each part is scaled so that it never gives back more than it takes.

mod settings;

use std::f32::consts::PI;

use glam::Vec3;
use strandline_base::math;
use strandline_base::vec3x8::Vec3x8;
use wide::f32x8;

pub use settings::{Highlight, Scheuermann};

use crate::fast_math::exp_lanes;

/// Ratio of the light sent back to the light sent onward; 1 sends nothing straight on.
const BACKWARD: f32 = 0.8;

/// The model with its settings worked out, the same for both backends.
#[derive(Clone, Copy)]
pub(crate) struct Numbers {
    /// Shift, sharpness and peak of both highlights: see [`Lobe`].
    pub highlights: [[f32; 3]; 2],
    /// Share of the light that highlights leave.
    pub diffuse: f32,
    pub translucency: f32,
}

impl Scheuermann {
    /// Settings as the shading needs them.
    pub(crate) fn numbers(&self) -> Numbers {
        let share = 1.0 - self.first_highlight.strength - self.second_highlight.strength;
        Numbers {
            highlights: [lobe(&self.first_highlight), lobe(&self.second_highlight)],
            diffuse: share.max(0.0),
            translucency: self.translucency,
        }
    }
}

fn lobe(highlight: &Highlight) -> [f32; 3] {
    // Both directions turn, so a sum of sines is twice as wide as the highlight.
    let deviation = 2.0 * math::sin(highlight.width.to_radians());
    [
        2.0 * math::sin(highlight.shift.to_radians()),
        -0.5 / (deviation * deviation),
        highlight.strength * PI / (deviation * (2.0 * PI).sqrt()),
    ]
}

/// A highlight as shading needs it.
#[derive(Clone, Copy)]
struct Lobe {
    /// Sum of the sines of both directions with the strand at which the highlight is brightest.
    shift: f32x8,
    /// Factor of the squared sum in the exponent.
    sharpness: f32x8,
    /// Peak, times pi since lights are given as the radiance of a white surface.
    peak: f32x8,
}

impl Lobe {
    fn new(numbers: [f32; 3]) -> Self {
        let [shift, sharpness, peak] = numbers.map(f32x8::splat);
        Self { shift, sharpness, peak }
    }

    /// Brightness for a sum of sines, before the turn about the strand; `jitter` moves the highlight.
    #[inline]
    fn at(&self, sum: f32x8, jitter: f32x8) -> f32x8 {
        let away = sum - self.shift - jitter;
        self.peak * exp_lanes(self.sharpness * away * away)
    }
}

/// Light of eight points at a time.
#[derive(Clone, Copy)]
pub(crate) struct Lobes {
    first: Lobe,
    second: Lobe,
    diffuse_over_pi: f32x8,
    translucency: f32x8,
}

/// Radiance over that of a white surface that faces the light.
pub(crate) struct Scattered {
    /// To be coloured with the hair's reflectance.
    pub(crate) diffuse: f32x8,
    /// White highlight.
    pub(crate) first: f32x8,
    /// Highlight to be coloured with light that crossed the hair.
    pub(crate) second: f32x8,
}

impl Lobes {
    pub(crate) fn new(fibre: &Scheuermann) -> Self {
        let Numbers { highlights: [first, second], diffuse, translucency } = fibre.numbers();
        Self {
            first: Lobe::new(first),
            second: Lobe::new(second),
            diffuse_over_pi: f32x8::splat(diffuse / PI),
            translucency: f32x8::splat(translucency),
        }
    }

    /// Share of the diffuse light that comes through hair of an extinction, a logarithm: bright hair passes on more of
    /// what meets it, in its own colour.
    #[inline]
    pub(crate) fn passed(&self, tint: Vec3x8, extinction: f32x8) -> Vec3x8 {
        let dull = (Vec3x8::same(f32x8::splat(1.0)) - tint * self.translucency) * extinction;
        Vec3x8 { x: exp_lanes(dull.x), y: exp_lanes(dull.y), z: exp_lanes(dull.z) }
    }

    /// Light scattered from `to_light` to `to_eye` by strands of unit `tangent`, root to tip.
    #[inline]
    pub(crate) fn scatter(
        &self,
        tangent: Vec3x8,
        to_light: Vec3x8,
        to_eye: Vec3x8,
        jitter: f32x8,
    ) -> Scattered {
        let (zero, one) = (f32x8::splat(0.0), f32x8::splat(1.0));
        let sine_light = tangent.dot(to_light);
        let sine_eye = tangent.dot(to_eye);
        let cosine_light = (one - sine_light * sine_light).max(zero).sqrt();
        let cosine_eye = (one - sine_eye * sine_eye).max(zero).sqrt();
        // Turn about the strand from the light to the eye.
        let across = (cosine_light * cosine_eye).max(f32x8::splat(1e-4));
        let turn = ((to_light.dot(to_eye) - sine_light * sine_eye) / across).max(-one).min(one);
        let facing = (f32x8::splat(0.5) + f32x8::splat(0.5) * turn).max(zero);
        let sum = sine_light + sine_eye;
        // Over a full turn cos(turn / 2) / 4 and (1 + cos turn)^2 / (3 pi) sum to 1, like the mirror on a
        // smooth cylinder and the reflection from its back wall [Marschner2003].
        let first = self.first.at(sum, jitter) * cosine_light * facing.sqrt() * f32x8::splat(0.25);
        let second =
            self.second.at(sum, jitter) * cosine_light * facing * facing * f32x8::splat(4.0 / (3.0 * PI));
        // [Kajiya1989 eq. 14]: the sine between strand and light, over pi so that a hair in even light from
        // all around shows that light times its reflectance.
        let back = one + f32x8::splat(BACKWARD) * turn;
        let diffuse = cosine_light * back * self.diffuse_over_pi;
        Scattered { diffuse, first, second }
    }
}

/// Radiance of one point over that of a white surface, with `color` for diffuse light and `tint` for the second highlight.
pub fn reflectance(
    fibre: &Scheuermann,
    color: Vec3,
    tint: Vec3,
    tangent: Vec3,
    to_light: Vec3,
    to_eye: Vec3,
) -> Vec3 {
    let [tangent, to_light, to_eye] = [tangent, to_light, to_eye].map(Vec3x8::splat);
    let scattered = Lobes::new(fibre).scatter(tangent, to_light, to_eye, f32x8::splat(0.0));
    let [diffuse, first, second] =
        [scattered.diffuse, scattered.first, scattered.second].map(|lanes| lanes.to_array()[0]);
    color * diffuse + Vec3::splat(first) + tint * second
}
