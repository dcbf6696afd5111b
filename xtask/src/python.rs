//! A Python with numpy and usd-core, which read files of the program, and with what tests its package.

use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result};

use crate::cargo::{cargo_command, root};
use crate::programs::{self, Prints, Program};

/// Variable that names the interpreter to the tests.
pub const NAMED: &str = "STRANDLINE_PYTHON";

/// Summary of the tests that need Python.
pub const NONE: &str = "no Python with numpy, usd-core, alembic3d, ray, pyarrow, pytest, mypy and openjd-model: nobody else \
                        read moving caches and USD, and the Python package was not tested (STRANDLINE_PYTHON names \
                        one; with STRANDLINE_REQUIRE_PYTHON the tests fail without it)";

/// The tests of the package as a step.
pub const NAME: &str = "Python package";
/// All of them.
pub const ALL: [&str; 1] = ["python/tests"];

/// Packages that the tests need.
const PACKAGES: [&str; 8] = [
    "numpy",
    "usd-core",
    "alembic3d>=1.8.12,<2",
    "ray>=2.60,<3",
    "pyarrow>=15",
    "pytest>=8",
    "mypy>=1.15",
    "openjd-model>=0.13,<1",
];

/// Variable with the number of jobs that tests of sweeps run on two machines of a cluster, one of which is lost. With it
/// every page of the guide is run, else the short ones.
const JOBS: (&str, &str) = ("STRANDLINE_JOBS", "64");
/// Tests that have a long form.
const CLUSTER_TESTS: &str = "python/tests/test_cluster.py";
const GUIDE_TESTS: &str = "python/tests/test_guide.py";

/// Options of pytest in the long form: a test may take an hour.
const AN_HOUR_EACH: (&str, &str) = ("PYTEST_ADDOPTS", "-o faulthandler_timeout=3600");
/// Time that the long form may take: files for Blender alone took 43 minutes on a busy machine.
const LONG_FORM: Duration = Duration::from_secs(4 * 3600);

/// Variable that names a Python with Blender's module to the tests, which else leave Blender out.
const BLENDER: &str = "STRANDLINE_BLENDER";
/// Blender as a package, 374 MB, for Python 3.11 alone.
const BLENDER_PACKAGE: &str = "bpy==5.0.1";
/// Tests that Blender reads what is written for it.
const BLENDER_TESTS: &str = "python/tests/test_blender.py";

/// The Python of the tests, which may be on its way.
pub enum Coming {
    /// It has their packages.
    There(String),
    /// The packages of one in `target` are being installed.
    Packages(Child),
    /// There is none.
    Missing,
}

impl Coming {
    /// Looks for a Python with the packages of the tests. `setup` begins to make one in `target` if there is none.
    pub fn begin(setup: bool) -> Self {
        let named = std::env::var(NAMED).unwrap_or_else(|_| "python3".to_owned());
        let known = [named, interpreter("python")];
        if let Some(python) = known.into_iter().find(|python| is_whole(python)) {
            return Self::There(python);
        }
        let begun = if setup { begin("python", &PACKAGES) } else { None };
        begun.map_or(Self::Missing, Self::Packages)
    }

    /// The Python of the tests, once its packages are there; `None` if they cannot be had.
    pub fn wait(self) -> Option<String> {
        match self {
            Self::There(python) => Some(python),
            Self::Packages(mut installs) => {
                let own = interpreter("python");
                let installed = installs.wait().is_ok_and(|status| status.success());
                (installed && is_whole(&own)).then_some(own)
            }
            Self::Missing => None,
        }
    }
}

/// The Python of the tests, if it has their packages. `setup` makes one in `target` if there is none, and
/// packages can be had.
fn prepare(setup: bool) -> Option<String> {
    Coming::begin(setup).wait()
}

/// The Python of an environment in the target folder.
fn interpreter(environment: &str) -> String {
    let own = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
    root().join("target").join(environment).join(own).to_string_lossy().into_owned()
}

/// Makes an environment in the target folder and begins to install packages there. Modules are compiled when they are imported.
fn begin(environment: &str, packages: &[&str]) -> Option<Child> {
    let folder = root().join("target").join(environment);
    let made = run("python3", &["-m", "venv", &folder.to_string_lossy()]);
    let words = [&["-m", "pip", "install", "--quiet", "--no-compile"], packages].concat();
    if made { quiet(&interpreter(environment), &words).spawn().ok() } else { None }
}

/// Makes an environment in the target folder with packages.
fn make(environment: &str, packages: &[&str]) -> bool {
    let installs = begin(environment, packages);
    installs.is_some_and(|mut installs| installs.wait().is_ok_and(|status| status.success()))
}

/// A Python with Blender's module, which is named or in the target folder, or can be had.
fn blender() -> Option<String> {
    let has_it = |python: &String| run(python, &["-c", "import bpy"]);
    let own = interpreter("blender");
    let mut known = std::env::var(BLENDER).ok().into_iter().chain([own.clone()]);
    known.find(has_it).or_else(|| (make("blender", &[BLENDER_PACKAGE]) && has_it(&own)).then_some(own))
}

/// The tests of the package, or some of them, as a program; the package is built in the target folder.
pub fn program(python: &str, tests: &[&str], environment: &[(&str, &str)]) -> Result<Program> {
    let words = ["-m", "pytest", "-q", "-p", "no:cacheprovider"];
    let own = [("PYTHONPATH", &*installed()?.to_string_lossy()), ("PYTHONDONTWRITEBYTECODE", "1")].map(owned);
    Ok(Program {
        name: NAME.into(),
        path: python.into(),
        folder: root().to_owned(),
        prints: Prints::Python,
        arguments: words.iter().chain(tests).map(|&word| word.to_owned()).collect(),
        environment: own.into_iter().chain(environment.iter().copied().map(owned)).collect(),
        longest: programs::LONGEST,
    })
}

fn owned((name, value): (&str, &str)) -> (String, String) {
    (name.to_owned(), value.to_owned())
}

/// Builds the package and runs some of its tests; false if one fails.
fn passes(python: &str, tests: &[&str], environment: &[(&str, &str)], longest: Duration) -> bool {
    match program(python, tests, environment) {
        Ok(program) => programs::run(vec![Program { longest, ..program }], &[]).iter().all(|ran| ran.passed),
        Err(error) => {
            println!("the Python package is not tested: {error:#}");
            false
        }
    }
}

/// Builds the package and runs its tests alone; false if one fails, or without a Python that has what they need.
pub fn test() -> bool {
    let Some(python) = prepare(true) else {
        println!("{NONE}");
        return false;
    };
    passes(&python, &ALL, &[], programs::LONGEST)
}

/// Runs the long form of the tests of sweeps on a cluster. True if all of it passed.
pub fn long_cluster() -> bool {
    long(CLUSTER_TESTS, &[JOBS])
}

/// Runs all pages of the guide. True if all of it passed.
pub fn long_guide() -> bool {
    long(GUIDE_TESTS, &[JOBS])
}

/// Has Blender read what is written for it. True if all of it passed; false where Blender cannot be had.
pub fn long_blender() -> bool {
    let Some(python) = blender() else {
        println!(
            "Blender read nothing of ours: `pip install {BLENDER_PACKAGE}` has it for Python 3.11 alone ({BLENDER} \
             names a Python that has it)"
        );
        return false;
    };
    long(BLENDER_TESTS, &[(BLENDER, &*python)])
}

fn long(tests: &str, environment: &[(&str, &str)]) -> bool {
    let Some(python) = prepare(true) else {
        println!("the long tests of the Python package did not run: {NONE}");
        return false;
    };
    passes(&python, &[tests], &[environment, &[AN_HOUR_EACH]].concat(), LONG_FORM)
}

/// Writes the sections of a scene of the Python package from the settings table; false if that fails, true without a
/// Python that has what the package needs.
pub fn write_sections() -> bool {
    let Some(python) = prepare(false) else {
        println!("python/strandline/sections.py is not written: {NONE}");
        return true;
    };
    let written = installed().and_then(|site| {
        let mut command = Command::new(&python);
        command.args(["-P", "python/write_sections.py"]).current_dir(root()).env("PYTHONPATH", site);
        command.status().with_context(|| python.clone())
    });
    match written {
        Ok(status) => status.success(),
        Err(error) => {
            println!("python/strandline/sections.py is not written: {error:#}");
            false
        }
    }
}

/// The folder that has the package as it would be installed: its files, and the extension beside them.
fn installed() -> Result<PathBuf> {
    // With all tests: with one of them sim and what is above it were built once more with other features, in three minutes.
    let words = ["build", "--quiet", "--workspace", "--lib", "--tests"];
    anyhow::ensure!(cargo_command(&words).status()?.success(), "its extension is not built");
    let site = root().join("target/python-package");
    let package = site.join("strandline");
    std::fs::create_dir_all(&package)?;
    for entry in std::fs::read_dir(root().join("python/strandline"))? {
        let path = entry?.path();
        let is_part =
            path.extension().is_some_and(|ending| ["py", "pyi", "typed"].iter().any(|own| ending == *own));
        if let Some(name) = path.file_name().filter(|_| is_part) {
            std::fs::copy(&path, package.join(name))?;
        }
    }
    let [prefix, suffix] = [std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX];
    let library = root().join(format!("target/debug/{prefix}_native{suffix}"));
    let name = if cfg!(windows) { "_native.pyd" } else { "_native.abi3.so" };
    std::fs::copy(&library, package.join(name)).with_context(|| library.display().to_string())?;
    Ok(site)
}

fn is_whole(python: &str) -> bool {
    run(python, &["-c", "import numpy, pxr, alembic3d, ray, pyarrow, pytest, mypy, openjd.model"])
}

fn run(program: &str, arguments: &[&str]) -> bool {
    quiet(program, arguments).status().is_ok_and(|status| status.success())
}

/// A program that neither reads nor prints.
fn quiet(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}
