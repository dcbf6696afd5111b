//! The thesis's tables 1 to 4 beside ours [Chen2011 §6].

use serde::Serialize;
use strandline::{
    Scene,
    sim::{Preconditioner, gpu::Gradient},
};

use super::gpu::{Device, GpuRun};
use super::measure;
use crate::sim::SimReport;
use crate::statistics::Times;

/// Cells along each side of the thesis's three grids.
const GRIDS: [u32; 3] = [16, 32, 64];
/// Frames per second of the thesis's whole system, CPU then GPU (table 2).
const THESIS_FPS: [[f64; 3]; 2] = [[21.8, 13.3, 3.19], [96.2, 86.5, 37.7]];
/// Iterations of the thesis's pressure solve, MIC then Jacobi (table 3).
const THESIS_ITERATIONS: [[f64; 3]; 2] = [[5.27, 5.91, 5.21], [17.0, 20.1, 16.6]];
/// Shares of the thesis's step on the CPU and the GPU \[%\], and the stages that they cover (table 4).
const THESIS_SHARES: [(&str, f64, f64, &[&str]); 3] = [
    ("constraints", 31.4, 19.4, &["constrain"]),
    ("volume", 65.7, 76.6, &["splat", "mark", "solve_pressure", "gather"]),
    ("forces, velocity, position", 2.9, 4.0, &["pose_roots", "integrate", "advance"]),
];
/// Frames simulated for each grid, and pictures drawn; in a short run.
const FRAMES: [u32; 2] = [120, 8];
const PICTURES: [u32; 2] = [15, 1];

#[derive(Debug, Serialize)]
pub struct Results {
    grids: Vec<Grid>,
    ms_per_picture: Times,
    segments: usize,
    shares_percent: Vec<(&'static str, f64)>,
    gpu_shares_percent: Vec<(&'static str, f64)>,
}

#[derive(Debug, Serialize)]
struct Grid {
    cells: u32,
    mic0: SimReport,
    jacobi: SimReport,
    gpu: Option<GpuGrid>,
}

#[derive(Debug, Serialize)]
struct GpuGrid {
    chebyshev: GpuRun,
    jacobi: GpuRun,
    /// The gradient as three kernels; it is one in the others.
    split_gradient: GpuRun,
}

pub fn run(device: Option<&Device>, quick: bool) -> anyhow::Result<Results> {
    let mut scene = Scene::thesis();
    scene.film.frames = PICTURES[usize::from(quick)];
    let (_, ms_per_picture, segments) = measure(&scene, true, "pictures")?;
    scene.film.frames = FRAMES[usize::from(quick)];
    let mut grids = Vec::new();
    for cells in GRIDS {
        scene.simulation.volume.cells = [cells; 3];
        scene.simulation.volume.preconditioner = Preconditioner::Mic0;
        let (mic0, ..) = measure(&scene, false, "frames")?;
        scene.simulation.volume.preconditioner = Preconditioner::Jacobi;
        let (jacobi, ..) = measure(&scene, false, "frames")?;
        let gpu = device.map(|device| on_gpu(device, &mut scene)).transpose()?;
        grids.push(Grid { cells, mic0, jacobi, gpu });
    }
    let shares_percent = shares(&grids[1].mic0);
    let gpu_shares_percent = grids[1].gpu.as_ref().map_or(Vec::new(), |gpu| shares(&gpu.chebyshev.steps));
    let results = Results { grids, ms_per_picture, segments, shares_percent, gpu_shares_percent };
    print(&results);
    Ok(results)
}

fn on_gpu(device: &Device, scene: &mut Scene) -> anyhow::Result<GpuGrid> {
    let jacobi = device.measure(scene, Gradient::Joint, "frames")?;
    scene.simulation.volume.preconditioner = Preconditioner::Chebyshev;
    let chebyshev = device.measure(scene, Gradient::Joint, "frames")?;
    let split_gradient = device.measure(scene, Gradient::Split, "frames")?;
    Ok(GpuGrid { chebyshev, jacobi, split_gradient })
}

fn shares(report: &SimReport) -> Vec<(&'static str, f64)> {
    let stages = &report.ms_per_step.stages;
    let total: f64 = stages.iter().map(|(_, time)| time).sum();
    THESIS_SHARES.iter().map(|(name, _, _, parts)| (*name, 100.0 * stages.sum(parts) / total)).collect()
}

fn print(results: &Results) {
    let grids = &results.grids;
    let gpu: Vec<&GpuGrid> = grids.iter().filter_map(|grid| grid.gpu.as_ref()).collect();
    let picture = results.ms_per_picture.median;
    let of = |run: fn(&GpuGrid) -> &GpuRun, value: fn(&GpuRun) -> f64| -> Vec<f64> {
        gpu.iter().map(|grid| value(run(grid))).collect()
    };
    let step: fn(&GpuRun) -> f64 = |run| run.steps.ms_per_step.median;
    print_gradient(&of);

    println!(
        "\nTable 2: 1,750 guides x 6 points, {} segments drawn at 800x600, 2x2 samples",
        results.segments
    );
    heading();
    row("one step, CPU [ms]", grids.iter().map(|grid| grid.mic0.ms_per_step.median), 2);
    row("one step, GPU [ms]", of(|grid| &grid.chebyshev, step).into_iter(), 3);
    row("one step queued, GPU, wall [ms]", of(|g| &g.chebyshev, |r| r.wall_ms_per_step).into_iter(), 3);
    row("one picture, CPU [ms]", GRIDS.iter().map(|_| picture), 0);
    let whole = |grid: &Grid| 1e3 / (grid.mic0.ms_per_step.median + picture);
    row("ours, CPU, step and picture [fps]", grids.iter().map(whole), 2);
    row("ours, CPU, step alone [1/s]", grids.iter().map(|g| 1e3 / g.mic0.ms_per_step.median), 0);
    row("ours, GPU, step alone [1/s]", of(|g| &g.chebyshev, step).into_iter().map(|ms| 1e3 / ms), 0);
    row("thesis, i7-930 + GTX 480 [fps]", THESIS_FPS[0].into_iter(), 2);
    row("thesis, 9600GT + GTX 480 [fps]", THESIS_FPS[1].into_iter(), 2);
    print_costs(&of);

    println!("\nTable 3: iterations of the pressure solve to 1e-5, relative (and absolute [m^2/s])");
    heading();
    row("ours, MIC(0), relative", grids.iter().map(|g| g.mic0.pcg.iterations_mean), 1);
    row("ours, MIC(0), absolute", grids.iter().map(|g| g.mic0.pcg.iterations_absolute_mean), 1);
    row("thesis, MIC", THESIS_ITERATIONS[0].into_iter(), 2);
    row("ours, Jacobi, relative", grids.iter().map(|g| g.jacobi.pcg.iterations_mean), 1);
    row("ours, Jacobi, absolute", grids.iter().map(|g| g.jacobi.pcg.iterations_absolute_mean), 1);
    let iterations: fn(&GpuRun) -> f64 = |run| run.steps.pcg.iterations_mean;
    row("ours, GPU, Jacobi, relative", of(|grid| &grid.jacobi, iterations).into_iter(), 1);
    row("ours, GPU, Chebyshev, relative", of(|grid| &grid.chebyshev, iterations).into_iter(), 1);
    row("thesis, Jacobi", THESIS_ITERATIONS[1].into_iter(), 2);
    row("fluid cells, mean", grids.iter().map(|g| g.mic0.fluid_cells_mean), 0);
    let solve: fn(&GpuRun) -> f64 = |run| run.steps.ms_per_step.stages.sum(&["solve_pressure"]);
    row("solve, GPU, Jacobi [ms]", of(|grid| &grid.jacobi, solve).into_iter(), 3);
    row("solve, GPU, Chebyshev [ms]", of(|grid| &grid.chebyshev, solve).into_iter(), 3);

    print_shares(results);
    println!("\nOne picture by stage [ms]");
    for (name, time) in results.ms_per_picture.stages.iter() {
        println!("{name:<34}{time:>10.1}");
    }
}

/// Values of the runs on the GPU, a number for each grid.
type Of<'a> = dyn Fn(fn(&GpuGrid) -> &GpuRun, fn(&GpuRun) -> f64) -> Vec<f64> + 'a;

fn print_gradient(of: &Of) {
    let solve: fn(&GpuRun) -> f64 = |run| run.steps.ms_per_step.stages.sum(&["solve_pressure"]);
    let joint = of(|grid| &grid.chebyshev, solve);
    if joint.is_empty() {
        return;
    }
    println!("\nTable 1: the solve with the pressure gradient as one kernel and as three");
    heading();
    row("one kernel [ms]", joint.into_iter(), 4);
    row("three kernels [ms]", of(|grid| &grid.split_gradient, solve).into_iter(), 4);
}

fn print_costs(of: &Of) {
    row("GPU, dispatches", of(|g| &g.chebyshev, |run| run.dispatches as f64).into_iter(), 0);
    let without = of(|g| &g.chebyshev, |run| run.dispatches_without_solve as f64);
    row("GPU, dispatches without the solve", without.into_iter(), 0);
    row(
        "GPU, MB a step without the solve",
        of(|g| &g.chebyshev, |r| r.bytes_per_step as f64 * 1e-6).into_iter(),
        2,
    );
    let share = of(|g| &g.chebyshev, |run| 100.0 * run.share_of_copy_bandwidth);
    row("GPU, share of the copy bandwidth [%]", share.into_iter(), 1);
}

fn print_shares(results: &Results) {
    println!("\nTable 4: shares of a step at 32^3 [%]");
    println!("{:<34}{:>10}{:>12}{:>12}{:>12}", "", "ours, CPU", "thesis CPU", "ours, GPU", "thesis GPU");
    for (index, (name, cpu, gpu, _)) in THESIS_SHARES.into_iter().enumerate() {
        let ours = results.shares_percent[index].1;
        let on_gpu = results.gpu_shares_percent.get(index);
        let on_gpu = on_gpu.map_or("-".to_owned(), |(_, share)| format!("{share:.1}"));
        println!("{name:<34}{ours:>10.1}{cpu:>12.1}{on_gpu:>12}{gpu:>12.1}");
    }
}

fn heading() {
    println!("{:<36}{:>10}{:>10}{:>10}", "", "16^3", "32^3", "64^3");
}

/// A row, unless there is nothing in it.
fn row(name: &str, values: impl Iterator<Item = f64>, digits: usize) {
    let values: Vec<f64> = values.collect();
    if values.is_empty() {
        return;
    }
    print!("{name:<36}");
    for value in values {
        print!("{value:>10.digits$}");
    }
    println!();
}
