//! The neck of the built-in bust: the head's rotation, shared along it as a person's neck shares it.

use std::array;

use glam::{Mat3, Quat, Vec3};
use strandline_base::math;
use strandline_base::par::prelude::*;

use crate::{BodyFrame, Pose};

/// Slope of the planes across the neck, which rise toward the nape: level = y + SLOPE z.
pub(crate) const SLOPE: f32 = 0.5;
/// Levels \[m\] below which the skin stays with the shoulders and above which it moves with the head: under the collar
/// bones, and under jaw and hairline.
pub(crate) const LEVELS: [f32; 2] = [-0.200, -0.114];
/// Point \[m\] about which the lowest part bends: between the lowest vertebra of the neck and the uppermost of the chest.
const BASE: Vec3 = Vec3::new(0.0, -0.186, -0.028);
/// Exponent of the share of an axial rotation over that of a bend. Half-way up, at the fourth vertebra, a neck has
/// 0.49 of a bend and 0.29 of an axial rotation, most of which the two uppermost vertebrae make \[White1990\].
const AXIAL: f32 = 1.75;
/// Angles \[rad\]: the neck takes all of a rotation up to the first, and less of a greater one, none of half a turn.
const FREE: f32 = 1.31;
const HALF_TURN: f32 = std::f32::consts::PI;

/// Rigid parts that stand for the neck in contacts.
pub(crate) const SLICES: usize = 6;
/// Steps of the table of the bent skin.
const STEPS: usize = 128;
/// Vertices that a thread carries at a time.
const CHUNK: usize = 4096;

/// The neck of the built-in bust. Under a bend the shoulders stay, the head moves as one, and the skin between follows
/// smoothly.
///
/// Of a [`BodyFrame`] the pieces after the head are the shoulders and the rigid parts of the neck, the lowest first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neck {
    pivot: Vec3,
}

/// Rotation of a part in the space of the shoulders, and the point about which it turns \[m\].
struct Share {
    turn: Quat,
    about: Vec3,
}

impl Neck {
    /// Number of pieces after the head: the shoulders and the parts of the neck.
    pub const PIECES: usize = SLICES + 1;

    /// The neck below a head that turns about `pivot` \[m\], head space.
    pub fn new(pivot: Vec3) -> Self {
        Self { pivot }
    }

    /// The part of a rotation of the head that its shoulders make: none up to 75 degrees, all of half a turn.
    pub fn of_shoulders(rotation: Quat) -> Quat {
        let angle = angle_of(rotation);
        let left = ((angle - FREE) / (HALF_TURN - FREE)).clamp(0.0, 1.0);
        if left == 0.0 { Quat::IDENTITY } else { power(rotation, smooth(left)) }
    }

    /// Poses of the pieces after the head, `world_from_piece`, between those of the head and the shoulders.
    pub fn pieces(&self, head: &Pose, shoulders: &Pose) -> [Pose; Self::PIECES] {
        let bend = shoulders.rotation.conjugate() * head.rotation;
        array::from_fn(|piece| {
            let Some(slice) = piece.checked_sub(1).filter(|_| head != shoulders) else { return *shoulders };
            let Share { turn, about } = self.share(bend, (slice as f32 + 0.5) / SLICES as f32);
            let rotation = (shoulders.rotation * turn).normalize();
            Pose { rotation, translation: shoulders.point(about) - rotation * about }
        })
    }

    /// The share of a bend at a height of the neck, 0 to 1.
    fn share(&self, bend: Quat, height: f32) -> Share {
        let share = smooth(height);
        let axial = Quat::from_xyzw(0.0, bend.y, 0.0, bend.w);
        let axial = if axial.length_squared() > 0.0 { axial.normalize() } else { Quat::IDENTITY };
        let swing = bend * axial.conjugate();
        let turn = power(swing, share) * power(axial, math::powf(share, AXIAL));
        Share { turn, about: BASE.lerp(self.pivot, share) }
    }

    /// The bend of the neck in a frame of the body; `None` where the shoulders are where the head has them at rest.
    pub(crate) fn bend(&self, body: &BodyFrame) -> Option<Bend> {
        let (head, shoulders) = (body.world_from_head(), body.piece(1));
        (head != shoulders)
            .then(|| Bend { neck: *self, turn: shoulders.rotation.conjugate() * head.rotation })
    }
}

/// A bend of the neck: rotation of the head in the space of the shoulders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    neck: Neck,
    turn: Quat,
}

/// Carries places of the skin at rest of one height, head space.
#[derive(Clone, Copy)]
struct Carry {
    turn: Mat3,
    shift: Vec3,
}

impl Carry {
    fn point(&self, point: Vec3) -> Vec3 {
        self.turn * point + self.shift
    }
}

impl Bend {
    /// Fills positions \[m\] and unit normals of the skin, from those at rest, head space, into memory that is used again.
    pub fn skin(&self, rest: [&[Vec3]; 2], positions: &mut Vec<Vec3>, normals: &mut Vec<Vec3>) {
        let table = self.table();
        for (to, rest) in [&mut *positions, &mut *normals].into_iter().zip(rest) {
            to.clear();
            to.extend_from_slice(rest);
        }
        let chunks = positions.par_chunks_mut(CHUNK).zip(normals.par_chunks_mut(CHUNK));
        chunks.for_each(|(positions, normals)| {
            positions.iter_mut().zip(normals).for_each(|(position, normal)| carry(&table, position, normal));
        });
    }

    /// Carries places of the skin at rest \[m\], head space.
    pub fn places(&self, positions: &mut [Vec3]) {
        let table = self.table();
        positions.par_chunks_mut(CHUNK).for_each(|positions| {
            let mut normal = Vec3::Y;
            positions.iter_mut().for_each(|position| carry(&table, position, &mut normal));
        });
    }

    /// Places of the steps from the lowest level to the highest.
    fn table(&self) -> Vec<Carry> {
        (0..=STEPS).map(|step| self.carry(step as f32 / STEPS as f32)).collect()
    }

    fn carry(&self, height: f32) -> Carry {
        let pivot = self.neck.pivot;
        let back = self.turn.conjugate();
        let Share { turn, about } = self.neck.share(self.turn, height);
        let shift = pivot + back * (about - pivot - turn * about);
        Carry { turn: Mat3::from_quat(back * turn), shift }
    }
}

/// Carries a place of the skin and its normal by the shares of its height.
fn carry(table: &[Carry], position: &mut Vec3, normal: &mut Vec3) {
    let [low, high] = LEVELS;
    let step = ((level(*position) - low) / (high - low) * STEPS as f32).max(0.0);
    if step >= STEPS as f32 {
        return;
    }
    let (first, share) = (step as usize, step.fract());
    let [lower, upper] = [table[first], table[first + 1]];
    let [from, to] = [lower, upper].map(|carry| carry.point(*position));
    // The normal by the inverse of the transposed derivative: a turn, and a rank of one across the planes.
    let turned = (lower.turn * *normal).lerp(upper.turn * *normal, share);
    if step > 0.0 {
        let across = Vec3::new(0.0, 1.0, SLOPE) * (STEPS as f32 / (high - low));
        let across = (lower.turn * across).lerp(upper.turn * across, share);
        let way = to - from;
        let stretch = (1.0 + way.dot(across)).max(0.1);
        *normal = (turned - across * (way.dot(turned) / stretch)).normalize_or(turned);
    } else {
        *normal = turned;
    }
    *position = from.lerp(to, share);
}

/// Level \[m\] of a point across the neck.
pub(crate) fn level(point: Vec3) -> f32 {
    point.y + SLOPE * point.z
}

/// From 0 at 0 to 1 at 1, level at both ends.
fn smooth(share: f32) -> f32 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Angle \[rad\] of a rotation, 0 to half a turn.
fn angle_of(rotation: Quat) -> f32 {
    2.0 * math::atan2(rotation.xyz().length(), rotation.w.abs())
}

/// A share of a rotation about its axis, the short way.
fn power(rotation: Quat, share: f32) -> Quat {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    match rotation.xyz().try_normalize() {
        Some(axis) => math::rotation(axis, share * angle_of(rotation)),
        None => Quat::IDENTITY,
    }
}
