//! Lints and documentation of our crates from the dependencies that are built for the tests. `cargo clippy` and
//! `cargo doc` check all dependencies once more, which takes as long as everything that they say of our crates.
//!
//! Cargo calls [`compile`] in place of rustc for crates of the workspace (`RUSTC_WORKSPACE_WRAPPER`). Cargo keeps what
//! was compiled this way apart from what rustc compiled alone: this is for a fresh checkout, as in CI.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use crate::cargo::{compile_through, root, wrapper};

/// Set for the copy of this program that cargo calls.
const CALLED: &str = "STRANDLINE_COMPILES_AND_LINTS";
/// Folder of what is made here, and in it the list of builds.
const FOLDER: &str = "target/beside";
const KNOWN: &str = "built.txt";

/// Lets each following call of cargo lint and document our crates; false where that is not possible, and where a plain
/// build is there already, as in a checkout that somebody works in: ours would be compiled twice.
pub fn begin() -> bool {
    let folder = root().join(FOLDER);
    let known = std::fs::read_to_string(folder.join(KNOWN)).unwrap_or_default();
    if libraries().iter().any(|name| !known.lines().any(|known| known == name)) {
        return false;
    }
    // Cargo builds this program anew while it runs.
    let copy = folder.join("xtask");
    let made = std::fs::create_dir_all(folder.join("out"))
        .and_then(|()| std::fs::copy(std::env::current_exe()?, &copy));
    if let Err(error) = &made {
        println!("lints are not run beside the build: {error}");
    }
    made.is_ok() && compile_through(copy, CALLED)
}

/// Notes what was built, so that the next run tells it from a plain build.
pub fn end() {
    let written = wrapper().map(|copy| std::fs::write(copy.with_file_name(KNOWN), libraries().join("\n")));
    if let Some(Err(error)) = written {
        println!("the next run will build anew: {error}");
    }
}

/// Names of the builds of the library that are there.
fn libraries() -> Vec<String> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let files = std::fs::read_dir(target.join("debug/deps")).into_iter().flatten().flatten();
    let names = files.filter_map(|file| file.file_name().into_string().ok());
    names.filter(|name| name.starts_with("libstrandline-") && name.ends_with(".rlib")).collect()
}

/// Name of the step that builds.
pub fn step() -> &'static str {
    if wrapper().is_some() { "build, lints and documentation" } else { "build" }
}

/// True where cargo calls this program in place of rustc.
pub fn is_called() -> bool {
    std::env::var_os(CALLED).is_some()
        && std::env::args().nth(1).is_some_and(|word| Path::new(&word).ends_with("rustc"))
}

/// Compiles a crate as rustc would, then lints it, then documents it unless it is a test.
pub fn compile() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(2).collect();
    let out = root().join(FOLDER).join("out");
    let rustc = std::env::args().nth(1).unwrap_or_default();
    // Clippy's own words: its tools set them where cargo asks for lints, and rustc knows none.
    let mut commands = vec![(rustc, words.clone())];
    if is_crate(&words) {
        let with = |mut words: Vec<String>, more: &[&str]| {
            words.extend(more.iter().map(|&word| word.to_owned()));
            words
        };
        let metadata = with(elsewhere(&words, &out), &["--emit=metadata", "-D", "warnings"]);
        commands.push(("clippy-driver".to_owned(), metadata));
        if !words.iter().any(|word| word == "--test") && !is_script(&words) {
            let private = if is_program(&words) { &["--document-private-items"][..] } else { &[] };
            let documented = with(with(elsewhere(&words, &out), &["-D", "warnings"]), private);
            commands.push(("rustdoc".to_owned(), documented));
        }
    }
    for (program, words) in commands {
        match Command::new(&program).args(words).status() {
            Ok(status) if status.success() => {}
            Ok(status) => return ExitCode::from(status.code().map_or(1, |code| code.clamp(1, 255) as u8)),
            Err(error) => {
                eprintln!("cannot run {program}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// True where a crate is compiled; cargo also asks rustc about itself.
fn is_crate(words: &[String]) -> bool {
    words.iter().any(|word| word.starts_with("--emit=")) && words.iter().any(|word| word.ends_with(".rs"))
}

/// True for the script of a build.
fn is_script(words: &[String]) -> bool {
    words.windows(2).any(|pair| pair[0] == "--crate-name" && pair[1].starts_with("build_script_"))
}

/// True for a program and an example.
fn is_program(words: &[String]) -> bool {
    words.windows(2).any(|pair| pair[0] == "--crate-type" && pair[1] == "bin")
}

/// The same crate into another folder: neither what cargo waits for is told nor what it keeps is touched.
fn elsewhere(words: &[String], out: &Path) -> Vec<String> {
    let mut words = words.iter();
    let mut other = Vec::new();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--out-dir" => drop(words.next()),
            "-C" => match words.next() {
                Some(value) if value.starts_with("incremental=") => {}
                value => other.extend([Some(word), value].into_iter().flatten().cloned()),
            },
            word if word.starts_with("--emit=") => {}
            word if word.starts_with("--json=") => {
                let told = word.trim_start_matches("--json=").split(',').filter(|&kind| kind != "artifacts");
                other.push(format!("--json={}", told.collect::<Vec<_>>().join(",")));
            }
            word => other.push(word.to_owned()),
        }
    }
    other.extend(["--out-dir".to_owned(), out.display().to_string()]);
    other
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn a_crate_goes_elsewhere_with_everything_that_shapes_it() {
        let cargo = words(
            "--crate-name strandline --edition=2024 crates/strandline/src/lib.rs --error-format=json \
             --json=diagnostic-rendered-ansi,artifacts,future-incompat --crate-type lib --emit=dep-info,metadata,link \
             -C opt-level=2 -C incremental=/t/i --cfg feature=\"gpu\" --out-dir /t/debug/deps --extern a=/t/liba.rmeta",
        );
        let other = words(
            "--crate-name strandline --edition=2024 crates/strandline/src/lib.rs --error-format=json \
             --json=diagnostic-rendered-ansi,future-incompat --crate-type lib \
             -C opt-level=2 --cfg feature=\"gpu\" --extern a=/t/liba.rmeta --out-dir /o",
        );
        assert_eq!(elsewhere(&cargo, Path::new("/o")), other);
        assert!(is_crate(&cargo) && !is_program(&cargo) && !is_script(&cargo));
    }

    #[test]
    fn questions_of_cargo_are_no_crates() {
        assert!(!is_crate(&words("-vV")));
        assert!(!is_crate(&words("- --crate-name ___ --print=file-names --crate-type bin")));
        assert!(is_program(&words("--crate-name xtask src/main.rs --crate-type bin --emit=link")));
        assert!(is_script(&words("--crate-name build_script_build build.rs --crate-type bin --emit=link")));
    }
}
