//! Points become velocities on the faces of the staggered grid: sorted by cell, then gathered.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, MANY, kernel};

use super::buffers::Buffers;
use super::inputs::Step;
use super::records::PointBox;
use super::stage::{StageKernels, Target};
use super::volume::{GridState, SortedPoint};
use crate::Model;

kernel! {
    /// Boxes around the points of strands; one thread is one strand.
    pub(super) struct BoxStrands in "follow" (super::linked::FOLLOW), entry "bounds" {
        0 step: Read Step,
        2 predicted: Read f32,
        4 mass: Read f32,
        5 boxes: ReadWrite PointBox,
    }
}

kernel! {
    /// Moves the grid over the points; one workgroup.
    pub(super) struct Follow in "follow" (super::linked::FOLLOW), entry "follow", threads (Some(MANY)) {
        1 grid: ReadWrite GridState,
        5 boxes: ReadWrite PointBox,
        6 ladder: Read f32,
    }
}

kernel! {
    /// The histogram; one thread is one point.
    pub(super) struct FindCells in "splat" (super::linked::SPLAT), entry "find_cells" {
        0 step: Read Step,
        1 grid: ReadWrite GridState,
        2 predicted: Read f32,
        4 mass: Read f32,
        7 counts: ReadWrite u32,
        8 cell_ranks: ReadWrite [u32; 2],
    }
}

kernel! {
    /// The points of each cell as they were counted; one thread is one point.
    pub(super) struct ListPoints in "order" (super::linked::ORDER), entry "list_points" {
        0 step: Read Step,
        1 cell_ranks: ReadWrite [u32; 2],
        2 start_index: Read u32,
        3 counted: ReadWrite u32,
    }
}

kernel! {
    /// Ranks in the order of the points' numbers; one thread is one point.
    pub(super) struct RankPoints in "order" (super::linked::ORDER), entry "rank_points" {
        0 step: Read Step,
        1 cell_ranks: ReadWrite [u32; 2],
        2 start_index: Read u32,
        3 counted: ReadWrite u32,
    }
}

kernel! {
    /// The order; one thread is one point.
    pub(super) struct SortPoints in "splat" (super::linked::SPLAT), entry "sort_points" {
        0 step: Read Step,
        1 grid: ReadWrite GridState,
        2 predicted: Read f32,
        3 velocities: Read f32,
        4 mass: Read f32,
        8 cell_ranks: ReadWrite [u32; 2],
        9 start_index: Read u32,
        10 sorted_points: ReadWrite SortedPoint,
    }
}

kernel! {
    /// The sums; one thread or [`SHARERS`] of them are the three lower faces of a cell.
    pub(super) struct SumFaces in "sum_faces" (super::linked::SUM_FACES), entry "sum_faces" {
        0 step: Read Step,
        1 grid: Read GridState,
        9 start_index: Read u32,
        10 sorted_points: Read SortedPoint,
        11 faces: ReadWrite [f32; 2],
    }
}

/// Threads that share the points around a cell where hair is dense and these are hundreds.
const SHARERS: usize = 8;

/// Threads that share the points around a cell: one where a cell has less than half a point on the mean, since most of more
/// would wait. Hair fills few cells of its box: that of the demo, with one point a cell, gains by sharing on hardware.
fn sharers(model: &Model) -> usize {
    let cells: u64 = model.settings.volume.cells.iter().map(|count| u64::from(*count)).product();
    let points = model.strand_count * model.points_per_strand;
    if 2 * points as u64 >= cells { SHARERS } else { 1 }
}

pub(super) struct Stage {
    bounds: Kernel<BoxStrands<'static>>,
    follow: Kernel<Follow<'static>>,
    find_cells: Kernel<FindCells<'static>>,
    list_points: Kernel<ListPoints<'static>>,
    rank_points: Kernel<RankPoints<'static>>,
    sort_points: Kernel<SortPoints<'static>>,
    sum_faces: Kernel<SumFaces<'static>>,
    sharers: usize,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![
            BoxStrands::declaration(),
            Follow::declaration(),
            FindCells::declaration(),
            ListPoints::declaration(),
            RankPoints::declaration(),
            SortPoints::declaration(),
            SumFaces::declaration(),
        ]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        let sharers = sharers(model);
        Ok(Self {
            bounds: Kernel::new(gpu, &[])?,
            follow: Kernel::new(gpu, &[])?,
            find_cells: Kernel::new(gpu, &[])?,
            list_points: Kernel::new(gpu, &[])?,
            rank_points: Kernel::new(gpu, &[])?,
            sort_points: Kernel::new(gpu, &[])?,
            sum_faces: Kernel::new(gpu, &[("SHARERS", sharers as f64)])?,
            sharers,
        })
    }

    /// `start_index` must be all 0 when the first kernel starts.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, scan, side, .. } = *to;
        let Some(volume) = &buffers.volume else { return Ok(Vec::new()) };
        let Buffers { step, velocities, mass, .. } = buffers;
        let predicted = &buffers.places[1 - side];
        let (grid, boxes, ladder) = (&volume.grid, &buffers.boxes, &volume.ladder);
        let (counts, start_index) = (&volume.start_index, &volume.start_index);
        let (cell_ranks, faces) = (&volume.cell_ranks, &volume.faces);
        let (sorted_points, counted) = (&volume.sorted_points, &volume.counted);
        let points = buffers.point_count();
        let bounds = self.bounds.bind(gpu, &BoxStrands { step, predicted, mass, boxes })?;
        let follow = self.follow.bind(gpu, &Follow { grid, boxes, ladder })?;
        let find_cells =
            self.find_cells.bind(gpu, &FindCells { step, grid, predicted, mass, counts, cell_ranks })?;
        let list_points =
            self.list_points.bind(gpu, &ListPoints { step, cell_ranks, start_index, counted })?;
        let rank_points =
            self.rank_points.bind(gpu, &RankPoints { step, cell_ranks, start_index, counted })?;
        let sort_points = self.sort_points.bind(
            gpu,
            &SortPoints { step, grid, predicted, velocities, mass, cell_ranks, start_index, sorted_points },
        )?;
        let sum_faces =
            self.sum_faces.bind(gpu, &SumFaces { step, grid, start_index, sorted_points, faces })?;
        let mut dispatches =
            vec![bounds.over(buffers.strand_count), (follow, [1; 3]), find_cells.over(points)];
        dispatches.extend(scan.bind(gpu, start_index, &volume.totals)?);
        dispatches.extend([list_points.over(points), rank_points.over(points), sort_points.over(points)]);
        dispatches.push(sum_faces.over(self.sharers * volume.cell_count));
        Ok(dispatches)
    }
}
