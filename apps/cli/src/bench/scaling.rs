//! How the cost of a step grows with strands and with cells.

use serde::Serialize;
use strandline::Scene;

use super::measure;

/// Strands of 16 points: from 10,000 to 320,000 points.
const STRANDS: [usize; 6] = [625, 1250, 2500, 5000, 10_000, 20_000];
/// Cells along each side.
const GRIDS: [u32; 4] = [16, 32, 64, 128];
const FRAMES: u32 = 60;

#[derive(Debug, Serialize)]
pub struct Results {
    strands: Vec<Row>,
    growth_of_time_per_point: f64,
    grids: Vec<Row>,
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

pub fn run() -> anyhow::Result<Results> {
    println!("strands of 16 points, 32^3 cells");
    heading();
    let strands = STRANDS.iter().map(|count| row(*count, 32)).collect::<Result<Vec<_>, _>>()?;
    let growth = strands[strands.len() - 1].ns_per_point / strands[0].ns_per_point;
    println!("time per point grows {growth:.2} times (at most 1.3 is promised)\n");
    println!("2,500 strands of 16 points");
    heading();
    let grids = GRIDS.iter().map(|cells| row(2500, *cells)).collect::<Result<Vec<_>, _>>()?;
    Ok(Results { strands, growth_of_time_per_point: growth, grids })
}

fn heading() {
    println!(
        "{:>8}{:>10}{:>10}{:>14}{:>14}{:>12}",
        "cells", "strands", "points", "fluid cells", "ms a step", "ns a point"
    );
}

fn row(strand_count: usize, cells: u32) -> anyhow::Result<Row> {
    let mut scene = Scene::demo();
    scene.style.strand_count = strand_count;
    scene.groom.points_per_strand = 16;
    scene.simulation.volume.cells = [cells; 3];
    scene.film.frames = FRAMES;
    let (report, ..) = measure(&scene, false, "frames")?;
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
    println!(
        "{:>6}^3{:>10}{:>10}{:>14.0}{:>14.2}{:>12.1}",
        row.cells, row.strands, row.points, row.fluid_cells, row.ms_per_step, row.ns_per_point
    );
    Ok(row)
}
