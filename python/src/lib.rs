//! The extension module of the Python package: what `strandline/*.py` cannot do by itself. Arrays go in and come out,
//! scenes are TOML, and every long call lets other Python threads run.

#![forbid(unsafe_code)]

mod arrays;
mod cache;
mod errors;
mod grooms;
mod hair;
mod pictures;
mod scenes;
mod table;

use std::ffi::OsString;

use pyo3::prelude::*;
use strandline::device::Gpu;

/// The GPUs of this machine: number, name, interface, and true for a processor that emulates one.
#[pyfunction]
fn gpus(py: Python<'_>) -> PyResult<Vec<(usize, String, String, bool)>> {
    let adapters = errors::run(py, || Ok(Gpu::list()))?;
    Ok(adapters.into_iter().map(|gpu| (gpu.index, gpu.name, gpu.interface, gpu.software)).collect())
}

/// The `strandline` program with these words, the first of which is its name. Returns its exit code.
#[pyfunction]
fn program(py: Python<'_>, words: Vec<OsString>) -> PyResult<u8> {
    errors::run(py, || Ok(strandline_cli::run_program(words)))
}

/// The extension module.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    errors::keep_panics_quiet();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<hair::Hair>()?;
    module.add_class::<cache::Cache>()?;
    module.add_function(wrap_pyfunction!(gpus, module)?)?;
    module.add_function(wrap_pyfunction!(program, module)?)?;
    module.add_function(wrap_pyfunction!(grooms::load, module)?)?;
    module.add_function(wrap_pyfunction!(grooms::grow, module)?)?;
    module.add_function(wrap_pyfunction!(grooms::save, module)?)?;
    module.add_function(wrap_pyfunction!(grooms::resample, module)?)?;
    module.add_function(wrap_pyfunction!(grooms::load_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(grooms::mannequin, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::png, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::save_png, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::camera_matrices, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::view, module)?)?;
    module.add_function(wrap_pyfunction!(scenes::whole, module)?)?;
    module.add_function(wrap_pyfunction!(scenes::builtin, module)?)?;
    module.add_function(wrap_pyfunction!(scenes::check, module)?)?;
    module.add_function(wrap_pyfunction!(scenes::get, module)?)?;
    module.add_function(wrap_pyfunction!(scenes::explain, module)?)?;
    module.add_function(wrap_pyfunction!(scenes::head, module)?)?;
    module.add_function(wrap_pyfunction!(table::settings, module)?)?;
    Ok(())
}
