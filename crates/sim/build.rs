//! Links the WESL modules of the stages into one WGSL text each.

#[cfg(not(feature = "gpu"))]
fn main() {}

/// Modules with entry points; the others are imported by them.
#[cfg(feature = "gpu")]
const MODULES: [&str; 13] = [
    "pose_roots",
    "integrate",
    "constrain",
    "solve_rods",
    "splat",
    "order",
    "mark",
    "solve_pressure",
    "gather",
    "advance",
    "rooms",
    "pcg",
    "lengths_alone",
];

#[cfg(feature = "gpu")]
fn main() {
    println!("cargo::rerun-if-changed=src/gpu");
    let linker = wesl::Wesl::new("src/gpu");
    for name in MODULES {
        let module = format!("package::{name}").parse().expect("a name is a path");
        linker.build_artifact(&module, name);
    }
}
