//! Placement of a file's points in head space.

use glam::{Quat, Vec3};
use serde::Serialize;
use strandline_base::math;

use crate::{
    body::{Aabb, Mesh},
    groom::format::Up,
};

/// Placement of a file's points in head space: scaled, then turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placing {
    pub scale: f32,
    pub turn: Quat,
}

impl Placing {
    /// Head space already.
    pub const IDENTITY: Self = Self { scale: 1.0, turn: Quat::IDENTITY };

    /// True for a place at which hair looks otherwise: turned, or of another size.
    pub fn differs(&self, other: &Self) -> bool {
        self.is_turned_from(other) || (self.scale / other.scale - 1.0).abs() > 0.1
    }

    /// True for a place with other axes.
    pub fn is_turned_from(&self, other: &Self) -> bool {
        self.turn.angle_between(other.turn) > 0.01
    }
}

/// Rotation from a file whose given axis points up to y up.
pub(super) fn upright(up: Up) -> Quat {
    up.rotation()
}

/// Places a mesh: scaled and turned as guessed, then turned and moved as a scene says.
pub(super) fn place_mesh(mesh: &mut Mesh, placing: Placing, turn: Vec3, translation: Vec3) {
    let turn = math::pitch_yaw_roll(turn) * placing.turn;
    for position in &mut mesh.positions {
        *position = turn * (placing.scale * *position) + translation;
    }
    for normal in &mut mesh.normals {
        *normal = turn * *normal;
    }
}

/// The length of the diagonal of a box.
pub(super) fn diagonal(bounds: Aabb) -> f32 {
    bounds.min.distance(bounds.max)
}

/// Placements of the groom files of a scene, which share theirs, and of its body's files.
#[derive(Clone)]
pub(super) struct Placings {
    pub groom: Placing,
    pub body: Placing,
    /// True where the groom was made for another head, which it is fitted to.
    pub is_foreign: bool,
    /// Confidence in the choices, 0 to 1.
    pub confidence: f32,
    /// Another place of the groom for which nearly as much speaks.
    pub rival: Option<Placing>,
    /// True where the groom is placed otherwise than the format of its file defines.
    pub is_against: bool,
    /// True where no axes and no unit bring the groom to the body.
    pub is_away: bool,
    /// The reason to refuse the placement, with the setting that decides.
    pub refusal: Option<String>,
    /// Choices that were made, and what speaks against them.
    pub notes: Vec<String>,
}

impl Placings {
    /// Head space already, with a confidence.
    pub fn new(confidence: f32) -> Self {
        Self {
            groom: Placing::IDENTITY,
            body: Placing::IDENTITY,
            is_foreign: false,
            confidence,
            rival: None,
            is_against: false,
            is_away: false,
            refusal: None,
            notes: Vec::new(),
        }
    }
}

/// The placement of a groom and a body in head space, as it was given or chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Placement {
    /// Confidence in it, 0 to 1: 1 where files and settings leave nothing open.
    pub confidence: f32,
    /// Metres of a unit of the groom's file.
    pub groom_scale: f32,
    /// Rotation of the groom's file into head space before that of the scene: a quaternion x, y, z, w.
    pub groom_rotation: [f32; 4],
    /// Metres of a unit of the body's file.
    pub body_scale: f32,
    /// Rotation of the body's file into head space before that of the scene: a quaternion x, y, z, w.
    pub body_rotation: [f32; 4],
    /// True where the groom was made for another head, and is fitted to this one.
    pub is_fitted: bool,
}

impl Placings {
    /// The placement as it is reported.
    pub fn placement(&self) -> Placement {
        Placement {
            confidence: self.confidence,
            groom_scale: self.groom.scale,
            groom_rotation: self.groom.turn.to_array(),
            body_scale: self.body.scale,
            body_rotation: self.body.turn.to_array(),
            is_fitted: self.is_foreign,
        }
    }
}

/// Definitions that the format of a body's file makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Defined {
    Nothing,
    /// Metres and y up.
    Up,
    /// Metres, y up and the front along +z.
    All,
}
