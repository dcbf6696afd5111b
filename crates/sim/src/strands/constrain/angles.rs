//! Bends: a limit and a pull toward the rest shape.
//!
//! A frame travels along the strand from its root frame. From one segment to the next it turns by
//! the least rotation that takes the expected direction of the segment to the one it has, so it
//! does not twist about the strand [Wang2008; Bergou2008 §4.2.2], and the rest direction that it
//! carries keeps every bend of a curl in its plane.

use glam::Quat;
use strandline_base::math;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::settings::Angles;
use strandline_base::vec3x8::{Vec3x8, lanes, load, splat};

/// Rounds of length constraints from one pass over the angles to the next. A pass costs about as
/// much as two rounds and lengths, not angles, need the many rounds: an angle correction is local
/// and the frames carry it to the tip within one pass.
pub const ROUNDS_PER_PASS: u32 = 5;

/// The bends of a step.
#[derive(Clone, Copy)]
pub struct Bends {
    cos_limit: f32x8,
    sin_limit: f32x8,
    share: f32x8,
    root: Turn,
}

/// Share of the gap to the rest shape that a pass over the bends closes.
pub(crate) fn bend_share(angles: &Angles, time_step: f32, iterations: u32) -> f32 {
    // One backward Euler step of a spring of this frequency closes this share of the gap; the
    // passes of a step share it, so that their number does not matter.
    let turn = (angles.stiffness * time_step).powi(2);
    let left = 1.0 / (1.0 + turn);
    let passes = iterations.div_ceil(ROUNDS_PER_PASS);
    1.0 - math::powf(left, 1.0 / passes as f32)
}

/// One block of strands as bends see it.
#[derive(Clone, Copy)]
pub struct Joints<'a> {
    /// Rest directions, head space.
    pub directions: &'a [Vec3Lanes],
    pub inverse_mass: &'a [Lanes],
}

impl Bends {
    /// `None` when bends are free.
    pub fn new(angles: &Angles, time_step: f32, iterations: u32, head: Quat) -> Option<Self> {
        if angles.is_off() {
            return None;
        }
        Some(Self {
            cos_limit: splat(math::cos(angles.limit)),
            sin_limit: splat(math::sin(angles.limit)),
            share: splat(bend_share(angles, time_step, iterations)),
            root: Turn::splat(head),
        })
    }

    /// The bends of a block of strands with these rotations of their root frames.
    pub fn with_roots(self, rotations: [Quat; LANES]) -> Self {
        let scalar = f32x8::from(rotations.map(|rotation| rotation.w));
        Self { root: Turn { vector: lanes(rotations.map(|rotation| rotation.xyz())), scalar }, ..self }
    }

    /// One pass from root to tip.
    ///
    /// A joint moves three points by (1, -2, 1), so that it changes neither the momentum nor the
    /// angular momentum of the strand.
    pub fn project(&self, joints: Joints, positions: &mut [Vec3Lanes]) {
        let mut frame = self.root;
        let mut before = Vec3x8::load(&positions[0]);
        let mut joint = Vec3x8::load(&positions[1]);
        let mut weight_before = load(&joints.inverse_mass[0]);
        let mut weight_joint = load(&joints.inverse_mass[1]);
        for point in 1..positions.len() - 1 {
            let mut after = Vec3x8::load(&positions[point + 1]);
            let weight_after = load(&joints.inverse_mass[point + 1]);
            let expected = frame.apply(Vec3x8::load(&joints.directions[point]));
            let segment = after - joint;
            let length = segment.length();
            let gap = self.gap(expected, segment * (splat(1.0) / length)) * length;
            let weights = weight_before + splat(4.0) * weight_joint + weight_after;
            let push = gap * (splat(1.0) / weights.fast_max(splat(1e-30)));
            before += push * weight_before;
            joint -= push * (weight_joint + weight_joint);
            after += push * weight_after;
            before.store(&mut positions[point - 1]);
            let turned = after - joint;
            frame = frame.then_from_to(expected, turned * (splat(1.0) / turned.length()));
            (before, joint) = (joint, after);
            (weight_before, weight_joint) = (weight_joint, weight_after);
        }
        let last = positions.len() - 1;
        before.store(&mut positions[last - 1]);
        joint.store(&mut positions[last]);
    }

    /// Motion of a unit direction: into the cone about `expected`, then a share of the way.
    #[inline(always)]
    fn gap(&self, expected: Vec3x8, direction: Vec3x8) -> Vec3x8 {
        let cos = expected.dot(direction);
        let aside = direction - expected * cos;
        let on_cone = expected * self.cos_limit + aside * (self.sin_limit / aside.length());
        let allowed = on_cone.or(cos.simd_lt(self.cos_limit), direction);
        (allowed - direction) + (expected - allowed) * self.share
    }
}

/// A rotation in each lane, unit quaternion.
#[derive(Clone, Copy)]
struct Turn {
    vector: Vec3x8,
    scalar: f32x8,
}

impl Turn {
    fn splat(rotation: Quat) -> Self {
        Self { vector: Vec3x8::splat(rotation.xyz()), scalar: splat(rotation.w) }
    }

    #[inline(always)]
    fn apply(self, direction: Vec3x8) -> Vec3x8 {
        let half = self.vector.cross(direction);
        let twice = half + half;
        direction + twice * self.scalar + self.vector.cross(twice)
    }

    /// Turns on by the least rotation between two unit directions.
    #[inline(always)]
    fn then_from_to(self, from: Vec3x8, to: Vec3x8) -> Self {
        // Opposite directions leave the axis open; the small number turns about nothing then.
        let scalar = splat(1.0 + 1e-6) + from.dot(to);
        let vector = from.cross(to);
        let turned = Self {
            vector: self.vector * scalar + vector * self.scalar + vector.cross(self.vector),
            scalar: scalar * self.scalar - vector.dot(self.vector),
        };
        let norm = turned.vector.dot(turned.vector) + turned.scalar * turned.scalar;
        let scale = splat(1.0) / norm.sqrt();
        Self { vector: turned.vector * scale, scalar: turned.scalar * scale }
    }
}
