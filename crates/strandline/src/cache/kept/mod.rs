//! Kept frames of a timeline as a file of a project: frames, the tasks that led to them, and states to go on from.
//!
//! The file is a .npz: `times`, `world_from_head`, the lists of bodies and `points` have a row for each frame, shape
//! `[frame, block x point, 3, lane]`; `mark_N_state_*` are the arrays of a state, as in a moving cache; `meta` is JSON.

mod meta;
mod read;
mod write;

pub(crate) use meta::{DirectionNote, FileSum, FrameNote, MarkNote, Meta, TaskNote};
pub(crate) use read::KeptFile;
pub(crate) use write::write;

use crate::groom::Vec3Lanes;

/// Prefix of the arrays of a state.
fn prefix(mark: usize) -> String {
    format!("mark_{mark}_")
}

/// Points as bytes, in the order of the file.
pub(crate) fn point_bytes(points: &[Vec3Lanes]) -> Vec<u8> {
    let numbers = points.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten();
    numbers.flat_map(f32::to_le_bytes).collect()
}
