//! The buffers of points sorted by cell.

use strandline_gpu::{Buffer, Gpu, GpuError, Scan, mirror};

use crate::cells::Lattice;

mirror! {
    /// The cells and their buckets. Mirrors `LatticeState` in cells.wesl.
    pub(super) struct LatticeState {
        pub per_metre: f32,
        pub mask: u32,
    }
}

/// The buffers of the sort.
pub(super) struct Cells {
    /// Edge of a cell \[m\].
    pub edge: f32,
    pub lattice: Buffer<LatticeState>,
    /// Points of each bucket while they are counted, then their first place in the order; one more than buckets.
    pub start_index: Buffer<u32>,
    pub totals: Buffer<u32>,
    pub cell_ranks: Buffer<[u32; 2]>,
    /// Indices of points, bucket after bucket.
    pub order: Buffer<u32>,
}

impl Cells {
    /// Buffers for strands in cells with an edge \[m\]; `lane_count` counts what fills up the last block, too.
    pub fn new(
        gpu: &Gpu,
        edge: f32,
        [strand_count, lane_count]: [usize; 2],
        points_per_strand: usize,
    ) -> Result<Self, GpuError> {
        let lattice = Lattice::new(edge, strand_count * points_per_strand);
        let (buckets, points) = (lattice.bucket_count(), lane_count * points_per_strand);
        let state = LatticeState { per_metre: lattice.per_metre(), mask: buckets as u32 - 1 };
        Ok(Self {
            edge,
            lattice: Buffer::from_slice(gpu, "cells", &[state])?,
            start_index: Buffer::new(gpu, "starts of buckets", buckets + 1)?,
            totals: Scan::totals(gpu, buckets + 1)?,
            cell_ranks: Buffer::new(gpu, "buckets of points", points)?,
            order: Buffer::new(gpu, "order of points", points)?,
        })
    }
}
