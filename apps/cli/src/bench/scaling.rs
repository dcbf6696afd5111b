//! Growth of the cost of a step with strands and with cells.

use serde::Serialize;
use strandline::{Error, Scene, Settings, SimError, device::GpuError};

use super::gpu::{Device, GpuRun};
use super::measure::measure;
use crate::output::print_line;
use crate::sim_report::SimReport;

/// Strands of 16 points: from 10,000 to 320,000 points.
const STRANDS: [usize; 6] = [625, 1250, 2500, 5000, 10_000, 20_000];
/// Cells along each side.
const GRIDS: [u32; 4] = [16, 32, 64, 128];
/// Frames of a row; in a short run.
const FRAMES: [u32; 2] = [60, 4];
/// On a GPU: strands of 32 points, doubled until the device refuses, or this many times.
const FIRST_ON_GPU: usize = 1250;
const DOUBLINGS: usize = 9;
/// Aims for a current data-centre GPU: strands, points, cells, most ms per step.
const PROMISED: [(usize, usize, u32, f64); 3] =
    [(1750, 6, 32, 0.3), (10_000, 32, 64, 0.8), (100_000, 32, 64, 3.0)];

#[derive(Debug, Serialize)]
pub struct Results {
    aims: Vec<Aim>,
    strands: Vec<Row>,
    growth_of_time_per_point: f64,
    grids: Vec<Row>,
    gpu: Option<OnGpu>,
}

#[derive(Debug, Serialize)]
struct Row {
    cells: u32,
    strands: usize,
    points: usize,
    fluid_cells: f64,
    ms_per_step: f64,
    ns_per_point: f64,
}

/// A scene that a step of rods is to keep to so many ms in, on a CPU of two cores.
#[derive(Debug, Serialize)]
struct Aim {
    scene: &'static str,
    most_ms_per_step: f64,
    run: SimReport,
}

#[derive(Debug, Serialize)]
struct OnGpu {
    promised: Vec<Promised>,
    sweep: Vec<GpuRow>,
    /// Errors of rows that the device refused; the first of a grid ends its sweep.
    refusals: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Promised {
    most_ms_per_step: f64,
    run: GpuRow,
}

#[derive(Debug, Serialize)]
struct GpuRow {
    cells: u32,
    strands: usize,
    points: usize,
    run: GpuRun,
}

pub fn run(device: Option<&Device>, quick: bool) -> anyhow::Result<Results> {
    let frames = FRAMES[usize::from(quick)];
    let aims = aims(frames, quick)?;
    print_line!("strands of 16 points, 32^3 cells");
    heading();
    let counts = if quick { &STRANDS[..2] } else { &STRANDS[..] };
    let strands = counts.iter().map(|count| row(*count, 32, frames)).collect::<Result<Vec<_>, _>>()?;
    let growth = strands[strands.len() - 1].ns_per_point / strands[0].ns_per_point;
    print_line!("time per point grows {growth:.2} times (at most 1.2 is promised)\n");
    print_line!("2,500 strands of 16 points");
    heading();
    let grids = if quick { &GRIDS[..2] } else { &GRIDS[..] };
    let grids = grids.iter().map(|cells| row(2500, *cells, frames)).collect::<Result<Vec<_>, _>>()?;
    let gpu = device.map(|device| on_gpu(device, frames, quick)).transpose()?;
    Ok(Results { aims, strands, growth_of_time_per_point: growth, grids, gpu })
}

/// The demo, the thesis's guides as rods, and as many strands as the hair of Sintel has.
fn aims(frames: u32, quick: bool) -> anyhow::Result<Vec<Aim>> {
    let (mut demo, mut guides) = (Scene::demo(), Scene::thesis());
    guides.simulation = Settings { volume: guides.simulation.volume, ..Scene::demo().simulation };
    (demo.film.frames, guides.film.frames) = (frames, frames);
    let scenes = [
        ("demo", 9.0, demo),
        ("1,750 guides of 6 points", 2.2, guides),
        ("11,400 strands of 16 points, 64^3 cells", 40.0, scene(11_400, 16, 64, frames)),
    ];
    print_line!("rods: {:<38}{:>10}{:>10}{:>12}", "", "ms a step", "aim", "solve_rods");
    let mut aims = Vec::new();
    for (name, most_ms_per_step, scene) in scenes.into_iter().take(if quick { 2 } else { 3 }) {
        let (run, ..) = measure(&scene, false, "frames")?;
        let [step, solve] = [run.ms_per_step.median, run.ms_per_step.stages.sum(&["solve_rods"])];
        print_line!("      {name:<38}{step:>10.2}{most_ms_per_step:>10.1}{solve:>12.2}");
        aims.push(Aim { scene: name, most_ms_per_step, run });
    }
    print_line!();
    Ok(aims)
}

fn heading() {
    print_line!(
        "{:>8}{:>10}{:>10}{:>14}{:>14}{:>12}",
        "cells",
        "strands",
        "points",
        "fluid cells",
        "ms a step",
        "ns a point"
    );
}

fn scene(strand_count: usize, points: usize, cells: u32, frames: u32) -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = strand_count;
    scene.groom.points_per_strand = points as u32;
    scene.simulation.volume.cells = [cells; 3];
    scene.film.frames = frames;
    // Nothing is drawn: follow strands would take memory alone.
    scene.look.follow_strands = 1;
    scene
}

fn row(strand_count: usize, cells: u32, frames: u32) -> anyhow::Result<Row> {
    let (report, ..) = measure(&scene(strand_count, 16, cells, frames), false, "frames")?;
    let points = report.strands * report.points_per_strand;
    let ms_per_step = report.ms_per_step.median;
    let row = Row {
        cells,
        strands: report.strands,
        points,
        fluid_cells: report.fluid_cells_mean,
        ms_per_step,
        ns_per_point: 1e6 * ms_per_step / points as f64,
    };
    print_line!(
        "{:>6}^3{:>10}{:>10}{:>14.0}{:>14.2}{:>12.1}",
        row.cells,
        row.strands,
        row.points,
        row.fluid_cells,
        row.ms_per_step,
        row.ns_per_point
    );
    Ok(row)
}

fn on_gpu(device: &Device, frames: u32, quick: bool) -> anyhow::Result<OnGpu> {
    print_line!("\non {}: aims for a data-centre GPU", device.adapter.name);
    gpu_heading();
    let (mut promised, mut sweep, mut refusals) = (Vec::new(), Vec::new(), Vec::new());
    let promises = if quick { &PROMISED[..1] } else { &PROMISED[..] };
    for (strands, points, cells, most_ms_per_step) in promises.iter().copied() {
        let scene = promised_scene(strands, points, cells, frames);
        if let Some(run) = gpu_row(device, &scene, &mut refusals)? {
            print_line!("{:>44}at most {most_ms_per_step} ms", "");
            promised.push(Promised { most_ms_per_step, run });
        }
    }
    print_line!("\nstrands of 32 points until the device refuses");
    gpu_heading();
    let grids = if quick { &GRIDS[..1] } else { &GRIDS[..] };
    for cells in grids {
        for doubling in 0..if quick { 1 } else { DOUBLINGS } {
            let scene = scene(FIRST_ON_GPU << doubling, 32, *cells, frames);
            let Some(row) = gpu_row(device, &scene, &mut refusals)? else { break };
            sweep.push(row);
        }
    }
    Ok(OnGpu { promised, sweep, refusals })
}

/// The thesis's scene, or the demo of another size.
fn promised_scene(strands: usize, points: usize, cells: u32, frames: u32) -> Scene {
    let mut scene = if points == 6 { Scene::thesis() } else { scene(strands, points, cells, frames) };
    scene.simulation.volume.cells = [cells; 3];
    scene.film.frames = frames;
    scene
}

/// True if memory or a limit of the device is the only obstacle.
fn is_refusal(error: &anyhow::Error) -> bool {
    let sim = error.downcast_ref::<SimError>().or(match error.downcast_ref::<Error>() {
        Some(Error::Sim(error)) => Some(error),
        _ => None,
    });
    matches!(sim.and_then(SimError::gpu), Some(GpuError::Limit { .. } | GpuError::OutOfMemory { .. }))
}

fn gpu_heading() {
    print_line!(
        "{:>8}{:>10}{:>10}{:>12}{:>12}{:>12}{:>12}{:>10}",
        "cells",
        "strands",
        "points",
        "ms a step",
        "wall ms",
        "solve ms",
        "dispatches",
        "copy %"
    );
}

/// A row of the table; `None` where memory or a limit of the device refuses it, which joins `refusals`.
fn gpu_row(device: &Device, scene: &Scene, refusals: &mut Vec<String>) -> anyhow::Result<Option<GpuRow>> {
    let cells = scene.simulation.volume.cells[0];
    let run = match device.measure(scene, "frames") {
        Err(error) if is_refusal(&error) => {
            print_line!("{error}");
            refusals.push(error.to_string());
            return Ok(None);
        }
        measured => measured?,
    };
    let (strands, points) = (run.steps.strands, run.steps.strands * run.steps.points_per_strand);
    print_line!(
        "{cells:>6}^3{strands:>10}{points:>10}{:>12.3}{:>12.3}{:>12.3}{:>12}{:>10.1}",
        run.steps.ms_per_step.median,
        run.wall_ms_per_step,
        run.steps.ms_per_step.stages.sum(&["solve_pressure"]),
        run.dispatches,
        100.0 * run.share_of_copy_bandwidth
    );
    Ok(Some(GpuRow { cells, strands, points, run }))
}
