//! Imports between the files of a crate, and the circles among files and among folders.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::text::{blanked, without_tests};

/// Imports by the names of both ends.
pub type Graph = BTreeMap<String, BTreeSet<String>>;

/// Adds an import to a graph.
fn add(graph: &mut Graph, from: String, to: String) {
    graph.entry(to.clone()).or_default();
    graph.entry(from).or_default().insert(to);
}

/// The files of a crate as modules.
#[derive(Default)]
pub struct Modules {
    files: BTreeMap<Vec<String>, Module>,
}

struct Module {
    file: String,
    code: String,
    /// Names that it re-exports, with the paths they stand for.
    given_on: BTreeMap<String, Vec<String>>,
}

impl Modules {
    /// Reads the files of a crate; names are below its `src`.
    pub fn read(files: &[(String, String)]) -> Self {
        let mut modules = Self::default();
        let mut tests = BTreeSet::new();
        for (file, text) in files {
            let path = module_path(file);
            let (code, of_tests) = without_tests(&blanked(text));
            tests.extend(of_tests.into_iter().map(|name| [path.clone(), vec![name]].concat()));
            modules.files.insert(path, Module { file: file.clone(), code, given_on: BTreeMap::new() });
        }
        modules.files.retain(|path, _| !tests.iter().any(|test| path.starts_with(test)));
        let given_on: Vec<_> = modules
            .files
            .iter()
            .map(|(path, module)| (path.clone(), modules.given_on(path, &module.code)))
            .collect();
        for (path, given_on) in given_on {
            if let Some(module) = modules.files.get_mut(&path) {
                module.given_on = given_on;
            }
        }
        modules
    }

    /// The files that each file imports.
    pub fn imports(&self) -> Graph {
        let mut imports = Graph::new();
        for (path, target) in self.edges() {
            let file = |path: &[String]| self.files[path].file.clone();
            add(&mut imports, file(path), file(target));
        }
        imports
    }

    /// The circles among folders, each as its members without endings. On every level the members of a folder are its
    /// files and folders, each with all that lies below it; one imports another where any of its files does. The file
    /// of a folder (`mod.rs`, or the one of its name beside it) is part of that folder, so that a parent may import its
    /// children and they may import it. Circles of files alone are left to [`Modules::imports`].
    pub fn folder_circles(&self) -> Vec<Vec<String>> {
        let mut levels: BTreeMap<&[String], Graph> = BTreeMap::new();
        for (path, target) in self.edges() {
            let shared = path.iter().zip(target).take_while(|(one, other)| one == other).count();
            if path.len() > shared && target.len() > shared {
                let member = |path: &[String]| path[..=shared].join("/");
                add(levels.entry(&path[..shared]).or_default(), member(path), member(target));
            }
        }
        let is_folder = |member: &String| {
            let below = format!("{member}/");
            self.files.keys().any(|path| path.join("/").starts_with(&below))
        };
        levels.values().flat_map(circles).filter(|circle| circle.iter().any(is_folder)).collect()
    }

    /// The files of a folder of the crate that import from another, by name.
    pub fn between(&self, folder: &str, other: &str) -> BTreeSet<&str> {
        let lies_in = |path: &[String], folder: &str| path.first().is_some_and(|first| first == folder);
        let wrong = self.edges().filter(|(path, target)| lies_in(path, folder) && lies_in(target, other));
        wrong.map(|(path, _)| self.files[path].file.as_str()).collect()
    }

    /// The files outside some folders that import from one of them, by name, each with that folder. Names that the root
    /// of the crate gives on count as the folder's.
    pub fn outside_of(&self, folders: &[&str]) -> BTreeSet<(&str, String)> {
        let is_in =
            |path: &[String]| folders.iter().any(|folder| path.first().is_some_and(|first| first == folder));
        let wrong = self.edges().filter(|(path, target)| !path.is_empty() && !is_in(path) && is_in(target));
        wrong.map(|(path, target)| (self.files[path].file.as_str(), target[0].clone())).collect()
    }

    /// Each import of a module from another, as their paths.
    fn edges(&self) -> impl Iterator<Item = (&[String], &[String])> {
        self.files.iter().flat_map(move |(path, module)| {
            let targets = self.named(path, &module.code);
            let owners = targets.into_iter().filter_map(|target| self.owner(&target, 0));
            owners.filter(move |other| *other != path.as_slice()).map(move |other| (path.as_slice(), other))
        })
    }

    /// The module that a path of the crate leads to, through names that are given on.
    fn owner(&self, path: &[String], depth: usize) -> Option<&[String]> {
        let known = (0..=path.len()).rev().find(|length| self.files.contains_key(&path[..*length]))?;
        let (owner, module) = self.files.get_key_value(&path[..known])?;
        let Some(name) = path.get(known) else { return Some(owner) };
        match module.given_on.get(name) {
            Some(further) if depth < 8 => {
                let further = [further.clone(), path[known + 1..].to_vec()].concat();
                self.owner(&further, depth + 1)
            }
            _ => Some(owner),
        }
    }

    /// Names of a module's `pub use`, with the paths they stand for.
    fn given_on(&self, path: &[String], code: &str) -> BTreeMap<String, Vec<String>> {
        let mut found = BTreeMap::new();
        for (is_public, tree) in uses(code) {
            for (name, target) in leaves(tree) {
                if let Some(target) = self.absolute(path, &target).filter(|_| is_public) {
                    found.insert(name, target);
                }
            }
        }
        found
    }

    /// The paths of the crate that a module names: in its private `use`s and in its code.
    fn named(&self, path: &[String], code: &str) -> Vec<Vec<String>> {
        let mut found = Vec::new();
        let mut rest = code.to_owned();
        for (is_public, tree) in uses(code) {
            rest = rest.replacen(tree, "", 1);
            if !is_public {
                found.extend(leaves(tree).into_iter().map(|(_, target)| target));
            }
        }
        found.extend(paths(&rest));
        found.iter().filter_map(|target| self.absolute(path, target)).collect()
    }

    /// A path from the crate's root; `None` if it leads out of the crate.
    fn absolute(&self, here: &[String], target: &[String]) -> Option<Vec<String>> {
        let first = target.first()?;
        let mut base = here.to_vec();
        let mut left = target;
        match first.as_str() {
            "crate" => (base, left) = (Vec::new(), &target[1..]),
            "self" => left = &target[1..],
            "super" => {
                while left.first().is_some_and(|word| word == "super") {
                    base.pop()?;
                    left = &left[1..];
                }
            }
            name => {
                let child = [here.to_vec(), vec![name.to_owned()]].concat();
                self.files.contains_key(&child).then_some(())?;
            }
        }
        Some([base, left.to_vec()].concat())
    }
}

/// `cpu/mod.rs` is `cpu`, `lib.rs` and `main.rs` the root.
fn module_path(file: &str) -> Vec<String> {
    let stem = Path::new(file).with_extension("");
    let mut path: Vec<String> = stem.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if path.last().is_some_and(|last| last == "mod")
        || (path.len() == 1 && ["lib", "main"].contains(&path[0].as_str()))
    {
        path.pop();
    }
    path
}

/// The `use`s of a text: whether each is public, and its tree.
fn uses(code: &str) -> Vec<(bool, &str)> {
    let mut found = Vec::new();
    let mut begin = 0;
    while let Some(at) = code[begin..].find("use ").map(|at| begin + at) {
        begin = at + 4;
        let line = code[..at].rfind('\n').map_or(0, |at| at + 1);
        let before = code[line..at].trim();
        let Some(end) = code[begin..].find(';') else { break };
        if before.is_empty() || before.starts_with("pub") {
            found.push((before.starts_with("pub"), &code[begin..begin + end]));
        }
    }
    found
}

/// The paths of a tree with the names that they get.
fn leaves(tree: &str) -> Vec<(String, Vec<String>)> {
    let tree = tree.trim();
    if let Some(open) = tree.find('{') {
        let stem: Vec<String> = words(&tree[..open]);
        let inner = tree[open + 1..].trim_end().trim_end_matches('}');
        let branches = split_branches(inner).into_iter().flat_map(leaves);
        return branches
            .map(|(name, path)| {
                let own = path == ["self"];
                let name = if own { stem.last().cloned().unwrap_or_default() } else { name };
                (name, if own { stem.clone() } else { [stem.clone(), path].concat() })
            })
            .collect();
    }
    let (path, name) = tree.split_once(" as ").unwrap_or((tree, ""));
    let path = words(path);
    let name =
        if name.is_empty() { path.last().cloned().unwrap_or_default() } else { name.trim().to_owned() };
    if path.is_empty() { Vec::new() } else { vec![(name, path)] }
}

fn words(path: &str) -> Vec<String> {
    path.split("::").map(str::trim).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// Parts between the commas that lie in no braces.
fn split_branches(text: &str) -> Vec<&str> {
    let (mut depth, mut begin, mut found) = (0, 0, Vec::new());
    for (at, letter) in text.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(&text[begin..at]);
                begin = at + 1;
            }
            _ => {}
        }
    }
    found.push(&text[begin..]);
    found
}

/// Paths of two words or more in code.
fn paths(code: &str) -> Vec<Vec<String>> {
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut found = Vec::new();
    for run in code.split(|letter: char| !is_word(letter) && letter != ':') {
        let path = words(run);
        if run.contains("::") && path.len() > 1 && !run.starts_with(':') {
            found.push(path);
        }
    }
    found
}

/// The circles of a graph: members that all reach each other, sorted.
pub fn circles(imports: &Graph) -> Vec<Vec<String>> {
    let reach: BTreeMap<&String, BTreeSet<&String>> =
        imports.keys().map(|file| (file, reached(imports, file))).collect();
    let mut circles = BTreeSet::new();
    for (file, others) in &reach {
        let circle: Vec<String> = others
            .iter()
            .filter(|other| reach[**other].contains(file))
            .map(|other| (*other).clone())
            .collect();
        if circle.len() > 1 {
            circles.insert(circle);
        }
    }
    circles.into_iter().collect()
}

fn reached<'a>(imports: &'a Graph, file: &String) -> BTreeSet<&'a String> {
    let mut found = BTreeSet::new();
    let mut waiting: Vec<&String> = imports.get(file).into_iter().flatten().collect();
    while let Some(next) = waiting.pop() {
        if found.insert(next) {
            waiting.extend(imports.get(next).into_iter().flatten());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modules(files: &[(&str, &str)]) -> Modules {
        let files: Vec<_> =
            files.iter().map(|(file, code)| ((*file).to_owned(), (*code).to_owned())).collect();
        Modules::read(&files)
    }

    fn found(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        circles(&modules(files).imports())
    }

    #[test]
    fn files_that_import_each_other_are_a_circle() {
        let circle = found(&[
            ("lib.rs", "mod a;\nmod b;\npub use a::One;\n"),
            ("a.rs", "use crate::b::{Two, Three};\npub struct One;"),
            ("b.rs", "use super::One;\npub struct Two;"),
        ]);
        assert_eq!(circle, [["a.rs", "b.rs"]]);
    }

    #[test]
    fn giving_names_on_is_no_import_but_calling_is() {
        let lib = "mod a;\npub use a::One;\npub struct Two;\n";
        let a = ("a.rs", "use crate::Two;\npub struct One;");
        assert!(found(&[("lib.rs", lib), a]).is_empty());
        let calling = format!("{lib}fn f() {{ a::g(); }}");
        assert_eq!(found(&[("lib.rs", &calling), a]), [["a.rs", "lib.rs"]]);
    }

    #[test]
    fn tests_and_comments_import_nothing() {
        let a = "mod c { }\n// use crate::b::X;\n#[cfg(test)]\nmod tests { use crate::b::X; }";
        assert!(found(&[("lib.rs", "mod a; mod b;"), ("a.rs", a), ("b.rs", "use crate::a::Y;")]).is_empty());
        let a = "use crate::{\n    b::{self, X as Y},\n};";
        let circle = found(&[("lib.rs", ""), ("a.rs", a), ("b.rs", "fn f() { crate::a::g() }")]);
        assert_eq!(circle, [["a.rs", "b.rs"]]);
    }

    #[test]
    fn folders_that_import_each_other_are_a_circle_though_no_files_are() {
        let planted = [
            ("lib.rs", "mod a;\nmod b;\npub use a::one::One;\n"),
            ("a/mod.rs", "pub mod one;\npub mod two;"),
            ("a/one.rs", "pub struct One;"),
            ("a/two.rs", "use crate::b::three::Three;"),
            ("b/mod.rs", "pub mod three;"),
            ("b/three.rs", "use crate::One;\npub struct Three;"),
        ];
        assert!(found(&planted).is_empty());
        assert_eq!(modules(&planted).folder_circles(), [["a", "b"]]);
    }

    #[test]
    fn a_file_beside_a_folder_makes_a_circle_with_it() {
        let planted = [
            ("lib.rs", "mod a;\nmod lights;"),
            ("lights.rs", "use crate::a::one::One;\npub struct Light;"),
            ("a/mod.rs", "pub mod one;\npub mod two;"),
            ("a/one.rs", "pub struct One;"),
            ("a/two.rs", "fn f() { crate::lights::Light }"),
        ];
        assert_eq!(modules(&planted).folder_circles(), [["a", "lights"]]);
        // Below the root too.
        let below: Vec<_> = planted[1..]
            .iter()
            .map(|(file, code)| (format!("x/{file}"), code.replace("crate::", "crate::x::")))
            .collect();
        let mut below: Vec<_> = below.iter().map(|(file, code)| (file.as_str(), code.as_str())).collect();
        below.extend([("lib.rs", "mod x;"), ("x/mod.rs", "mod a;\nmod lights;")]);
        assert_eq!(modules(&below).folder_circles(), [["x/a", "x/lights"]]);
    }

    #[test]
    fn a_folder_and_its_own_file_are_one() {
        let child = "use super::Size;\npub fn f() {}";
        let parent = "mod part;\npub struct Size;\nfn g() { part::f() }";
        for own in ["a/mod.rs", "a.rs"] {
            let planted = [("lib.rs", "mod a;\nfn h() { a::g() }"), (own, parent), ("a/part.rs", child)];
            assert!(modules(&planted).folder_circles().is_empty());
        }
    }

    #[test]
    fn imports_from_one_folder_to_another_are_found_through_names_that_are_given_on() {
        let planted = [
            ("lib.rs", "mod cpu;\nmod gpu;\npub use cpu::step::Step;"),
            ("cpu/mod.rs", "pub mod step;"),
            ("cpu/step.rs", "pub struct Step;"),
            ("gpu/mod.rs", "mod wrong;\nmod right;"),
            ("gpu/wrong.rs", "use crate::Step;"),
            ("gpu/right.rs", "use super::Kernel;"),
        ];
        assert_eq!(modules(&planted).between("gpu", "cpu"), BTreeSet::from(["gpu/wrong.rs"]));
        assert!(modules(&planted).between("cpu", "gpu").is_empty());
    }
}
