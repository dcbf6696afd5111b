//! The thesis's tables 2, 3 and 4 beside ours [Chen2011 §6].

use serde::Serialize;
use strandline::{Scene, sim::Preconditioner};

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
/// Frames simulated for each grid, and pictures drawn.
const FRAMES: u32 = 120;
const PICTURES: u32 = 15;

#[derive(Debug, Serialize)]
pub struct Results {
    grids: Vec<Grid>,
    ms_per_picture: Times,
    segments: usize,
    shares_percent: Vec<(&'static str, f64)>,
}

#[derive(Debug, Serialize)]
struct Grid {
    cells: u32,
    mic0: SimReport,
    jacobi: SimReport,
}

pub fn run() -> anyhow::Result<Results> {
    let mut scene = Scene::thesis();
    scene.film.frames = PICTURES;
    let (_, ms_per_picture, segments) = measure(&scene, true, "pictures")?;
    scene.film.frames = FRAMES;
    let mut grids = Vec::new();
    for cells in GRIDS {
        scene.simulation.volume.cells = [cells; 3];
        scene.simulation.volume.preconditioner = Preconditioner::Mic0;
        let (mic0, ..) = measure(&scene, false, "frames")?;
        scene.simulation.volume.preconditioner = Preconditioner::Jacobi;
        let (jacobi, ..) = measure(&scene, false, "frames")?;
        grids.push(Grid { cells, mic0, jacobi });
    }
    let shares_percent = shares(&grids[1].mic0);
    let results = Results { grids, ms_per_picture, segments, shares_percent };
    print(&results);
    Ok(results)
}

fn shares(report: &SimReport) -> Vec<(&'static str, f64)> {
    let stages = &report.ms_per_step.stages;
    let total: f64 = stages.iter().map(|(_, time)| time).sum();
    THESIS_SHARES.iter().map(|(name, _, _, parts)| (*name, 100.0 * stages.sum(parts) / total)).collect()
}

fn print(results: &Results) {
    let picture = results.ms_per_picture.median;
    println!(
        "\nTable 2: 1,750 guides x 6 points, {} segments drawn at 800x600, 2x2 samples",
        results.segments
    );
    println!("{:<34}{:>10}{:>10}{:>10}", "", "16^3", "32^3", "64^3");
    row("one step [ms]", results.grids.iter().map(|grid| grid.mic0.ms_per_step.median), 2);
    row("one picture [ms]", GRIDS.iter().map(|_| picture), 0);
    let whole = |grid: &Grid| 1e3 / (grid.mic0.ms_per_step.median + picture);
    row("ours, CPU, step and picture [fps]", results.grids.iter().map(whole), 2);
    row("ours, CPU, step alone [1/s]", results.grids.iter().map(|g| 1e3 / g.mic0.ms_per_step.median), 0);
    row("thesis, i7-930 + GTX 480 [fps]", THESIS_FPS[0].into_iter(), 2);
    row("thesis, 9600GT + GTX 480 [fps]", THESIS_FPS[1].into_iter(), 2);

    println!("\nTable 3: iterations of the pressure solve to 1e-5, relative (and absolute [m^2/s])");
    println!("{:<34}{:>10}{:>10}{:>10}", "", "16^3", "32^3", "64^3");
    row("ours, MIC(0), relative", results.grids.iter().map(|g| g.mic0.pcg.iterations_mean), 1);
    row("ours, MIC(0), absolute", results.grids.iter().map(|g| g.mic0.pcg.iterations_absolute_mean), 1);
    row("thesis, MIC", THESIS_ITERATIONS[0].into_iter(), 2);
    row("ours, Jacobi, relative", results.grids.iter().map(|g| g.jacobi.pcg.iterations_mean), 1);
    row("ours, Jacobi, absolute", results.grids.iter().map(|g| g.jacobi.pcg.iterations_absolute_mean), 1);
    row("thesis, Jacobi", THESIS_ITERATIONS[1].into_iter(), 2);
    row("fluid cells, mean", results.grids.iter().map(|g| g.mic0.fluid_cells_mean), 0);

    println!("\nTable 4: shares of a step at 32^3 [%]");
    println!("{:<34}{:>10}{:>12}{:>12}", "", "ours, CPU", "thesis CPU", "thesis GPU");
    for ((name, ours), (_, cpu, gpu, _)) in results.shares_percent.iter().zip(THESIS_SHARES) {
        println!("{name:<34}{ours:>10.1}{cpu:>12.1}{gpu:>12.1}");
    }
    println!("\nOne picture by stage [ms]");
    for (name, time) in results.ms_per_picture.stages.iter() {
        println!("{name:<34}{time:>10.1}");
    }
}

fn row(name: &str, values: impl Iterator<Item = f64>, digits: usize) {
    print!("{name:<34}");
    for value in values {
        print!("{value:>10.digits$}");
    }
    println!();
}
