//! The thesis's tables 1 to 4 as they are printed, with ours beside them.

use super::gpu::{GpuRun, GradientTimes};
use super::thesis_results::{GpuGrid, Grid, Pictures, Results};
use crate::output::{print_line, print_part};
use crate::sim_report::SimReport;

/// GPU time of subtracting the pressure gradient \[us\], as one kernel and as three (table 1); over how many
/// calls, and on which grid, the thesis does not say.
const THESIS_GRADIENT: [f64; 2] = [17051.0, 13255.0];
/// Iterations of the thesis's pressure solve to 1e-5, MIC then Jacobi (table 3).
const THESIS_ITERATIONS: [[f64; 3]; 2] = [[5.27, 5.91, 5.21], [17.0, 20.1, 16.6]];
/// Shares of the thesis's step on the CPU and the GPU \[%\], and the stages that they cover (table 4).
const THESIS_SHARES: [(&str, f64, f64, &[&str]); 3] = [
    ("constraints", 31.4, 19.4, &["constrain"]),
    ("volume", 65.7, 76.6, &["splat", "mark", "solve_pressure", "gather"]),
    ("forces, velocity, position", 2.9, 4.0, &["pose_roots", "integrate", "advance"]),
];

/// Shares of the thesis's three parts in a step \[%\].
pub fn shares(report: &SimReport) -> Vec<(&'static str, f64)> {
    let stages = &report.ms_per_step.stages;
    let total: f64 = stages.iter().map(|(_, time)| time).sum();
    THESIS_SHARES.iter().map(|(name, _, _, parts)| (*name, 100.0 * stages.sum(parts) / total)).collect()
}

/// Prints the tables.
pub fn print(results: &Results) {
    let tables = Tables { grids: &results.grids };
    tables.gradient();
    print_line!(
        "\nTable 2: frames per second, 1,750 guides x 6 points, {} segments drawn at 800x600, 2x2 samples, each frame simulated while the one before is drawn",
        results.segments
    );
    tables.whole();
    tables.steps();
    tables.iterations();
    print_shares(results);
    print_pictures(&results.pictures_on_cpu);
}

/// Rows of values, one for each grid.
struct Tables<'a> {
    grids: &'a [Grid],
}

impl Tables<'_> {
    fn gradient(&self) {
        let times = |value: fn(&GradientTimes) -> f64| {
            self.gpu(|grid| grid.chebyshev.us_of_gradient.as_ref().map_or(f64::NAN, value))
        };
        let [one, three] = [times(|times| times.one_kernel), times(|times| times.three_kernels)];
        print_line!("\nTable 1: subtracting the pressure gradient, GPU time [us]");
        if one.is_empty() {
            print_line!("no GPU is measured: left out");
            return;
        }
        heading();
        let gain: Vec<f64> = one.iter().zip(&three).map(|(one, three)| one / three).collect();
        row("ours, one kernel", one, 2);
        row("ours, three kernels", three, 2);
        row("ours, one over three", gain, 2);
        let [one, three] = THESIS_GRADIENT;
        print_line!(
            "thesis: one kernel {one:.0}, three kernels {three:.0}, one over three {:.2}",
            one / three
        );
    }

    fn whole(&self) {
        heading();
        let fps = |value: fn(&GpuGrid) -> f64| self.gpu(value);
        let cpu = fps(|grid| grid.whole_simulated_on_cpu.frames_per_second);
        let gpu = fps(|grid| grid.whole.frames_per_second);
        row("ours, all on the CPU", self.all(|grid| grid.whole_on_cpu.frames_per_second), 2);
        row("ours, CPU; drawn on the GPU", cpu.clone(), 2);
        row("ours, GPU; drawn on the same", gpu.clone(), 2);
        row("ours, speed-up by the GPU", gpu.iter().zip(&cpu).map(|(gpu, cpu)| gpu / cpu).collect(), 1);
        row("thesis, i7-930; drawn on GTX 480", self.all(|grid| grid.thesis_frames_per_second[0]), 2);
        row("thesis, 9600GT; drawn on GTX 480", self.all(|grid| grid.thesis_frames_per_second[1]), 2);
        let speed_up = |grid: &Grid| grid.thesis_frames_per_second[1] / grid.thesis_frames_per_second[0];
        row("thesis, speed-up by the GPU", self.all(speed_up), 1);
        if gpu.is_empty() {
            print_line!("no GPU is measured: its rows and the speed-up are left out");
        }
    }

    fn steps(&self) {
        print_line!("\nOne step alone");
        heading();
        let run = |value: fn(&GpuRun) -> f64| self.gpu_of(|grid| &grid.chebyshev, value);
        row("CPU [ms]", self.all(|grid| grid.mic0.ms_per_step.median), 2);
        row("GPU, its own clock [ms]", run(|run| run.steps.ms_per_step.median), 3);
        row("GPU, queued, the host's clock [ms]", run(|run| run.wall_ms_per_step), 3);
        row("GPU, dispatches", run(|run| run.dispatches as f64), 0);
        row("GPU, dispatches without the solve", run(|run| run.dispatches_without_solve as f64), 0);
        row("GPU, MB a step without the solve", run(|run| run.bytes_per_step as f64 * 1e-6), 2);
        row("GPU, share of the copy bandwidth [%]", run(|run| 100.0 * run.share_of_copy_bandwidth), 1);
    }

    fn iterations(&self) {
        print_line!(
            "\nTable 3: iterations of the pressure solve until the largest residual is 1e-5 of the first (ours), and until it is 1e-5 m/s (as printed: the thesis names no unit)"
        );
        heading();
        row("fluid cells, mean", self.all(|grid| grid.mic0.fluid_cells_mean), 0);
        row("MIC(0), CPU, ours", self.all(|grid| grid.mic0.pcg.iterations_mean), 1);
        row("MIC(0), CPU, as printed", self.all(|grid| grid.mic0.pcg.iterations_absolute_mean), 1);
        let unmet = self.all(|grid| grid.mic0.pcg.absolute_unmet as f64 / grid.mic0.steps.max(1) as f64);
        row("  steps that stopped before [%]", unmet.iter().map(|share| 100.0 * share).collect(), 1);
        row("thesis, MIC, CPU", THESIS_ITERATIONS[0].to_vec(), 2);
        row("Jacobi, CPU, ours", self.all(|grid| grid.jacobi.pcg.iterations_mean), 1);
        row("Jacobi, CPU, as printed", self.all(|grid| grid.jacobi.pcg.iterations_absolute_mean), 1);
        let relative: fn(&GpuRun) -> f64 = |run| run.steps.pcg.iterations_mean;
        let absolute: fn(&GpuRun) -> f64 = |run| run.steps.pcg.iterations_absolute_mean;
        row("Jacobi, GPU, ours", self.gpu_of(|grid| &grid.jacobi, relative), 1);
        row("Jacobi, GPU, as printed", self.gpu_of(|grid| &grid.jacobi, absolute), 1);
        row("thesis, Jacobi, GPU", THESIS_ITERATIONS[1].to_vec(), 2);
        row("Chebyshev, GPU, ours", self.gpu_of(|grid| &grid.chebyshev, relative), 1);
        row("Chebyshev, GPU, as printed", self.gpu_of(|grid| &grid.chebyshev, absolute), 1);
        let solve: fn(&GpuRun) -> f64 = |run| run.steps.ms_per_step.stages.sum(&["solve_pressure"]);
        row("solve, GPU, Jacobi [ms]", self.gpu_of(|grid| &grid.jacobi, solve), 3);
        row("solve, GPU, Chebyshev [ms]", self.gpu_of(|grid| &grid.chebyshev, solve), 3);
    }

    fn all(&self, value: impl Fn(&Grid) -> f64) -> Vec<f64> {
        self.grids.iter().map(value).collect()
    }

    /// Empty if no GPU was measured.
    fn gpu(&self, value: impl Fn(&GpuGrid) -> f64) -> Vec<f64> {
        self.grids.iter().filter_map(|grid| grid.gpu.as_ref()).map(value).collect()
    }

    fn gpu_of(&self, run: fn(&GpuGrid) -> &GpuRun, value: fn(&GpuRun) -> f64) -> Vec<f64> {
        self.gpu(|grid| value(run(grid)))
    }
}

fn print_shares(results: &Results) {
    print_line!("\nTable 4: shares of a step at 32^3 [%]");
    print_line!("{:<38}{:>10}{:>12}{:>12}{:>12}", "", "ours, CPU", "thesis CPU", "ours, GPU", "thesis GPU");
    for (index, (name, cpu, gpu, _)) in THESIS_SHARES.into_iter().enumerate() {
        let ours = results.shares_percent[index].1;
        let on_gpu = results.gpu_shares_percent.get(index);
        let on_gpu = on_gpu.map_or("-".to_owned(), |(_, share)| format!("{share:.1}"));
        print_line!("{name:<38}{ours:>10.1}{cpu:>12.1}{on_gpu:>12}{gpu:>12.1}");
    }
}

fn print_pictures(pictures: &Pictures) {
    let Pictures { ms_beside_simulation, ms_alone } = pictures;
    print_line!("\nOne picture on the CPU [ms]\n{:<38}{:>10}{:>24}", "", "alone", "beside the simulation");
    print_line!("{:<38}{:>10.1}{:>24.1}", "all", ms_alone.median, ms_beside_simulation.median);
    for (name, time) in ms_alone.stages.iter() {
        print_line!("{name:<38}{time:>10.1}{:>24.1}", ms_beside_simulation.stages.sum(&[name]));
    }
}

fn heading() {
    print_line!("{:<38}{:>10}{:>10}{:>10}", "", "16^3", "32^3", "64^3");
}

/// A row, unless it is empty.
fn row(name: &str, values: Vec<f64>, digits: usize) {
    if values.is_empty() {
        return;
    }
    print_part!("{name:<38}");
    for value in values {
        print_part!("{value:>10.digits$}");
    }
    print_line!();
}
