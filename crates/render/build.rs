//! Links the WESL modules of the stages into one WGSL text each.

#[cfg(not(feature = "gpu"))]
fn main() {}

/// Modules with entry points; the others are imported by them.
#[cfg(feature = "gpu")]
const MODULES: [&str; 20] = [
    "bound_frames",
    "bound",
    "bound_outside",
    "tessellate",
    "interpolate",
    "fit",
    "opacity_depth",
    "opacity_layers",
    "occlude",
    "shade",
    "light_sums",
    "light_prepare",
    "light_grid",
    "light_gather",
    "shade_chiang",
    "sort",
    "draw",
    "body",
    "background",
    "resolve",
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
