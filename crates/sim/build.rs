//! Links the WESL modules of the stages into one WGSL text each.

/// Modules with entry points; the others are imported by them.
const MODULES: [&str; 12] = [
    "pose_roots",
    "integrate",
    "constrain",
    "solve_rods",
    "splat",
    "mark",
    "solve_pressure",
    "gather",
    "advance",
    "rooms",
    "pcg",
    "lengths_alone",
];

fn main() {
    println!("cargo::rerun-if-changed=src/gpu");
    let linker = wesl::Wesl::new("src/gpu");
    for name in MODULES {
        let module = format!("package::{name}").parse().expect("a name is a path");
        linker.build_artifact(&module, name);
    }
}
