//! Links the WESL modules of the stages into one WGSL text each.

/// Modules with entry points; the others are imported by them.
const STAGES: [&str; 9] =
    ["pose_roots", "integrate", "constrain", "splat", "mark", "solve_pressure", "gather", "advance", "scan"];

fn main() {
    println!("cargo::rerun-if-changed=src/gpu");
    let linker = wesl::Wesl::new("src/gpu");
    for stage in STAGES {
        let module = format!("package::{stage}").parse().expect("the name of a stage is a path");
        linker.build_artifact(&module, stage);
    }
}
