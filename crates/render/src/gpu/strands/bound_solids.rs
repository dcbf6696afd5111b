//! Solids that bound strands stay out of and the body that carries them, as the kernels read them.

use strandline_body::{BodyFrame, Carrier, Solids, solid_rows};
use strandline_gpu::{Buffer, Gpu, GpuError, Rigid};

use crate::RenderError;

/// Rows of a piece behind the head: `world_from_piece`, `piece_from_world`.
const PIECE: usize = 6;

/// The rows on the device; solid_rows.wesl names them.
pub(crate) struct BoundSolids {
    rows: Buffer<[u32; 4]>,
    guide_count: usize,
    solid_count: usize,
    /// Pieces up to the last that carries a solid; the head always counts.
    piece_count: usize,
    /// True where the device has root frames of a moment.
    rooted: bool,
}

impl BoundSolids {
    /// Rows for guides and solids.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn new(gpu: &Gpu, guide_count: usize, solids: &Solids) -> Result<Self, RenderError> {
        let solids = solids.all();
        let last = solids.iter().map(|(solid, _)| match solid.carrier {
            Carrier::Piece(piece) => usize::from(piece),
            Carrier::World => 0,
        });
        let piece_count = 1 + last.max().unwrap_or(0);
        let before = 1 + PIECE * (piece_count - 1) + guide_count;
        let mut all = vec![[0; 4]; before];
        all[0] = [guide_count, solids.len(), piece_count, 0].map(|count| count as u32);
        all.append(&mut solid_rows(solids.iter().map(|(solid, kept)| (solid, *kept)), before)?);
        let rows = Buffer::from_slice(gpu, "solids of bound strands", &all)?;
        Ok(Self { rows, guide_count, solid_count: solids.len(), piece_count, rooted: false })
    }

    /// The buffer.
    pub fn rows(&self) -> &Buffer<[u32; 4]> {
        &self.rows
    }

    /// Takes the pieces and root frames of a moment. A rigid head is in the settings of the frame.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(&mut self, body: &BodyFrame) -> Result<(), GpuError> {
        let roots = body.roots().is_some();
        if self.piece_count == 1 && !roots && !self.rooted {
            return Ok(());
        }
        self.rooted = roots;
        let counts = [self.guide_count, self.solid_count, self.piece_count, usize::from(roots)];
        let mut rows = vec![counts.map(|count| count as u32)];
        for piece in 1..self.piece_count {
            let pose = body.piece(piece);
            for rigid in [Rigid::from(&pose), Rigid::from(&pose.inverse())] {
                rows.extend([rigid.x, rigid.y, rigid.z].map(|row| row.map(f32::to_bits)));
            }
        }
        if roots {
            let rotation = |guide| body.root(guide).rotation.to_array().map(f32::to_bits);
            rows.extend((0..self.guide_count).map(rotation));
        }
        self.rows.write(&rows)
    }
}
