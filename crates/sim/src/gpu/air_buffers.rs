//! Buffers of the air among hair.

use strandline_gpu::{Buffer, Gpu, GpuError, mirror};

use crate::currents::{MOST_EDDIES, MOST_SOURCES};
use crate::wind::CELLS;

/// Numbers of a cell in the sums.
const NUMBERS: usize = 5;

mirror! {
    /// The box of cells along the wind. Mirrors `WindBox` in wind_box.wesl.
    pub(super) struct WindBox {
        pub origin: [f32; 3],
        pub speed: f32,
        pub edges: [f32; 3],
        pub per_speed: f32,
    }
}

/// The buffers of the stage.
pub(super) struct ShelterBuffers {
    pub cells: Buffer<WindBox>,
    /// All 0 when the stage begins, shape `[cell][number]` with one more for all hair.
    pub sums: Buffer<u32>,
    /// Shape `[cell][3]`: see air_cells.wesl.
    pub contents: Buffer<[f32; 4]>,
    /// Currents of the step: see currents.wesl.
    pub currents: Buffer<[f32; 4]>,
    /// Air in the middle of each cell \[m/s\].
    pub flow: Buffer<[f32; 4]>,
    /// Air at each point \[m/s\], shape `[block][point][component]` of lanes.
    pub air: Buffer<f32>,
}

impl ShelterBuffers {
    pub fn new(gpu: &Gpu, point_count: usize) -> Result<Self, GpuError> {
        Ok(Self {
            cells: Buffer::new(gpu, "box along the wind", 1)?,
            sums: Buffer::new(gpu, "sums of hair in the wind", NUMBERS * (CELLS + 1))?,
            contents: Buffer::new(gpu, "hair in the wind", 3 * CELLS)?,
            currents: Buffer::new(gpu, "currents of air", 1 + 2 * (MOST_EDDIES + MOST_SOURCES))?,
            flow: Buffer::new(gpu, "air in cells", CELLS)?,
            air: Buffer::new(gpu, "air at points", 3 * point_count)?,
        })
    }
}
