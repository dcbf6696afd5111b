//! `strandline plot`: measurements drawn as the thesis draws its own [Chen2011 fig. 35, 36].

use std::path::Path;

use anyhow::anyhow;
use serde::Deserialize;
use strandline::{
    Error,
    file::{WholeFile, read_plain},
};

use super::chart::{Chart, Line, svg};
use crate::arguments::PlotOptions;
use crate::output::print_line;

/// Colours of the lines.
const COLORS: [&str; 4] = ["#1f6fb4", "#d1601d", "#2f8f3c", "#8a4fb0"];

/// Fields common to all files of measurements.
#[derive(Deserialize)]
struct Measured {
    bench: String,
    machine: Machine,
    quick: bool,
    /// Absent in files of older versions.
    release: Option<bool>,
    gpu: Option<Gpu>,
    results: serde_json::Value,
}

#[derive(Deserialize)]
struct Machine {
    cpu: String,
    threads: usize,
}

/// The GPU that was measured.
#[derive(Deserialize)]
struct Gpu {
    name: String,
    software: bool,
}

impl Measured {
    /// The machine of the figures, and reasons why they may mean little.
    fn note(&self) -> String {
        let Machine { cpu, threads } = &self.machine;
        let mut note = format!("{cpu}, {threads} threads");
        if let Some(gpu) = &self.gpu {
            note += &format!("; GPU: {}", gpu.name);
            note += if gpu.software { ", which is software" } else { "" };
        }
        note += if self.release == Some(false) { "; no release build" } else { "" };
        note + if self.quick { "; a quick run whose figures mean little" } else { "" }
    }
}

/// Largest file of measurements \[byte\]: they have some thousand.
const MOST: u64 = 16 << 20;

/// Plotted fields of `bench thesis`.
#[derive(Deserialize)]
struct Thesis {
    grids: Vec<Grid>,
}

#[derive(Deserialize)]
struct Grid {
    cells: f64,
    whole_on_cpu: Whole,
    gpu: Option<GpuGrid>,
    thesis_frames_per_second: [f64; 2],
}

#[derive(Deserialize)]
struct GpuGrid {
    whole_simulated_on_cpu: Whole,
    whole: Whole,
}

#[derive(Deserialize)]
struct Whole {
    frames_per_second: f64,
}

/// Plotted fields of `bench view`.
#[derive(Deserialize)]
struct View {
    backends: Vec<OnBackend>,
}

#[derive(Deserialize)]
struct OnBackend {
    backend: String,
    rows: Vec<Row>,
}

#[derive(Deserialize)]
struct Row {
    width: u32,
    height: u32,
    distance_m: f64,
    frames_per_second: f64,
    thesis_frames_per_second: f64,
}

/// Draws a file of measurements.
pub fn plot(options: &PlotOptions) -> anyhow::Result<()> {
    let path = options.file.as_path();
    let text = read_plain(path, MOST)
        .and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other))
        .map_err(|error| anyhow!("cannot read the measurements: {error}: {}", path.display()))?;
    let text = charts(&text).map_err(|error| wrong(path, &error))?;
    let out = options.out.clone().unwrap_or_else(|| path.with_extension("svg"));
    WholeFile::save(&out, text.as_bytes()).map_err(|source| Error::Write {
        what: "the plot",
        path: out.clone(),
        source,
    })?;
    print_line!("wrote {}", out.display());
    Ok(())
}

fn wrong(path: &Path, error: &anyhow::Error) -> anyhow::Error {
    let expected = "expected what `bench thesis --json FILE` or `bench view --json FILE` writes";
    anyhow!("no measurements to plot: {error}, {expected}: {}", path.display())
}

fn charts(text: &str) -> anyhow::Result<String> {
    let measured: Measured = serde_json::from_str(text)?;
    let note = measured.note();
    Ok(match measured.bench.as_str() {
        "thesis" => svg(&[by_grid(serde_json::from_value(measured.results)?, note)]),
        "view" => {
            let view: View = serde_json::from_value(measured.results)?;
            let charts = view.backends.iter().map(|on| by_distance(on, &note));
            svg(&charts.collect::<Vec<_>>())
        }
        found => anyhow::bail!("measurements of `bench {found}`"),
    })
}

/// Figure 35: frames per second of the whole system against the number of cells.
fn by_grid(thesis: Thesis, note: String) -> Chart {
    let grids = &thesis.grids;
    let line = |name: &str, color: usize, dashed, value: &dyn Fn(&Grid) -> Option<f64>| Line {
        name: name.to_owned(),
        color: COLORS[color],
        dashed,
        points: grids.iter().filter_map(|grid| Some([grid.cells, value(grid)?])).collect(),
    };
    let gpu = |grid: &Grid, whole: fn(&GpuGrid) -> &Whole| Some(whole(grid.gpu.as_ref()?).frames_per_second);
    let lines = [
        line("thesis, simulated on GPU", 0, true, &|grid| Some(grid.thesis_frames_per_second[1])),
        line("thesis, simulated on CPU", 1, true, &|grid| Some(grid.thesis_frames_per_second[0])),
        line("ours, all on GPU", 0, false, &|grid| gpu(grid, |gpu| &gpu.whole)),
        line("ours, drawn on GPU", 1, false, &|grid| gpu(grid, |gpu| &gpu.whole_simulated_on_cpu)),
        line("ours, all on CPU", 2, false, &|grid| Some(grid.whole_on_cpu.frames_per_second)),
    ];
    Chart {
        title: "Frames per second against cells [Chen2011 fig. 35]".to_owned(),
        note,
        x_label: "cells along a side of the grid",
        y_label: "frames per second",
        x_ticks: grids.iter().map(|grid| grid.cells).collect(),
        x_logarithmic: true,
        lines: lines.into_iter().filter(|line| !line.points.is_empty()).collect(),
    }
}

/// Figure 36: frames per second against the viewing distance, a line for each size of the picture.
fn by_distance(on: &OnBackend, note: &str) -> Chart {
    let mut sizes: Vec<(u32, u32)> = on.rows.iter().map(|row| (row.width, row.height)).collect();
    sizes.dedup();
    let mut lines = Vec::new();
    for (name, dashed) in [("thesis", true), ("ours", false)] {
        for ((width, height), color) in sizes.iter().zip(COLORS.iter().cycle()) {
            let rows = on.rows.iter().filter(|row| (row.width, row.height) == (*width, *height));
            let fps = |row: &Row| if dashed { row.thesis_frames_per_second } else { row.frames_per_second };
            lines.push(Line {
                name: format!("{name}, {width}x{height}"),
                color,
                dashed,
                points: rows.map(|row| [row.distance_m, fps(row)]).collect(),
            });
        }
    }
    let mut x_ticks: Vec<f64> = on.rows.iter().map(|row| row.distance_m).collect();
    x_ticks.sort_by(f64::total_cmp);
    x_ticks.dedup();
    Chart {
        title: format!("Frames per second against viewing distance, on {} [Chen2011 fig. 36]", on.backend),
        note: note.to_owned(),
        x_label: "viewing distance [m]",
        y_label: "frames per second",
        x_ticks,
        x_logarithmic: true,
        lines,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = r#""machine": {"cpu": "An Example 9", "threads": 2}, "quick": false"#;

    #[test]
    fn grids_become_a_line_for_each_way_to_run() {
        let grid = |cells: u32, fps: f64| {
            format!(
                r#"{{"cells": {cells}, "whole_on_cpu": {{"frames_per_second": {fps}}}, "gpu": null, "thesis_frames_per_second": [20, 90]}}"#
            )
        };
        let text = format!(
            r#"{{"bench": "thesis", {HEAD}, "results": {{"grids": [{}, {}]}}}}"#,
            grid(16, 4.0),
            grid(64, 2.0)
        );
        let drawn = charts(&text).unwrap();
        assert_eq!(drawn.matches("<polyline").count(), 3, "two of the thesis, one of ours: {drawn}");
        assert!(drawn.contains("An Example 9, 2 threads<"));
        // From 2 to 100: 4 lies 18 % up, 2 at the foot.
        assert!(drawn.contains("points=\"70.0,317.7 540.0,374.0\""), "{drawn}");
    }

    #[test]
    fn distances_become_a_line_for_each_size_of_each() {
        let row = |width: u32, distance: f64| {
            format!(
                r#"{{"width": {width}, "height": 600, "distance_m": {distance}, "frames_per_second": 3.0, "thesis_frames_per_second": 44}}"#
            )
        };
        let rows = [row(800, 0.2), row(800, 3.0), row(1024, 0.2), row(1024, 3.0)].join(", ");
        let text = format!(
            r#"{{"bench": "view", {HEAD}, "results": {{"backends": [{{"backend": "cpu", "rows": [{rows}]}}]}}}}"#
        );
        let drawn = charts(&text).unwrap();
        assert_eq!(drawn.matches("<polyline").count(), 4);
        assert!(drawn.contains("thesis, 1024x600"));
    }

    #[test]
    fn what_was_measured_on_is_said() {
        let text = r#"{"bench": "view", "machine": {"cpu": "X", "threads": 2}, "quick": true, "release": false,
            "gpu": {"name": "llvmpipe", "software": true, "timestamps": true}, "results": null}"#;
        let note = serde_json::from_str::<Measured>(text).unwrap().note();
        let expected = "X, 2 threads; GPU: llvmpipe, which is software; no release build; a quick run whose figures mean little";
        assert_eq!(note, expected);
    }

    #[test]
    fn other_files_are_refused() {
        assert!(charts("[").is_err() && charts(r#"{"bench": "thesis"}"#).is_err());
        let window = format!(r#"{{"bench": "window", {HEAD}, "results": {{}}}}"#);
        assert!(charts(&window).unwrap_err().to_string().contains("bench window"));
    }
}
