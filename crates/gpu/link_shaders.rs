//! For build scripts: links each WESL module of a crate's stages, with the kit of all crates, into one WGSL text.

use std::fmt::Write;
use std::path::{Path, PathBuf};

#[path = "src/threads.rs"]
mod threads;

/// Module that the shaders of every crate import as `package::kit`.
const KIT: &str = include_str!("kit/kit.wesl");

/// Attributes of a module with a kernel or a drawing; other modules are imported by such.
const ENTRIES: [&str; 3] = ["@compute", "@vertex", "@fragment"];

/// Links every module of a folder that has an entry point, and writes `linked.rs` for `strandline_gpu::linked!`, which
/// names them all.
///
/// Names the sources alone to cargo, never the copies in `OUT_DIR`: those are newer than the script's own run, so
/// that every later build would run it again and compile the crate anew.
pub fn link(folder: &str) {
    println!("cargo::rerun-if-changed={folder}");
    let linker = wesl::Wesl::new(beside_kit(folder));
    let mut list = String::from("strandline_gpu::linked! {\n");
    for name in modules(folder) {
        let module = format!("package::{name}").parse().expect("a name is a path");
        match linker.compile(&module) {
            Ok(linked) => linked.write_artifact(&name),
            Err(error) => panic!("{folder}/{name}.wesl cannot be linked: {error}"),
        }
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
    // Files of an earlier build may be stale.
    let _ = std::fs::remove_dir_all(&package);
    std::fs::create_dir_all(&package).expect("cargo made the folder");
    for file in std::fs::read_dir(folder).expect("the shaders lie there") {
        let path = file.expect("a file of the folder").path();
        if path.extension().is_some_and(|ending| ending == "wesl") {
            let name = path.file_name().expect("it has an ending");
            let text = std::fs::read_to_string(&path).expect("a shader is text");
            std::fs::write(package.join(name), with_constants(&text)).expect("cargo made the folder");
        }
    }
    let (threads, many) = (threads::THREADS, threads::MANY);
    let sizes = format!("const THREADS = {threads}u;\nconst MANY = {many}u;\n");
    let kit = format!("{KIT}\n// Threads of a workgroup: threads.rs.\n{sizes}");
    std::fs::write(package.join("kit.wesl"), kit).expect("cargo made the folder");
    package
}

/// A shader with the constants that Rust owns: `const NAME = rust("cpu/file.rs");` takes the value of `NAME` in that
/// file of the crate (or of another, as in `../../groom/src/file.rs`), `rust("cpu/file.rs", f32)` as a number of that
/// type. Names in the value are constants of the shader.
fn with_constants(shader: &str) -> String {
    let line = |line: &str| match line.strip_prefix("const ").and_then(|rest| rest.split_once(" = rust(\"")) {
        None => line.to_owned(),
        Some((name, call)) => {
            let call = call.strip_suffix(");").expect("rust(...) ends its line");
            let (path, kind) = call.split_once('"').expect("rust(...) names a file");
            let value = constant(&Path::new("src").join(path), name, kind.strip_prefix(", "));
            format!("const {name} = {value};")
        }
    };
    shader.lines().map(|text| line(text) + "\n").collect()
}

/// The value of a constant in a Rust file, as a shader writes it.
fn constant(path: &Path, name: &str, kind: Option<&str>) -> String {
    println!("cargo::rerun-if-changed={}", path.display());
    let text = std::fs::read_to_string(path).expect("rust(...) names a file of a crate");
    let stem = format!("const {name}: ");
    let found = text.lines().find_map(|line| line.split_once(&stem)?.1.strip_suffix(';')?.split_once(" = "));
    let (own, value) = found.unwrap_or_else(|| panic!("no constant {name} in {}", path.display()));
    match own.strip_prefix('[').and_then(|own| own.split_once(';')) {
        None if value == "u32::MAX" => "0xffffffffu".to_owned(),
        None => expression(value, kind.unwrap_or(own)),
        Some((own, _)) => {
            let kind = kind.unwrap_or(own);
            format!("array({})", expression(value.trim_matches(['[', ']']), kind))
        }
    }
}

/// An expression with its numbers as a shader writes those of a type.
fn expression(text: &str, kind: &str) -> String {
    let mut written = String::new();
    let mut word = String::new();
    for character in text.chars().chain([' ']) {
        let begins_with_digit = word.starts_with(|first: char| first.is_ascii_digit());
        let of_exponent = begins_with_digit && word.ends_with('e') && character == '-';
        if character.is_ascii_alphanumeric() || ['.', '_'].contains(&character) || of_exponent {
            word.push(character);
            continue;
        }
        written.push_str(&if begins_with_digit { number(&word, kind) } else { word.clone() });
        written.push(character);
        word.clear();
    }
    written.trim_end().to_owned()
}

fn number(digits: &str, kind: &str) -> String {
    let digits = digits.replace('_', "");
    match kind {
        "f32" if !digits.contains(['.', 'e']) => format!("{digits}.0"),
        "f32" | "i32" => digits,
        "u32" | "usize" => format!("{digits}u"),
        other => panic!("a {other}, which a shader has not"),
    }
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
