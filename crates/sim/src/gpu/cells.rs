//! Points sorted by the cell that holds them at the start of a step.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::cell_buffers::{Cells, LatticeState};
use super::inputs::Step;
use super::splat::{ListPoints, RankPoints};
use super::stage::{StageKernels, Target};
use crate::Model;

kernel! {
    /// The histogram; one thread is one point.
    pub(super) struct FindBuckets in "cells" (super::linked::CELLS), entry "find_buckets" {
        0 step: Read Step,
        1 cell_ranks: ReadWrite [u32; 2],
        4 lattice: Read LatticeState,
        5 positions: Read f32,
        6 counts: ReadWrite u32,
    }
}

pub(super) struct Stage {
    find_buckets: Kernel<FindBuckets<'static>>,
    list_points: Kernel<ListPoints<'static>>,
    rank_points: Kernel<RankPoints<'static>>,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![FindBuckets::declaration()]
    }

    fn new(gpu: &Gpu, _: &Model) -> Result<Self, GpuError> {
        Ok(Self {
            find_buckets: Kernel::new(gpu, &[])?,
            list_points: Kernel::new(gpu, &[])?,
            rank_points: Kernel::new(gpu, &[])?,
        })
    }

    /// `start_index` must be all 0 when the first kernel starts.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, scan, side, .. } = *to;
        let Some(cells) = &buffers.cells else { return Ok(Vec::new()) };
        let Cells { lattice, start_index, totals, cell_ranks, order, .. } = cells;
        let (step, positions, points) = (&buffers.step, &buffers.places[side], buffers.point_count());
        let find = FindBuckets { step, cell_ranks, lattice, positions, counts: start_index };
        let mut dispatches = vec![self.find_buckets.bind(gpu, &find)?.over(points)];
        dispatches.extend(scan.bind(gpu, start_index, totals)?);
        let list = ListPoints { step, cell_ranks, start_index, counted: order };
        let list = self.list_points.bind(gpu, &list)?.over(points);
        let rank = RankPoints { step, cell_ranks, start_index, counted: order };
        // Listed as they were counted, then by their ranks.
        dispatches.extend([list.clone(), self.rank_points.bind(gpu, &rank)?.over(points), list]);
        Ok(dispatches)
    }
}
