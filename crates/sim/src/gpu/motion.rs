//! Motion of the body through a step, as the kernels read it.

use glam::{Quat, Vec3};
use strandline_body::{BodyFrame, Carrier, Collider, Pose};
use strandline_gpu::{Rigid, mirror};

use crate::Model;

mirror! {
    /// A piece of the body through a step. Mirrors the rows of a piece in solids.wesl.
    pub(super) struct Piece {
        pub world_from_piece: Rigid,
        pub piece_from_world: Rigid,
        pub end_from_start: Rigid,
        pub start_from_end: Rigid,
        /// Turn through a part of the step, then start and way through a part \[m\].
        pub part_rotation: [f32; 4],
        pub start_translation: [f32; 4],
        pub part_translation: [f32; 4],
    }
}

mirror! {
    /// A root frame through a step. Mirrors the rows of a root in roots.wesl.
    pub(super) struct Root {
        /// Turn through a part of the step, then start and way through a part \[m\].
        pub part_rotation: [f32; 4],
        pub start_translation: [f32; 3],
        /// 1 where the frame moves, else 0.
        pub moves: f32,
        pub part_translation: [f32; 4],
        /// At the end of the step.
        pub rotation: [f32; 4],
        pub translation: [f32; 4],
    }
}

/// A pose through the parts of a step: its turn through one, its place at the start and its way through one \[m\].
pub(super) fn in_parts(start: &Pose, end: &Pose, parts: u32) -> (Quat, Vec3, Vec3) {
    let part = start.toward(end, 1.0 / parts as f32);
    let way = (end.translation - start.translation) / parts as f32;
    (part.rotation * start.rotation.inverse(), start.translation, way)
}

impl Piece {
    /// A piece that moves from one pose to another.
    pub fn new(start: &Pose, end: &Pose, parts: u32) -> Self {
        let (turn, from, way) = in_parts(start, end, parts);
        Self {
            world_from_piece: Rigid::from(end),
            piece_from_world: Rigid::from(&end.inverse()),
            end_from_start: Rigid::from(&start.motion_to(end)),
            start_from_end: Rigid::from(&end.motion_to(start)),
            part_rotation: turn.to_array(),
            start_translation: from.extend(0.0).to_array(),
            part_translation: way.extend(0.0).to_array(),
        }
    }
}

impl Root {
    /// A root frame that moves from one pose to another.
    pub fn new(start: &Pose, end: &Pose, parts: u32) -> Self {
        let (turn, from, way) = in_parts(start, end, parts);
        Self {
            part_rotation: turn.to_array(),
            start_translation: from.to_array(),
            moves: if start == end { 0.0 } else { 1.0 },
            part_translation: way.extend(0.0).to_array(),
            rotation: end.rotation.to_array(),
            translation: end.translation.extend(0.0).to_array(),
        }
    }
}

/// Parts of a step: those of rods, else one.
pub(super) fn part_count(model: &Model) -> u32 {
    if model.settings.has_rods() { model.settings.strands.rods.substeps } else { 1 }
}

/// True where strands have root frames of their own in a step between two frames of the body.
pub(super) fn has_roots(start: &BodyFrame, end: &BodyFrame) -> bool {
    start.roots().is_some() || end.roots().is_some()
}

/// Number of the body's pieces up to the last that carries a collider; the head always counts.
pub(super) fn piece_count(colliders: &[Collider]) -> usize {
    let last = |collider: &Collider| match collider.carrier {
        Carrier::Piece(piece) | Carrier::Moved(piece) => usize::from(piece),
        Carrier::World => 0,
    };
    1 + colliders.iter().map(last).max().unwrap_or(0)
}
