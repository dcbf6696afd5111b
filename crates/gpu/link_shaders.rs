//! For build scripts: links the WESL modules of a crate's stages into one WGSL text each.

use std::fmt::Write;
use std::path::Path;

/// What a module with a kernel or a drawing has; the others are imported by such.
const ENTRIES: [&str; 3] = ["@compute", "@vertex", "@fragment"];

/// Links every module of a folder that has an entry point, and writes `linked.rs` for `strandline_gpu::linked!`, which
/// names them all.
pub fn link(folder: &str) {
    println!("cargo::rerun-if-changed={folder}");
    let linker = wesl::Wesl::new(folder);
    let mut list = String::from("strandline_gpu::linked! {\n");
    for name in modules(folder) {
        let module = format!("package::{name}").parse().expect("a name is a path");
        linker.build_artifact(&module, &name);
        writeln!(list, "    {} = \"{name}\",", name.to_uppercase()).expect("a string takes all");
    }
    list.push_str("}\n");
    let out = std::env::var_os("OUT_DIR").expect("cargo names it");
    std::fs::write(Path::new(&out).join("linked.rs"), list).expect("cargo made the folder");
}

/// The names of the modules with entry points, in order.
fn modules(folder: &str) -> Vec<String> {
    let files = std::fs::read_dir(folder).expect("the shaders lie there");
    let mut names: Vec<String> = files
        .map(|file| file.expect("a file of the folder").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "wesl"))
        .filter(|path| {
            let text = std::fs::read_to_string(path).expect("a shader is text");
            ENTRIES.iter().any(|entry| text.lines().any(|line| line.starts_with(entry)))
        })
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    names
}
