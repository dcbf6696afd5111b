//! Placement of a file's points in head space.

use glam::{Quat, Vec3};
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
pub(super) struct Placings {
    pub groom: Placing,
    pub body: Placing,
    /// Choices that were made.
    pub note: Option<String>,
}
