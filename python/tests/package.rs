//! The tests of the Python package, run by the Python of STRANDLINE_PYTHON on the extension that cargo built.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The package as it would be installed: its files, and the extension beside them.
fn installed() -> tempfile::TempDir {
    let site = tempfile::tempdir().unwrap();
    let package = site.path().join("strandline");
    std::fs::create_dir(&package).unwrap();
    for entry in std::fs::read_dir(here().join("strandline")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ["py", "pyi", "typed"].iter().any(|own| ending == *own)) {
            std::fs::copy(&path, package.join(path.file_name().unwrap())).unwrap();
        }
    }
    let extension = package.join(if cfg!(windows) { "_native.pyd" } else { "_native.abi3.so" });
    std::fs::copy(library(), &extension).unwrap();
    site
}

fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The extension, which lies beside this program.
fn library() -> PathBuf {
    let name = format!("{}_native{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let program = std::env::current_exe().unwrap();
    let folder = program.parent().unwrap();
    [folder, folder.parent().unwrap()]
        .map(|folder| folder.join(&name))
        .into_iter()
        .find(|path| path.exists())
        .unwrap()
}

/// Runs the tests of a file; without a Python that has the packages of the tests a note says so.
fn run(words: &[&str]) {
    let Some(python) = std::env::var_os("STRANDLINE_PYTHON") else {
        assert!(std::env::var_os("STRANDLINE_REQUIRE_PYTHON").is_none(), "no Python is named");
        println!("not tested: STRANDLINE_PYTHON names no Python with numpy and pytest");
        return;
    };
    let site = installed();
    let mut command = Command::new(python);
    command.args(words).current_dir(here().join("tests")).env("PYTHONPATH", site.path());
    let done = command.env("PYTHONDONTWRITEBYTECODE", "1").output().unwrap();
    let [out, error] = [&done.stdout, &done.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    assert!(done.status.success(), "{out}\n{error}");
    println!("{}", out.trim().lines().last().unwrap_or_default());
}

const PYTEST: [&str; 5] = ["-m", "pytest", "-q", "-p", "no:cacheprovider"];

macro_rules! files {
    ($($name:ident: $file:literal;)*) => {$(
        #[test]
        fn $name() {
            run(&[&PYTEST[..], &[$file]].concat());
        }
    )*};
}

files! {
    grooms_bodies_and_scenes_are_plain_data: "test_data.py";
    simulations_move_and_are_drawn: "test_simulation.py";
    files_of_other_programs_come_back: "test_files.py";
    sweeps_resume: "test_sweeps.py";
    types_are_those_of_the_table: "test_types.py";
}
