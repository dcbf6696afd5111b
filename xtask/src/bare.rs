//! The program without GPUs and window: what may not be in it.

use std::process::Command;

use crate::cargo::root;

/// Crates that only GPUs and windows need.
const UNWANTED: [&str; 4] = ["wgpu", "eframe", "egui", "winit"];

/// The words for cargo that choose it.
pub const CHOICE: [&str; 3] = ["--package", "strandline-cli", "--no-default-features"];

/// Whether it is built from none of the crates that it can do without.
pub fn check() -> bool {
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
