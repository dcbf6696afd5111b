//! The buffers of the fluid volume.

use strandline_gpu::{Buffer, Gpu, GpuError, Scan, THREADS, mirror};
use strandline_groom::{LANES, Lanes};

use super::records::{Gradient, MOST_WORKGROUPS, PressureState, Spread};
use crate::cells::grid::{Grid, MIN_SPACING, ladder};

mirror! {
    /// The box. Mirrors `GridState` in grid.wesl.
    pub(super) struct GridState {
        pub origin: [f32; 3],
        pub spacing: f32,
        pub size: [u32; 3],
        pub cell_count: u32,
    }
}

mirror! {
    /// A point in the order of the cells. Mirrors `SortedPoint` in splat.wesl.
    pub(super) struct SortedPoint {
        pub place: [f32; 3],
        pub mass: f32,
        pub velocity: [f32; 3],
        pub index: u32,
    }
}

impl GridState {
    /// State of a box which has not found the hair yet.
    fn start(grid: &Grid) -> Self {
        Self {
            origin: [-1.0; 3],
            spacing: grid.spacing(),
            size: grid.size().map(|count| count as u32),
            cell_count: grid.cell_count() as u32,
        }
    }

    /// Lower corner with the ring \[m\], world space, and spacing \[m\].
    pub fn place(&self) -> [f32; 4] {
        let [x, y, z] = self.origin;
        [x, y, z, self.spacing]
    }
}

/// Vectors of the Poisson system, as numbered in poisson.wesl.
const VECTORS: usize = 9;

pub(super) struct Volume {
    pub cells: [u32; 3],
    /// Cells with the ring.
    pub cell_count: usize,
    /// True if faces keep their masses until cells are marked.
    pub is_one_sided: bool,
    pub gradient: Gradient,
    pub spread: Spread,
    pub grid: Buffer<GridState>,
    pub ladder: Buffer<f32>,
    /// Points of each cell while they are counted, then where they begin; one more than cells.
    pub start_index: Buffer<u32>,
    pub totals: Buffer<u32>,
    pub cell_ranks: Buffer<[u32; 2]>,
    /// Numbers of the points of each cell as they were counted.
    pub counted: Buffer<u32>,
    pub sorted_points: Buffer<SortedPoint>,
    /// Density \[kg/m^3\] around each point at rest, in a one-sided volume.
    pub densities: Buffer<f32>,
    /// Velocity and change, shape `[component][cell]`.
    pub faces: Buffer<[f32; 2]>,
    pub kinds: Buffer<u32>,
    /// Fluid cells before each cell; one more than cells.
    pub unknowns: Buffer<u32>,
    pub vectors: Buffer<f32>,
    /// Shape `[side][unknown]`.
    pub neighbours: Buffer<u32>,
    pub rooms: Buffer<u32>,
    pub states: Buffer<PressureState>,
    pub partials: Buffer<[f32; 4]>,
}

impl Volume {
    pub fn new(gpu: &Gpu, cells: [u32; 3], lane_count: usize, points: usize) -> Result<Self, GpuError> {
        let grid = Grid::new(cells.map(|count| count as usize));
        let cell_count = grid.cell_count();
        let point_count = lane_count.next_multiple_of(LANES) * points;
        let steps: Vec<f32> = std::iter::once(MIN_SPACING).chain(ladder()).collect();
        let workgroups = cell_count.div_ceil(THREADS).min(MOST_WORKGROUPS);
        Ok(Self {
            cells,
            cell_count,
            is_one_sided: false,
            gradient: Gradient::default(),
            spread: Spread::default(),
            grid: Buffer::from_slice(gpu, "grid", &[GridState::start(&grid)])?,
            ladder: Buffer::from_slice(gpu, "spacings", &steps)?,
            start_index: Buffer::new(gpu, "start_index", cell_count + 1)?,
            totals: Scan::totals(gpu, cell_count + 1)?,
            cell_ranks: Buffer::new(gpu, "cells of points", point_count)?,
            counted: Buffer::new(gpu, "points as they were counted", point_count)?,
            sorted_points: Buffer::new(gpu, "sorted points", point_count)?,
            densities: Buffer::new(gpu, "densities at rest", point_count)?,
            faces: Buffer::new(gpu, "faces", 3 * cell_count)?,
            kinds: Buffer::new(gpu, "kinds of cells", cell_count)?,
            unknowns: Buffer::new(gpu, "unknowns", cell_count + 1)?,
            vectors: Buffer::new(gpu, "vectors of the pressure", VECTORS * (cell_count + 1))?,
            neighbours: Buffer::new(gpu, "neighbours of cells", 6 * cell_count)?,
            rooms: Buffer::new(gpu, "rooms", cell_count)?,
            states: Buffer::new(gpu, "state of the pressure", 2)?,
            partials: Buffer::new(gpu, "partial sums", 2 * workgroups)?,
        })
    }

    /// Takes over the densities at rest \[kg/m^3\]; none in an incompressible volume.
    pub fn pack(&mut self, densities: Option<&[Lanes]>) -> Result<(), GpuError> {
        self.is_one_sided = densities.is_some();
        densities.map_or(Ok(()), |densities| self.densities.write(bytemuck::cast_slice(densities)))
    }

    /// Has the box find the hair again.
    pub fn put_at_start(&self) -> Result<(), GpuError> {
        let grid = Grid::new(self.cells.map(|count| count as usize));
        self.grid.write(&[GridState::start(&grid)])
    }

    /// Puts the box to a lower corner with the ring \[m\], with a spacing \[m\]; none below the finest.
    pub fn put(&self, [x, y, z, spacing]: [f32; 4]) -> Result<(), GpuError> {
        if !(spacing.is_finite() && spacing >= MIN_SPACING) {
            return Ok(());
        }
        let grid = Grid::new(self.cells.map(|count| count as usize));
        let (size, cell_count) = (grid.size().map(|count| count as u32), self.cell_count as u32);
        self.grid.write(&[GridState { origin: [x, y, z], spacing, size, cell_count }])
    }
}
