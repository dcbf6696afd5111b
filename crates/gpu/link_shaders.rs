//! For build scripts: links the WESL modules of a crate's stages, and what all crates share, into one WGSL text each.

use std::fmt::Write;
use std::path::{Path, PathBuf};

#[path = "src/threads.rs"]
mod threads;

/// What the shaders of every crate import as `package::kit`.
const KIT: &str = include_str!("kit/kit.wesl");

/// What a module with a kernel or a drawing has; the others are imported by such.
const ENTRIES: [&str; 3] = ["@compute", "@vertex", "@fragment"];

/// Links every module of a folder that has an entry point, and writes `linked.rs` for `strandline_gpu::linked!`, which
/// names them all.
pub fn link(folder: &str) {
    println!("cargo::rerun-if-changed={folder}");
    let linker = wesl::Wesl::new(beside_kit(folder));
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

/// A copy of a folder's modules with the kit beside them, since a package is one folder.
fn beside_kit(folder: &str) -> PathBuf {
    let out = std::env::var_os("OUT_DIR").expect("cargo names it");
    let package = Path::new(&out).join("shaders");
    // What was there before may be gone from the folder by now.
    let _ = std::fs::remove_dir_all(&package);
    std::fs::create_dir_all(&package).expect("cargo made the folder");
    for file in std::fs::read_dir(folder).expect("the shaders lie there") {
        let path = file.expect("a file of the folder").path();
        if path.extension().is_some_and(|ending| ending == "wesl") {
            let name = path.file_name().expect("it has an ending");
            std::fs::copy(&path, package.join(name)).expect("a shader can be read");
        }
    }
    let threads = threads::THREADS;
    let kit = format!("{KIT}\n// Threads of a workgroup: threads.rs.\nconst THREADS = {threads}u;\n");
    std::fs::write(package.join("kit.wesl"), kit).expect("cargo made the folder");
    package
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
