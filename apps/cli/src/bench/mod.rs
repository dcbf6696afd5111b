//! `strandline bench`: the thesis's tables beside ours, and how cost grows.

mod chart;
#[cfg(feature = "gpu")]
mod forms;
mod gpu;
#[cfg(feature = "gpu")]
mod gpu_runs;
mod grooms;
mod machine;
mod measure;
#[cfg(not(feature = "gpu"))]
mod no_gpu_runs;
mod plot;
mod scaling;
mod tables;
mod thesis;
mod thesis_results;
mod view;
mod window;
mod workers;

pub use plot::plot;

use std::path::Path;

use serde::Serialize;
use strandline::{Error, file::WholeFile};

use crate::arguments::{Bench, BenchOptions};
use crate::output::print_line;
use gpu::{Adapter, Device};
use machine::Machine;

/// Content of a `--json` file: the measurements and their machine.
#[derive(Debug, Serialize)]
struct Baseline<T: Serialize> {
    bench: &'static str,
    version: &'static str,
    /// True for a release build.
    release: bool,
    machine: Machine,
    /// `None` if no GPU was measured.
    gpu: Option<Adapter>,
    /// True for a short run, whose figures mean little.
    quick: bool,
    results: T,
}

pub fn bench(options: &BenchOptions) -> anyhow::Result<()> {
    let machine = Machine::measured();
    machine.print();
    let device = Device::open(options.backend, options.quick)?;
    let device = device.as_ref();
    match options.what {
        Bench::Thesis => write(options, machine, device, "thesis", thesis::run(device, options.quick)?),
        Bench::View => write(options, machine, device, "view", view::run(device, options.quick)?),
        Bench::Workers => write(options, machine, device, "workers", workers::run(device, options.quick)?),
        Bench::Window => write(options, machine, device, "window", window::run(device, options)?),
        Bench::Groom => write(options, machine, device, "groom", grooms::run(device, options)?),
        Bench::Scaling => write(options, machine, device, "scaling", scaling::run(device, options.quick)?),
    }
}

fn write<T: Serialize>(
    options: &BenchOptions,
    machine: Machine,
    device: Option<&Device>,
    bench: &'static str,
    results: T,
) -> anyhow::Result<()> {
    let machine = Machine { peak_memory_mb: machine::peak_memory_mb(), ..machine };
    if let Some(memory) = machine.peak_memory_mb {
        print_line!("\npeak memory: {memory:.0} MB");
    }
    let Some(path) = options.json.as_deref() else { return Ok(()) };
    let gpu = device.map(|device| device.adapter.clone());
    let (version, release) = (env!("CARGO_PKG_VERSION"), !cfg!(debug_assertions));
    let baseline = Baseline { bench, version, release, machine, gpu, quick: options.quick, results };
    let mut text = serde_json::to_string_pretty(&baseline)?;
    text.push('\n');
    save(path, &text)?;
    print_line!("wrote {}", path.display());
    Ok(())
}

fn save(path: &Path, text: &str) -> Result<(), Error> {
    WholeFile::save(path, text.as_bytes()).map_err(|source| Error::Write {
        what: "the measurements",
        path: path.to_owned(),
        source,
    })
}
