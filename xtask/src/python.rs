//! A Python with numpy and usd-core, which read files of the program, and with what tests its package.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::cargo::root;

/// Variable that names the interpreter to the tests.
pub const NAMED: &str = "STRANDLINE_PYTHON";

/// Summary of the tests that need Python.
pub const NONE: &str = "no Python with numpy, usd-core, alembic3d, pytest and mypy: nobody else read moving caches and USD, and \
                        the Python package was not tested (STRANDLINE_PYTHON names one; with \
                        STRANDLINE_REQUIRE_PYTHON the tests fail without it)";

/// Packages that the tests need.
const PACKAGES: [&str; 5] = ["numpy", "usd-core", "alembic3d>=1.8.12,<2", "pytest>=8", "mypy>=1.15"];

/// The Python of the tests, if it has their packages. `setup` makes one in `target` if there is none, and
/// packages can be had.
pub fn prepare(setup: bool) -> Option<String> {
    let named = std::env::var(NAMED).unwrap_or_else(|_| "python3".to_owned());
    let own = folder().join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let own = own.to_string_lossy().into_owned();
    if let Some(python) = [&named, &own].into_iter().find(|python| is_whole(python)) {
        return Some(python.clone());
    }
    let made = setup
        && run("python3", &["-m", "venv", &folder().to_string_lossy()])
        && run(&own, &[&["-m", "pip", "install", "--quiet"], &PACKAGES[..]].concat());
    (made && is_whole(&own)).then_some(own)
}

fn folder() -> PathBuf {
    root().join("target/python")
}

fn is_whole(python: &str) -> bool {
    run(python, &["-c", "import numpy, pxr, alembic3d, pytest, mypy"])
}

fn run(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}
