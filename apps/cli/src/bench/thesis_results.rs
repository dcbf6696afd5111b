use serde::Serialize;

use super::gpu::{Forms, GpuRun};
use crate::sim_report::SimReport;
use crate::statistics::Times;

#[derive(Debug, Serialize)]
pub struct Results {
    pub grids: Vec<Grid>,
    pub pictures_on_cpu: Pictures,
    pub segments: usize,
    pub shares_percent: Vec<(&'static str, f64)>,
    pub gpu_shares_percent: Vec<(&'static str, f64)>,
    /// Empty when no GPU was measured.
    pub lengths_alone: Vec<Forms>,
}

#[derive(Debug, Serialize)]
pub struct Grid {
    pub cells: u32,
    pub mic0: SimReport,
    pub jacobi: SimReport,
    /// Simulated and drawn on the CPU.
    pub whole_on_cpu: Whole,
    /// `None` if no GPU was measured.
    pub gpu: Option<GpuGrid>,
    /// Simulated on the CPU and on a GPU.
    pub thesis_frames_per_second: [f64; 2],
}

#[derive(Debug, Serialize)]
pub struct GpuGrid {
    pub chebyshev: GpuRun,
    pub jacobi: GpuRun,
    /// Simulated on the CPU, drawn on the GPU: the thesis's "CPU".
    pub whole_simulated_on_cpu: Whole,
    /// Simulated and drawn on the GPU.
    pub whole: Whole,
}

/// The whole system: a frame is simulated while the one before is drawn, by the host's clock.
#[derive(Debug, Serialize)]
pub struct Whole {
    pub simulated_on: String,
    pub drawn_on: String,
    pub frames: u32,
    pub ms_per_frame: f64,
    pub frames_per_second: f64,
}

/// Cost of a picture on the CPU.
#[derive(Debug, Serialize)]
pub struct Pictures {
    /// While the next frame is simulated.
    pub ms_beside_simulation: Times,
    /// Without other work.
    pub ms_alone: Times,
}
