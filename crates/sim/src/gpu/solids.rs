//! The colliders as the kernels read them.

use strandline_body::{BodyFrame, Collider, SkinTable, solid_rows};
use strandline_gpu::{Buffer, Gpu, GpuError};

use super::inputs::Step;
use super::motion::{Piece, part_count, piece_count};
use crate::{Model, SimError};

/// Vectors of a piece behind the head, which lie before the headers.
const PIECE: usize = size_of::<Piece>() / size_of::<[f32; 4]>();

/// Writes the pieces behind the head for a step between two frames of the body.
///
/// # Errors
/// The device was lost.
pub(super) fn write_pieces(
    buffer: &Buffer<Step>,
    model: &Model,
    [start, end]: [&BodyFrame; 2],
) -> Result<(), GpuError> {
    let count = piece_count(&model.colliders);
    if count == 1 {
        return Ok(());
    }
    let parts = part_count(model);
    let piece = |piece| Piece::new(&start.piece(piece), &end.piece(piece), parts);
    buffer.write_tail(&(1..count).map(piece).collect::<Vec<_>>())
}

/// Brings the skins to a step between two frames of the body. Returns one more than the row of the header of one that
/// moves by itself, 0 without one, and the most way \[m\] of a vertex.
///
/// # Errors
/// The device was lost.
pub(super) fn write_skins(
    (buffer, skins): (&Buffer<Step>, &mut SkinTable),
    colliders: &[Collider],
    [start, end]: [&BodyFrame; 2],
) -> Result<(u32, f32), GpuError> {
    let written = skins.between(start, end);
    if !written.is_empty() {
        let (all, [base, _]) = rows(buffer, colliders);
        for (first, rows) in written {
            all.write_at(base + first, &rows)?;
        }
    }
    let header = skins.moving().map_or(0, |header| header as u32 + 1);
    Ok((header, skins.most_shift()))
}

/// Room for the settings of a step, and behind it the pieces behind the head, then the rows of all colliders; the skins
/// among these.
pub(super) fn behind_step(gpu: &Gpu, colliders: &[Collider]) -> Result<(Buffer<Step>, SkinTable), SimError> {
    let before = PIECE * (piece_count(colliders) - 1);
    let mut all = vec![[0; 4]; before];
    // Pictures on the same device read the clearance.
    let solids = colliders.iter().map(|collider| (collider, collider.shape.clearance()));
    let (mut rows, skins) = solid_rows(solids, before)?;
    all.append(&mut rows);
    let buffer = Buffer::with_tail::<[u32; 4]>(gpu, "step and solids", 1, all.len())?;
    buffer.write_tail(&all)?;
    Ok((buffer, skins))
}

/// The rows of the colliders where they lie: the buffer, the first row to which they count, and the first collider's row
/// from there.
pub(super) fn rows(buffer: &Buffer<Step>, colliders: &[Collider]) -> (Buffer<[u32; 4]>, [usize; 2]) {
    let base = size_of::<Step>() / size_of::<[u32; 4]>();
    (buffer.viewed_as(), [base, PIECE * (piece_count(colliders) - 1)])
}
