//! The plan of the house: arrows between crates point down, no circle among the files of a crate nor among its
//! folders, and nothing longer than a person sees at once.
//!
//! Older exceptions are listed in checks/house.toml with their sizes: none may grow, and a mended one leaves
//! the list.

mod imports;
mod sizes;
mod text;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::cargo::root;

const LONGEST_RUST: usize = 400;
const LONGEST_SHADER: usize = 200;
const LONGEST_FUNCTION: usize = 60;

/// Each crate and those of ours that it may use.
const ARROWS: [(&str, &[&str]); 11] = [
    ("crates/base", &[]),
    ("crates/body", &["strandline-base"]),
    ("crates/gpu", &["strandline-base"]),
    ("crates/groom", &["strandline-base", "strandline-body"]),
    ("crates/sim", &["strandline-base", "strandline-body", "strandline-gpu", "strandline-groom"]),
    ("crates/render", &["strandline-base", "strandline-body", "strandline-gpu", "strandline-groom"]),
    (
        "crates/strandline",
        &[
            "strandline-base",
            "strandline-body",
            "strandline-gpu",
            "strandline-groom",
            "strandline-render",
            "strandline-sim",
        ],
    ),
    ("apps/viewer", &["strandline"]),
    ("apps/cli", &["strandline", "strandline-viewer"]),
    ("apps/web", &["strandline"]),
    ("python", &["strandline", "strandline-cli"]),
];

/// Folders of which the first imports nothing from the second.
const APART: [(&str, &str, &str); 2] =
    [("crates/render/src", "gpu", "cpu"), ("crates/sim/src", "gpu", "cpu")];

/// Folders of backends, from which only the root of the crate imports, to give names on. A simulator of `sim` joins its
/// backends itself.
const BACKENDS: [(&str, &[&str]); 1] = [("crates/render/src", &["cpu", "gpu"])];

/// Programs that name nothing of the facade but its own modules: what they need, every program may.
const PROGRAMS: [&str; 4] = ["apps/cli/src", "apps/viewer/src", "apps/web/src", "examples"];

/// Exceptions of the list: lines by file, lines by function, circles of files and circles of folders.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Known {
    files: BTreeMap<String, usize>,
    functions: BTreeMap<String, usize>,
    circles: Vec<BTreeSet<String>>,
    folders: Vec<BTreeSet<String>>,
}

/// Exceptions found in the tree.
#[derive(Debug, Default)]
struct Exceptions {
    arrows: Vec<String>,
    files: BTreeMap<String, usize>,
    functions: BTreeMap<String, usize>,
    circles: Vec<BTreeSet<String>>,
    folders: Vec<BTreeSet<String>>,
}

/// Prints where the plan of the house is not kept. True when it is.
pub fn check() -> bool {
    match problems(root()) {
        Ok(problems) if problems.is_empty() => {
            println!(
                "house: arrows, circles and sizes are as planned, or no worse than checks/house.toml has them"
            );
            true
        }
        Ok(problems) => {
            problems.iter().for_each(|problem| eprintln!("house: {problem}"));
            false
        }
        Err(error) => {
            eprintln!("house: {error:#}");
            false
        }
    }
}

fn problems(root: &Path) -> Result<Vec<String>> {
    let list = root.join("checks/house.toml");
    let text = std::fs::read_to_string(&list).with_context(|| list.display().to_string())?;
    let known: Known = toml::from_str(&text).with_context(|| list.display().to_string())?;
    Ok(compare(&look(root)?, &known))
}

/// Folders of code.
const PLACES: [&str; 7] = ["apps", "checks", "crates", "examples", "fuzz", "python", "xtask"];

fn look(root: &Path) -> Result<Exceptions> {
    let mut found = Exceptions::default();
    for (folder, allowed) in ARROWS {
        let manifest = std::fs::read_to_string(root.join(folder).join("Cargo.toml"))?;
        found.arrows.extend(wrong_arrows(folder, &manifest, allowed)?);
    }
    for place in PLACES {
        found.look_below(root, place)?;
    }
    Ok(found)
}

impl Exceptions {
    /// Looks at a folder: as one program or library where it has its root, else at each file and folder in it.
    fn look_below(&mut self, root: &Path, folder: &str) -> Result<()> {
        let here = root.join(folder);
        if ["lib.rs", "main.rs"].iter().any(|file| here.join(file).is_file()) {
            let mut files = Vec::new();
            read(&here, "", &mut files)?;
            self.measure(folder, &files);
            self.find_circles(folder, files);
            return Ok(());
        }
        for (name, entry) in entries(&here)? {
            if !entry.file_type()?.is_dir() {
                self.measure(folder, read_code(&entry.path(), &name)?.as_slice());
            } else if name != "target" {
                self.look_below(root, &format!("{folder}/{name}"))?;
            }
        }
        Ok(())
    }

    fn measure(&mut self, folder: &str, files: &[(String, String)]) {
        for (file, code) in files {
            let name = format!("{folder}/{file}");
            let most = if file.ends_with(".rs") { LONGEST_RUST } else { LONGEST_SHADER };
            let lines = code.lines().count();
            if lines > most {
                self.files.insert(name.clone(), lines);
            }
            let code = text::blanked(code);
            for (function, lines) in sizes::long_functions(&code, LONGEST_FUNCTION) {
                self.functions.insert(format!("{name} {function}"), lines);
            }
            if PROGRAMS.contains(&folder) && tunnels(&code) {
                self.arrows
                    .push(format!("{name} needs `low_level`, expected the facade's own modules alone"));
            }
        }
    }

    fn find_circles(&mut self, folder: &str, mut files: Vec<(String, String)>) {
        files.retain(|(file, _)| file.ends_with(".rs"));
        let modules = imports::Modules::read(&files);
        let named = |circle: Vec<String>| circle.iter().map(|name| format!("{folder}/{name}")).collect();
        self.circles.extend(imports::circles(&modules.imports()).into_iter().map(named));
        self.folders.extend(modules.folder_circles().into_iter().map(named));
        for (_, one, other) in APART.iter().filter(|(place, ..)| *place == folder) {
            let wrong = modules.between(one, other);
            self.arrows.extend(wrong.iter().map(|file| format!("{folder}/{file} imports from {other}/")));
        }
        for (_, backends) in BACKENDS.iter().filter(|(place, _)| *place == folder) {
            let wrong = modules.outside_of(backends).into_iter();
            self.arrows.extend(wrong.map(|(file, other)| format!("{folder}/{file} imports from {other}/")));
        }
    }
}

/// True for blanked code that names `low_level` of the facade.
fn tunnels(code: &str) -> bool {
    code.match_indices("low_level").any(|(at, _)| !code[..at].ends_with("signal_hook::"))
}

/// Entries of a folder, by name.
fn entries(folder: &Path) -> Result<Vec<(String, std::fs::DirEntry)>> {
    let entries = std::fs::read_dir(folder)?.collect::<std::io::Result<Vec<_>>>()?;
    let mut named: Vec<_> =
        entries.into_iter().map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry)).collect();
    named.sort_by(|one, other| one.0.cmp(&other.0));
    Ok(named)
}

/// Rust and shader files below a folder, with their names from there.
fn read(folder: &Path, name: &str, files: &mut Vec<(String, String)>) -> Result<()> {
    for (own, entry) in entries(folder)? {
        let below = format!("{name}{own}");
        if entry.file_type()?.is_dir() {
            read(&entry.path(), &format!("{below}/"), files)?;
        } else {
            files.extend(read_code(&entry.path(), &below)?);
        }
    }
    Ok(())
}

/// A file under a name, where it is Rust or a shader.
fn read_code(path: &Path, name: &str) -> Result<Option<(String, String)>> {
    let is_code = name.ends_with(".rs") || name.ends_with(".wesl");
    Ok(if is_code { Some((name.to_owned(), std::fs::read_to_string(path)?)) } else { None })
}

/// Dependencies on crates of ours that lie beside or above.
fn wrong_arrows(folder: &str, manifest: &str, allowed: &[&str]) -> Result<Vec<String>> {
    let manifest: toml::Table = manifest.parse()?;
    let used =
        manifest.get("dependencies").and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::keys);
    let ours = used.filter(|name| name.starts_with("strandline") && !allowed.contains(&name.as_str()));
    Ok(ours.map(|name| format!("{folder} uses {name}, which does not lie below it")).collect())
}

fn compare(found: &Exceptions, known: &Known) -> Vec<String> {
    let mut problems = found.arrows.clone();
    for (what, found, known, most) in [
        ("lines", &found.files, &known.files, "400, a shader 200"),
        ("lines of a function", &found.functions, &known.functions, "60"),
    ] {
        for (name, lines) in found {
            match known.get(name) {
                None => problems.push(format!("{name}: {lines} {what}, expected {most} at most")),
                Some(most) if lines > most => {
                    problems.push(format!("{name}: {lines} {what}, {most} when it was listed"));
                }
                Some(_) => {}
            }
        }
        let mended = known.keys().filter(|name| !found.contains_key(*name));
        problems.extend(mended.map(|name| format!("{name} is as planned: take it out of checks/house.toml")));
    }
    for (what, found, known) in
        [("files", &found.circles, &known.circles), ("folders", &found.folders, &known.folders)]
    {
        for circle in found {
            if !known.iter().any(|known| circle.is_subset(known)) {
                let members: Vec<&str> = circle.iter().map(String::as_str).collect();
                problems.push(format!("{what} import each other: {}", members.join(", ")));
            }
        }
        for circle in known {
            if !found.iter().any(|found| found.is_subset(circle)) {
                problems.push(format!("{circle:?} is no circle any more: take it out of checks/house.toml"));
            }
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_point_down() {
        let manifest = "[dependencies]\nglam = \"1\"\nstrandline-sim.workspace = true\n";
        assert_eq!(wrong_arrows("a", manifest, &["strandline-base"]).unwrap().len(), 1);
        assert!(wrong_arrows("a", manifest, &["strandline-sim"]).unwrap().is_empty());
    }

    #[test]
    fn files_beside_the_backends_of_render_import_none_of_them() {
        let planted = [
            ("lib.rs", "mod cpu;\nmod gpu;\nmod growth;\nmod look;\nmod room;\npub use cpu::step::Step;"),
            ("cpu/mod.rs", "pub mod step;"),
            ("cpu/step.rs", "use crate::look::Look;\npub struct Step;"),
            ("gpu/mod.rs", "use crate::look::Look;\npub struct Kernel;"),
            ("growth.rs", "use crate::cpu::step::Step;"),
            ("look.rs", "pub struct Look;\n#[cfg(test)]\nmod tests {\n    use crate::cpu::step::Step;\n}"),
            ("room/mod.rs", "mod given_on;\nfn f() { crate::gpu::Kernel }"),
            ("room/given_on.rs", "use crate::Step;"),
        ];
        let wrong = |folder: &str| {
            let mut found = Exceptions::default();
            let files = planted.map(|(file, code)| (file.to_owned(), code.to_owned()));
            found.find_circles(folder, files.to_vec());
            found.arrows
        };
        let expected = [
            "growth.rs imports from cpu/",
            "room/given_on.rs imports from cpu/",
            "room/mod.rs imports from gpu/",
        ];
        assert_eq!(
            wrong("crates/render/src"),
            expected.map(|problem| format!("crates/render/src/{problem}"))
        );
        // A simulator joins its backends itself.
        assert!(wrong("crates/sim/src").is_empty());
    }

    #[test]
    fn programs_name_nothing_beneath_the_facade() {
        assert!(tunnels("use strandline::low_level::sim::Drive;"));
        assert!(tunnels("use strandline::{Scene, low_level::sim};"));
        assert!(!tunnels("signal_hook::low_level::exit(1)"));
        let mut found = Exceptions::default();
        let file = ("bench/forms.rs".to_owned(), "use strandline::low_level::sim;".to_owned());
        found.measure("apps/cli/src", std::slice::from_ref(&file));
        assert!(found.arrows.len() == 1 && found.arrows[0].starts_with("apps/cli/src/bench/forms.rs"));
        found.measure("checks/laws", &[file]);
        assert_eq!(found.arrows.len(), 1);
    }

    #[test]
    fn what_is_listed_may_stay_but_not_grow_and_leaves_the_list_when_mended() {
        let circle = BTreeSet::from(["a.rs".to_owned(), "b.rs".to_owned()]);
        let found = Exceptions {
            files: [("a.rs".into(), 500)].into(),
            circles: vec![circle.clone()],
            ..Exceptions::default()
        };
        assert_eq!(compare(&found, &Known::default()).len(), 2);
        let known = |lines| Known {
            files: [("a.rs".into(), lines)].into(),
            circles: vec![circle.clone()],
            ..Known::default()
        };
        assert!(compare(&found, &known(500)).is_empty());
        assert_eq!(compare(&found, &known(499)).len(), 1);
        assert_eq!(compare(&Exceptions::default(), &known(500)).len(), 2);
        // Circles of folders are a list of their own.
        let found = Exceptions { folders: vec![circle.clone()], ..Exceptions::default() };
        assert_eq!(compare(&found, &Known { circles: vec![circle.clone()], ..Known::default() }).len(), 2);
        assert!(compare(&found, &Known { folders: vec![circle], ..Known::default() }).is_empty());
    }
}
