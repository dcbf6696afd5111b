//! Allowed licences of dependencies, and the page that lists them.
//!
//! docs/licences.md is written from what cargo says of every package, those of the Python package too; that it names the
//! packages of both Cargo.lock and no others is checked with every test, without cargo and without a network.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt::Write;
use std::path::Path;
use std::process::Stdio;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use crate::cargo::{cargo_command, root};

/// The packages that are distributed: the program contains their dependencies.
const PROGRAM: &str = "strandline-cli";
/// Manifests of the workspaces whose packages the page lists, and their locks.
const MANIFESTS: [&str; 2] = ["Cargo.toml", "python/Cargo.toml"];
const LOCKS: [&str; 2] = ["Cargo.lock", "python/Cargo.lock"];
/// Names of files with a licence, or with a notice that it requires.
const TEXTS: [&str; 5] = ["license", "licence", "copying", "notice", "copyright"];

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    resolve: Resolve,
}

#[derive(Deserialize)]
struct Package {
    id: String,
    name: String,
    version: String,
    license: Option<String>,
    /// `None` for our own.
    source: Option<String>,
    manifest_path: String,
}

#[derive(Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

#[derive(Deserialize)]
struct Node {
    id: String,
    deps: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    pkg: String,
    dep_kinds: Vec<DependencyKind>,
}

#[derive(Deserialize)]
struct DependencyKind {
    kind: Option<String>,
}

#[derive(Deserialize)]
struct Lock {
    package: Vec<Locked>,
}

#[derive(Deserialize)]
struct Locked {
    name: String,
    version: String,
    source: Option<String>,
}

fn page() -> std::path::PathBuf {
    root().join("docs/licences.md")
}

/// Runs cargo-deny: licences, sources, duplicates, and known faults where their list can be had.
pub fn deny() -> bool {
    match deny_if_installed() {
        Some(held) => {
            // The list of known faults is online: a missing connection is no failure.
            println!("\n== cargo deny check advisories");
            if !cargo(&["deny", "check", "advisories"]) {
                println!("advisories: see above; without a network their list cannot be had");
            }
            held
        }
        None => {
            println!("{NOT_INSTALLED}");
            false
        }
    }
}

/// Note for a missing cargo-deny.
pub const NOT_INSTALLED: &str =
    "licences and sources of dependencies: cargo-deny is not installed (`cargo install --locked cargo-deny`)";

/// Licences, sources and duplicates by cargo-deny; `None` if it is not installed.
pub fn deny_if_installed() -> Option<bool> {
    let version = cargo_command(&["deny", "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    version.is_ok_and(|status| status.success()).then(|| {
        println!("\n== cargo deny check licenses bans sources");
        cargo(&["deny", "--log-level", "error", "check", "licenses", "bans", "sources"])
    })
}

fn cargo(arguments: &[&str]) -> bool {
    cargo_command(arguments).status().is_ok_and(|status| status.success())
}

/// Writes docs/licences.md; the texts too, into a file, when there is a name for it.
pub fn write(texts: Option<&str>) -> bool {
    match written(texts) {
        Ok(()) => true,
        Err(error) => {
            eprintln!("{error:#}");
            false
        }
    }
}

fn written(texts: Option<&str>) -> Result<()> {
    let [program, python] = MANIFESTS.map(metadata);
    let (program, python) = (program?, python?);
    let page_of_all = table(&program, &python);
    println!("docs/licences.md: {} packages", listed(&page_of_all).len());
    std::fs::write(page(), page_of_all).context("docs/licences.md")?;
    match texts {
        Some(path) => std::fs::write(path, all_texts(&program, &python)?).with_context(|| path.to_owned()),
        None => Ok(()),
    }
}

/// The packages of the locks and those of the page.
fn both() -> Result<(BTreeSet<String>, BTreeSet<String>)> {
    let mut all = BTreeSet::new();
    for lock in LOCKS {
        all.append(&mut locked(&std::fs::read_to_string(root().join(lock)).context(lock)?)?);
    }
    Ok((all, listed(&std::fs::read_to_string(page()).context("docs/licences.md")?)))
}

/// Checks that the page names the packages of the locks.
pub fn check() -> bool {
    match both() {
        Ok((locked, listed)) if locked == listed => true,
        Ok((locked, listed)) => {
            for name in locked.symmetric_difference(&listed) {
                println!("docs/licences.md and {} differ in {name}", LOCKS.join(", "));
            }
            println!("`cargo xtask licences` writes the page again");
            false
        }
        Err(error) => {
            println!("{error:#}");
            false
        }
    }
}

/// Others' packages in Cargo.lock, as `name version`.
fn locked(lock: &str) -> Result<BTreeSet<String>> {
    let lock: Lock = toml::from_str(lock).context("Cargo.lock")?;
    let others = lock.package.into_iter().filter(|package| package.source.is_some());
    Ok(others.map(|package| format!("{} {}", package.name, package.version)).collect())
}

/// The packages that the page names, the same way.
fn listed(page: &str) -> BTreeSet<String> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.strip_prefix("| ")?.split(" | ").collect();
        let [name, version, _licence] = cells[..] else { return None };
        Some(format!("{name} {version}"))
    };
    page.lines().filter(|line| !line.starts_with("| package ")).filter_map(row).collect()
}

fn metadata(manifest: &str) -> Result<Metadata> {
    let output =
        cargo_command(&["metadata", "--format-version", "1", "--locked", "--manifest-path", manifest])
            .stderr(Stdio::inherit())
            .output()
            .context("cargo metadata")?;
    if !output.status.success() {
        bail!("cargo metadata failed");
    }
    serde_json::from_slice(&output.stdout).context("what cargo metadata says")
}

/// The packages that are in the program, on any system.
fn in_program(metadata: &Metadata) -> HashSet<&str> {
    let nodes: HashMap<&str, &Node> =
        metadata.resolve.nodes.iter().map(|node| (node.id.as_str(), node)).collect();
    let first = metadata.packages.iter().find(|package| package.name == PROGRAM);
    let mut waiting: Vec<&str> = first.map(|package| package.id.as_str()).into_iter().collect();
    let mut found = HashSet::new();
    while let Some(id) = waiting.pop() {
        if !found.insert(id) {
            continue;
        }
        let deps = nodes.get(id).into_iter().flat_map(|node| &node.deps);
        let needed = deps.filter(|dep| dep.dep_kinds.iter().any(|kind| kind.kind.is_none()));
        waiting.extend(needed.map(|dep| dep.pkg.as_str()));
    }
    found
}

/// Others' packages of the Python package that the program's workspace has not.
fn python_alone<'a>(program: &Metadata, python: &'a Metadata) -> impl Iterator<Item = &'a Package> {
    let named = |package: &Package| format!("{} {}", package.name, package.version);
    let known: HashSet<String> = program.packages.iter().map(named).collect();
    let others = python.packages.iter().filter(|package| package.source.is_some());
    others.filter(move |package| !known.contains(&named(package)))
}

/// The page.
fn table(program: &Metadata, python: &Metadata) -> String {
    let in_program = in_program(program);
    let mut rows = [Vec::new(), Vec::new(), Vec::new()];
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let own = program.packages.iter().filter(|package| package.source.is_some());
    let placed = own.map(|package| (if in_program.contains(package.id.as_str()) { 0 } else { 2 }, package));
    for (place, package) in placed.chain(python_alone(program, python).map(|package| (1, package))) {
        let licence = package.license.as_deref().unwrap_or("in a file of its own");
        *counts.entry(licence).or_default() += 1;
        rows[place].push(format!("| {} | {} | {licence} |", package.name, package.version));
    }
    let mut page = "# Licences of others' code\n\nWritten by `cargo xtask licences` from what each package says \
                    of itself, for all systems; do not edit. `cargo xtask licences FILE` also collects the texts, \
                    which go with a program that is given away. deny.toml says which licences may be used.\n\n\
                    | packages | licence |\n|---|---|\n"
        .to_owned();
    for (licence, count) in &counts {
        writeln!(page, "| {count} | {licence} |").expect("into memory");
    }
    let titles = [
        "In the program, on some system",
        "In the extension of the Python package beside these, or for building it",
        "For building and tests alone",
    ];
    for (title, rows) in titles.iter().zip(&mut rows) {
        rows.sort();
        write!(page, "\n## {title}\n\n| package | version | licence |\n|---|---|---|\n{}\n", rows.join("\n"))
            .expect("into memory");
    }
    page
}

/// The texts that the packages in the program and in the Python package have, each text once.
fn all_texts(program: &Metadata, python: &Metadata) -> Result<String> {
    let in_program = in_program(program);
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let own = program.packages.iter().filter(|package| in_program.contains(package.id.as_str()));
    for package in own.chain(python_alone(program, python)) {
        let folder = Path::new(&package.manifest_path).parent().context("a manifest lies in a folder")?;
        for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().to_lowercase();
            if TEXTS.iter().any(|start| name.starts_with(start)) && entry.file_type()?.is_file() {
                let text = String::from_utf8_lossy(&std::fs::read(entry.path())?).trim().to_owned();
                texts.entry(text).or_default().push(format!("{} {}", package.name, package.version));
            }
        }
    }
    let mut all = String::new();
    for (text, mut names) in texts {
        names.sort();
        writeln!(all, "{}\n\n{text}\n\n{}\n", names.join(", "), "-".repeat(72))?;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOCK: &str = "[[package]]\nname = \"own\"\nversion = \"0.1.0\"\n\n[[package]]\nname = \"b\"\n\
                        version = \"2.0.0\"\nsource = \"registry\"\n";

    fn sample() -> Metadata {
        let package = |name: &str, source: Option<&str>| {
            format!(
                "{{\"id\":\"{name}\",\"name\":\"{name}\",\"version\":\"2.0.0\",\"license\":\"MIT\",\
                 \"source\":{},\"manifest_path\":\"/nowhere/Cargo.toml\"}}",
                source.map_or("null".to_owned(), |source| format!("\"{source}\""))
            )
        };
        let json = format!(
            "{{\"packages\":[{},{},{}],\"resolve\":{{\"nodes\":[{{\"id\":\"strandline-cli\",\"deps\":[\
             {{\"pkg\":\"b\",\"dep_kinds\":[{{\"kind\":null}}]}},{{\"pkg\":\"c\",\"dep_kinds\":[{{\"kind\":\"dev\"}}]}}]}}]}}}}",
            package("strandline-cli", None),
            package("b", Some("registry")),
            package("c", Some("registry"))
        );
        serde_json::from_str(&json).unwrap()
    }

    #[test]
    fn the_page_tells_what_is_in_the_program() {
        let mut python = sample();
        python.packages[1].name = "d".to_owned();
        let page = table(&sample(), &python);
        let (program, rest) = page.split_once("In the extension").unwrap();
        let (extension, tests) = rest.split_once("For building and tests").unwrap();
        assert!(program.contains("| b | 2.0.0 | MIT |") && tests.contains("| c | 2.0.0 | MIT |"));
        assert!(extension.contains("| d | 2.0.0 | MIT |") && !extension.contains("| c |"));
        assert!(!page.contains("strandline-cli"));
        assert_eq!(listed(&page), ["b 2.0.0", "c 2.0.0", "d 2.0.0"].map(str::to_owned).into());
    }

    #[test]
    fn a_package_that_is_missing_is_seen() {
        assert_eq!(locked(LOCK).unwrap(), ["b 2.0.0".to_owned()].into());
        assert_ne!(locked(LOCK).unwrap(), listed("| a | 1.0.0 | MIT |"));
    }
}
