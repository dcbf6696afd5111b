//! Steps on a GPU, measured by its own clock.

use serde::Serialize;
use strandline::{Backend, device::Gpu};

use crate::output::print_line;
use crate::sim_report::SimReport;

/// The GPU that is measured.
pub struct Device {
    pub gpu: Gpu,
    pub adapter: Adapter,
}

/// Description of an adapter in the measurements.
#[derive(Clone, Debug, Serialize)]
pub struct Adapter {
    pub name: String,
    pub software: bool,
    pub timestamps: bool,
    /// Bytes per second that a copy reads and writes.
    pub copy_bytes_per_second: f64,
}

/// One scene on the GPU.
#[derive(Debug, Serialize)]
pub struct GpuRun {
    /// Times by timestamps.
    pub steps: SimReport,
    /// `None` without a volume.
    pub us_of_gradient: Option<GradientTimes>,
    /// Time on the host's clock for a step among many that are queued.
    pub wall_ms_per_step: f64,
    pub dispatches: usize,
    pub dispatches_without_solve: usize,
    /// Bytes that a step moves at least, without the rounds of the solve.
    pub bytes_per_step: u64,
    /// Those over the time of the stages without the solve, over what a copy moves in that time.
    pub share_of_copy_bandwidth: f64,
}

/// Times of subtracting the pressure gradient once, alone \[us\], by the device's own clock [Chen2011 table 1].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GradientTimes {
    pub one_kernel: f64,
    pub three_kernels: f64,
    /// The time is the mean of this many in a row; the best of a few rows.
    pub in_a_row: usize,
}

/// One thread per strand against one per point: GPU time of 20 rounds of all strands \[us\].
#[derive(Debug, Serialize)]
pub struct Forms {
    pub strands: usize,
    pub points_per_strand: usize,
    pub us_strand_a_thread: f64,
    pub us_point_a_thread: f64,
}

impl Device {
    /// Opens the device of the command line; `None` for the CPU.
    pub fn open(backend: Backend, quick: bool) -> anyhow::Result<Option<Self>> {
        let Some(gpu) = backend.open()? else {
            print_line!("no hardware GPU is measured: its columns are left out");
            return Ok(None);
        };
        if !gpu.has_timestamps() {
            anyhow::bail!("{} offers no timestamps to measure by", gpu.adapter());
        }
        let copies = if quick { 4 } else { 128 };
        let adapter = Adapter {
            name: gpu.adapter().to_string(),
            software: gpu.adapter().software,
            timestamps: gpu.has_timestamps(),
            copy_bytes_per_second: gpu.copy_bandwidth(copies)?,
        };
        print_line!("{}: a copy moves {:.1} GB/s", adapter.name, adapter.copy_bytes_per_second * 1e-9);
        Ok(Some(Self { gpu, adapter }))
    }

    /// Its name on the command line.
    pub fn backend(&self) -> Backend {
        Backend::Gpu(Some(self.gpu.adapter().index))
    }
}
