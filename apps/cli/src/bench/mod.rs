//! `strandline bench`: the thesis's tables beside ours, and how cost grows.

mod machine;
mod scaling;
mod thesis;

use std::path::Path;

use serde::Serialize;
use strandline::{Backend, Error, Event, Player, Scene};

use crate::arguments::{Bench, BenchOptions};
use crate::progress::Progress;
use crate::sim::{SimReport, Steps};
use crate::statistics::{Collector, Times};

/// What is written with `--json`: the measurements and what they were made on.
#[derive(Debug, Serialize)]
struct Baseline<T: Serialize> {
    bench: &'static str,
    version: &'static str,
    backend: &'static str,
    machine: machine::Machine,
    results: T,
}

pub fn bench(options: &BenchOptions) -> anyhow::Result<()> {
    let path = options.json.as_deref();
    match options.what {
        Bench::Thesis => write(path, "thesis", thesis::run()?),
        Bench::Scaling => write(path, "scaling", scaling::run()?),
    }
}

fn write<T: Serialize>(path: Option<&Path>, bench: &'static str, results: T) -> anyhow::Result<()> {
    let machine = machine::Machine::here();
    println!("\nmachine: {}, {} threads, backend {}", machine.cpu, machine.threads, Backend::auto().name());
    if let Some(memory) = machine.peak_memory_mb {
        println!("peak memory: {memory:.0} MB");
    }
    let Some(path) = path else { return Ok(()) };
    let version = env!("CARGO_PKG_VERSION");
    let baseline = Baseline { bench, version, backend: Backend::auto().name(), machine, results };
    let mut text = serde_json::to_string_pretty(&baseline)?;
    text.push('\n');
    std::fs::write(path, text).map_err(|source| Error::Write {
        what: "the measurements",
        path: path.to_owned(),
        source,
    })?;
    println!("wrote {}", path.display());
    Ok(())
}

/// Plays a scene and measures its steps, and its pictures when `draw`.
fn measure(scene: &Scene, draw: bool, what: &'static str) -> Result<(SimReport, Times, usize), Error> {
    let backend = Backend::auto();
    let mut player = Player::new(scene, &backend, draw)?;
    let (mut steps, mut pictures) = (Steps::default(), Collector::default());
    let mut segments = 0;
    let mut progress = Progress::new(u64::from(player.frames()), what, false);
    while let Some(event) = player.next() {
        match event? {
            Event::Stepped(report) => steps.add(&report),
            Event::Drawn { report, .. } => {
                pictures.add(&report.seconds);
                segments = report.segments;
            }
        }
        progress.reached(u64::from(player.frames_done()));
    }
    let guides = player.hair().guides();
    let report = steps.report(backend.name(), guides.strand_count(), guides.points_per_strand());
    Ok((report, pictures.times(), segments))
}
