//! For build scripts: links each WESL module of a crate's stages, with the kit of all crates, into one WGSL text.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[path = "src/threads.rs"]
mod threads;

/// The module that the shaders of every crate import as `package::kit`.
const KIT: &str = include_str!("kit/kit.wesl");

/// The modules of signed distances that simulation and pictures import, with a module `solid_rows` of their own.
const SOLIDS: [(&str, &str); 5] = [
    ("solid_table", include_str!("../body/src/solid_table.wesl")),
    ("skin_side", include_str!("../body/src/skin_side.wesl")),
    ("skin_table", include_str!("../body/src/skin_table.wesl")),
    ("skins", include_str!("../body/src/skins.wesl")),
    ("triangle_place", include_str!("../body/src/triangle_place.wesl")),
];

/// Marks of an entry point.
const ENTRIES: [&str; 3] = ["@compute", "@vertex", "@fragment"];

/// Links every module below a folder that has an entry point, and writes `linked.rs` for `strandline_gpu::linked!`,
/// which names them all. Folders order the files alone: a module is `package::NAME`, wherever it lies.
///
/// Names the sources alone to cargo, never the copies in `OUT_DIR`: those are newer than the script's own run, so
/// that every later build would run it again and compile the crate anew.
pub fn link(folder: &str) {
    println!("cargo::rerun-if-changed={folder}");
    let shaders = shaders(Path::new(folder));
    let linker = wesl::Wesl::new(beside_kit(&shaders));
    let mut list = String::from("strandline_gpu::linked! {\n");
    for (name, _) in shaders.iter().filter(|(_, text)| has_entry(text)) {
        let module = format!("package::{name}").parse().expect("a name is a path");
        match linker.compile(&module) {
            Ok(linked) => linked.write_artifact(name),
            Err(error) => panic!("{name}.wesl below {folder} cannot be linked: {error}"),
        }
        writeln!(list, "    {} = \"{name}\",", name.to_uppercase()).expect("a string takes all");
    }
    list.push_str("}\n");
    let out = std::env::var_os("OUT_DIR").expect("cargo names it");
    std::fs::write(Path::new(&out).join("linked.rs"), list).expect("cargo made the folder");
}

/// The shader modules below a folder, by name: the text of each.
fn shaders(folder: &Path) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for file in std::fs::read_dir(&folder).expect("the shaders lie there") {
            let path = file.expect("a file of the folder").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "wesl") {
                let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a module has a name");
                let text = std::fs::read_to_string(&path).expect("a shader is text");
                let other = found.insert(name.to_owned(), text);
                assert!(
                    other.is_none() && name != "kit" && SOLIDS.iter().all(|(known, _)| *known != name),
                    "two modules are called {name}: {}",
                    path.display()
                );
            }
        }
    }
    found
}

/// A copy of modules in one folder with the kit beside them, since a package is one folder.
fn beside_kit(shaders: &BTreeMap<String, String>) -> PathBuf {
    let out = std::env::var_os("OUT_DIR").expect("cargo names it");
    let package = Path::new(&out).join("shaders");
    // A module that was renamed leaves its old copy there.
    let _ = std::fs::remove_dir_all(&package);
    std::fs::create_dir_all(&package).expect("cargo made the folder");
    for (name, text) in shaders {
        let file = package.join(format!("{name}.wesl"));
        std::fs::write(file, with_constants(text)).expect("cargo made the folder");
    }
    let (threads, many) = (threads::THREADS, threads::MANY);
    let sizes = format!("const THREADS = {threads}u;\nconst MANY = {many}u;\n");
    let kit = format!("{KIT}\n// Threads of a workgroup: threads.rs.\n{sizes}");
    std::fs::write(package.join("kit.wesl"), kit).expect("cargo made the folder");
    for (name, text) in SOLIDS {
        let text = with_constants(text);
        std::fs::write(package.join(format!("{name}.wesl")), text).expect("cargo made the folder");
    }
    package
}

/// True for a module with a kernel or a drawing; other modules are imported by such.
fn has_entry(text: &str) -> bool {
    ENTRIES.iter().any(|entry| text.lines().any(|line| line.starts_with(entry)))
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
