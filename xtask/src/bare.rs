//! The program without GPUs and window: crates that it must not contain, and a trial run.

use std::path::Path;
use std::process::Command;

use crate::cargo::{cargo_command, root};

/// Crates that only GPUs and windows need.
const UNWANTED: [&str; 4] = ["wgpu", "eframe", "egui", "winit"];

/// The words for cargo that choose it.
const CHOICE: [&str; 3] = ["--package", "strandline-cli", "--no-default-features"];

/// The packages of the program that have features for GPUs and the window.
pub const PACKAGES: [&str; 5] =
    ["strandline-gpu", "strandline-sim", "strandline-render", "strandline", "strandline-cli"];

/// Commands of the trial run, in a folder of its own: a step of hair, and a picture of it.
const RUNS: [&[&str]; 2] = [
    &["sim", "--scene", "bare.toml", "--frames", "2", "--json"],
    &["render", "--scene", "bare.toml", "--frames", "1", "--out", "bare.png", "--json"],
];
/// Hair that takes no time.
const SCENE: &str = "[style]\nstrand_count = 40\n[body]\nspacing = 0.02\n[film]\nsettle = 0.0\n\
                     [picture]\nwidth = 64\nheight = 48\n[simulation]\nvolume.cells = [8, 8, 8]\n";

/// Checks that the bare program is built without optional crates, and runs it.
pub fn check() -> bool {
    is_built_from_what_it_needs() && runs()
}

/// Builds it, our crates without optimization, and runs it in a folder of its own.
fn runs() -> bool {
    let target = root().join("target/bare");
    let mut build = cargo_command(&["build", "--quiet", "--config", "profile.dev.opt-level=0"]);
    let built = build.arg("--target-dir").arg(&target).args(CHOICE).status();
    if !built.is_ok_and(|status| status.success()) {
        println!("the program without GPUs and window is not built");
        return false;
    }
    let folder = target.join("run");
    let written =
        std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(folder.join("bare.toml"), SCENE));
    if let Err(error) = written {
        println!("no scene for the program without GPUs and window: {error}");
        return false;
    }
    let picture = folder.join("bare.png");
    // Of an earlier run.
    let _ = std::fs::remove_file(&picture);
    let program = target.join("debug").join(format!("strandline{}", std::env::consts::EXE_SUFFIX));
    let works = RUNS.iter().all(|words| run(&program, words, &folder));
    if works && !picture.is_file() {
        println!("the program without GPUs and window drew no {}", picture.display());
    }
    works && picture.is_file()
}

fn run(program: &Path, words: &[&str], folder: &Path) -> bool {
    let output = Command::new(program).args(words).current_dir(folder).output();
    let said = match output {
        Ok(output) if output.status.success() => return true,
        Ok(output) => String::from_utf8_lossy(&output.stderr).into_owned(),
        Err(error) => error.to_string(),
    };
    println!("the program without GPUs and window, {}: {said}", words.join(" "));
    false
}

/// Checks that no crate of it is one that it can do without.
pub fn is_built_from_what_it_needs() -> bool {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let tree = ["tree", "--edges", "normal,build", "--prefix", "none"];
    let output = Command::new(cargo).args(tree).args(CHOICE).current_dir(root()).output();
    let listed = output.ok().filter(|output| output.status.success());
    let Some(listed) = listed.and_then(|output| String::from_utf8(output.stdout).ok()) else {
        println!("cargo tree does not list the program without GPUs");
        return false;
    };
    let found = unwanted(&listed);
    found.iter().for_each(|name| println!("the program without GPUs and window is built from {name}"));
    found.is_empty()
}

/// Crates of the list that should not be there.
fn unwanted(listed: &str) -> Vec<&'static str> {
    let names: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    UNWANTED.into_iter().filter(|name| names.contains(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_unwanted_is_found() {
        assert_eq!(unwanted("strandline-cli v0.1.0\nwgpu v30.0.0\nwgpu-types v30.0.0\n"), ["wgpu"]);
        assert!(unwanted("strandline-cli v0.1.0\nglam v0.34.0 (*)\n").is_empty());
    }
}
