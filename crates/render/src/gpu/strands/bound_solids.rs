//! Solids that bound strands stay out of and the body that carries them, as the kernels read them.

use strandline_body::{BodyFrame, Carrier, SkinTable, Solids, solid_rows};
use strandline_gpu::{Buffer, Gpu, GpuError, Rigid};

use crate::RenderError;

/// Rows before the pieces, and of a piece behind the head: `world_from_piece`, `piece_from_world`.
const COUNTS: usize = 2;
const PIECE: usize = 6;

/// Solids of a simulation on the same device.
pub struct DeviceSolids {
    /// Rows of four words, as `solid_rows` of crates/body describes them.
    pub rows: Buffer<[u32; 4]>,
    /// Row from which others are counted.
    pub base: usize,
    /// Row of the first solid, counted from there.
    pub first: usize,
}

/// The rows on the device; solid_rows.wesl names them.
pub(crate) struct BoundSolids {
    body: Buffer<[u32; 4]>,
    solids: DeviceSolids,
    /// The skins among solids of its own: those of a simulation are where its last step ended.
    skins: SkinTable,
    guide_count: usize,
    solid_count: usize,
    /// Pieces up to the last that carries a solid; the head always counts.
    piece_count: usize,
    /// True where the device has root frames of a moment.
    rooted: bool,
}

impl BoundSolids {
    /// Rows for guides and solids; the solids may lie on the device already.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn new(
        gpu: &Gpu,
        guide_count: usize,
        solids: &Solids,
        on_device: Option<DeviceSolids>,
    ) -> Result<Self, RenderError> {
        let all = solids.all();
        let last = all.iter().map(|(solid, _)| match solid.carrier {
            Carrier::Piece(piece) | Carrier::Moved(piece) => usize::from(piece),
            Carrier::World => 0,
        });
        let piece_count = 1 + last.max().unwrap_or(0);
        let (solids, skins) = match on_device {
            Some(solids) => (solids, SkinTable::default()),
            None => {
                let (rows, skins) = solid_rows(all.iter().map(|(solid, kept)| (solid, *kept)), 0)?;
                let rows = Buffer::from_slice(gpu, "solids of bound strands", &rows)?;
                (DeviceSolids { rows, base: 0, first: 0 }, skins)
            }
        };
        let rows = COUNTS + PIECE * (piece_count - 1) + guide_count;
        let body = Buffer::new(gpu, "the body of bound strands", rows)?;
        let made =
            Self { body, solids, skins, guide_count, solid_count: all.len(), piece_count, rooted: false };
        made.body.write(&made.rows_of(&BodyFrame::REST))?;
        Ok(made)
    }

    /// The buffer of the body.
    pub fn body(&self) -> &Buffer<[u32; 4]> {
        &self.body
    }

    /// The buffer of the solids.
    pub fn solids(&self) -> &Buffer<[u32; 4]> {
        &self.solids.rows
    }

    /// Takes the pieces, root frames and skins of a moment. A rigid head is in the settings of the frame.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(&mut self, body: &BodyFrame) -> Result<(), GpuError> {
        for (first, rows) in self.skins.between(body, body) {
            self.solids.rows.write_at(first, &rows)?;
        }
        let rooted = body.roots().is_some();
        if self.piece_count == 1 && !rooted && !self.rooted {
            return Ok(());
        }
        self.rooted = rooted;
        self.body.write(&self.rows_of(body))
    }

    fn rows_of(&self, body: &BodyFrame) -> Vec<[u32; 4]> {
        let rooted = body.roots().is_some();
        let counts = [self.guide_count, self.solid_count, self.piece_count, usize::from(rooted)];
        let places = [self.solids.base, self.solids.first, 0, 0];
        let mut rows: Vec<_> = [counts, places].map(|row| row.map(|number| number as u32)).into();
        for piece in 1..self.piece_count {
            let pose = body.piece(piece);
            for rigid in [Rigid::from(&pose), Rigid::from(&pose.inverse())] {
                rows.extend([rigid.x, rigid.y, rigid.z].map(|row| row.map(f32::to_bits)));
            }
        }
        if rooted {
            let rotation = |guide| body.root(guide).rotation.to_array().map(f32::to_bits);
            rows.extend((0..self.guide_count).map(rotation));
        }
        rows
    }
}
