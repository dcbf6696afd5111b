//! `cells`: points sorted by the cell that holds them at the start of a step.

use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Vec3Lanes};

use crate::cells::{CellSort, Lattice, NO_CELL};

/// Points sorted by bucket of cells. The order is a function of the positions alone.
#[derive(Clone, Debug)]
pub struct Cells {
    edge: f32,
    strand_count: usize,
    points_per_strand: usize,
    lattice: Lattice,
    bucket_of_point: Vec<u32>,
    sort: CellSort,
}

impl Cells {
    /// Room for the points of strands in cells with an edge \[m\].
    pub fn new(edge: f32, strand_count: usize, points_per_strand: usize) -> Self {
        let lattice = Lattice::new(edge, strand_count * points_per_strand);
        Self {
            edge,
            strand_count,
            points_per_strand,
            lattice,
            bucket_of_point: Vec::new(),
            sort: CellSort::new(lattice.bucket_count()),
        }
    }

    /// Takes over an edge \[m\] and a number of strands and points; room is made again when one changes.
    pub(super) fn keep_or_new(old: Option<Self>, edge: f32, strand_count: usize, points: usize) -> Self {
        match old {
            Some(old)
                if (old.edge, old.strand_count, old.points_per_strand) == (edge, strand_count, points) =>
            {
                old
            }
            _ => Self::new(edge, strand_count, points),
        }
    }

    /// The cells and their buckets.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Indices of all points that lie in cells, bucket after bucket. A point's index is that of its lane,
    /// `[block][point][lane]`; those of one bucket rise.
    pub fn order(&self) -> &[u32] {
        self.sort.order()
    }

    /// Indices of the points in a bucket, rising.
    pub fn points_in(&self, bucket: u32) -> &[u32] {
        let occupied = self.sort.cells().binary_search(&bucket);
        occupied.map_or(&[], |index| self.sort.points_of(index))
    }
}

/// Sorts points \[m\], world space, shape `[block][point]` of lanes, by cell. Lanes beyond the last strand and points out
/// of reach are left out.
pub fn cells(cells: &mut Cells, positions: &[Vec3Lanes]) {
    let Cells { strand_count, points_per_strand, lattice, bucket_of_point, sort, .. } = cells;
    bucket_of_point.resize(positions.len() * LANES, NO_CELL);
    let lanes = bucket_of_point.par_chunks_mut(LANES).zip(positions).with_min_len(512).enumerate();
    lanes.for_each(|(index, (buckets, positions))| {
        let first = index / *points_per_strand * LANES;
        for (lane, bucket) in buckets.iter_mut().enumerate() {
            let cell = if first + lane < *strand_count { lattice.cell(positions.get(lane)) } else { None };
            *bucket = cell.map_or(NO_CELL, |cell| lattice.bucket(cell));
        }
    });
    sort.sort(bucket_of_point);
}
