//! Allowed licences of dependencies, and the page that lists them.
//!
//! docs/licences.md is written from what cargo says of every package. Each test run checks, without cargo and without a
//! network, that it names the packages of Cargo.lock and no others.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt::Write;
use std::path::Path;
use std::process::Stdio;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use crate::cargo::{cargo_command, root};

/// Packages that are distributed with their dependencies: the program, and the extension of the Python package.
const DISTRIBUTED: [&str; 2] = ["strandline-cli", "strandline-python"];
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
    let metadata = metadata()?;
    let page_of_all = table(&metadata);
    println!("docs/licences.md: {} packages", listed(&page_of_all).len());
    std::fs::write(page(), page_of_all).context("docs/licences.md")?;
    match texts {
        Some(path) => std::fs::write(path, all_texts(&metadata)?).with_context(|| path.to_owned()),
        None => Ok(()),
    }
}

/// The packages of the lock and those of the page.
fn both() -> Result<(BTreeSet<String>, BTreeSet<String>)> {
    let lock = std::fs::read_to_string(root().join("Cargo.lock")).context("Cargo.lock")?;
    Ok((locked(&lock)?, listed(&std::fs::read_to_string(page()).context("docs/licences.md")?)))
}

/// Checks that the page names the packages of the lock.
pub fn check() -> bool {
    match both() {
        Ok((locked, listed)) if locked == listed => true,
        Ok((locked, listed)) => {
            for name in locked.symmetric_difference(&listed) {
                println!("docs/licences.md and Cargo.lock differ in {name}");
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

fn metadata() -> Result<Metadata> {
    let output = cargo_command(&["metadata", "--format-version", "1", "--locked"])
        .stderr(Stdio::inherit())
        .output()
        .context("cargo metadata")?;
    if !output.status.success() {
        bail!("cargo metadata failed");
    }
    serde_json::from_slice(&output.stdout).context("what cargo metadata says")
}

/// The packages that a distributed package contains, on any system.
fn contained<'a>(metadata: &'a Metadata, name: &str) -> HashSet<&'a str> {
    let nodes: HashMap<&str, &Node> =
        metadata.resolve.nodes.iter().map(|node| (node.id.as_str(), node)).collect();
    let first = metadata.packages.iter().find(|package| package.name == name);
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

/// Packages of others.
fn others(metadata: &Metadata) -> impl Iterator<Item = &Package> {
    metadata.packages.iter().filter(|package| package.source.is_some())
}

/// The page.
fn table(metadata: &Metadata) -> String {
    let sets = DISTRIBUTED.map(|name| contained(metadata, name));
    let mut rows = [Vec::new(), Vec::new(), Vec::new()];
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for package in others(metadata) {
        let place = sets.iter().position(|set| set.contains(package.id.as_str())).unwrap_or(sets.len());
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
        "In the extension of the Python package beside these",
        "For building and tests alone",
    ];
    for (title, rows) in titles.iter().zip(&mut rows) {
        rows.sort();
        write!(page, "\n## {title}\n\n| package | version | licence |\n|---|---|---|\n{}\n", rows.join("\n"))
            .expect("into memory");
    }
    page
}

/// The texts of the packages in the program and in the extension of the Python package, each text once.
fn all_texts(metadata: &Metadata) -> Result<String> {
    let sets = DISTRIBUTED.map(|name| contained(metadata, name));
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let is_distributed = |package: &&Package| sets.iter().any(|set| set.contains(package.id.as_str()));
    for package in others(metadata).filter(is_distributed) {
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

    /// The program needs b, and c for tests; the extension needs the program and d, and e to be built.
    fn sample() -> Metadata {
        let package = |name: &str| {
            let source = if name.len() == 1 { "\"registry\"" } else { "null" };
            format!(
                "{{\"id\":\"{name}\",\"name\":\"{name}\",\"version\":\"2.0.0\",\"license\":\"MIT\",\
                 \"source\":{source},\"manifest_path\":\"/nowhere/Cargo.toml\"}}"
            )
        };
        let dep =
            |name: &str, kind: &str| format!("{{\"pkg\":\"{name}\",\"dep_kinds\":[{{\"kind\":{kind}}}]}}");
        let node =
            |name: &str, deps: [String; 2]| format!("{{\"id\":\"{name}\",\"deps\":[{}]}}", deps.join(","));
        let program = node(DISTRIBUTED[0], [dep("b", "null"), dep("c", "\"dev\"")]);
        let build = node("d", [dep("e", "\"build\""), dep("b", "null")]);
        let extension = node(DISTRIBUTED[1], [dep(DISTRIBUTED[0], "null"), dep("d", "null")]);
        let packages = ["b", "c", "d", "e", DISTRIBUTED[0], DISTRIBUTED[1]].map(package).join(",");
        let nodes = [program, extension, build].join(",");
        let json = format!("{{\"packages\":[{packages}],\"resolve\":{{\"nodes\":[{nodes}]}}}}");
        serde_json::from_str(&json).unwrap()
    }

    #[test]
    fn the_page_tells_what_is_distributed() {
        let page = table(&sample());
        let (program, rest) = page.split_once("## In the extension").unwrap();
        let (extension, tests) = rest.split_once("## For building and tests").unwrap();
        let names = |part: &str| listed(part).into_iter().map(|row| row[..1].to_owned()).collect::<String>();
        assert_eq!([program, extension, tests].map(names), ["b", "d", "ce"]);
        assert!(DISTRIBUTED.iter().all(|own| !page.contains(own)));
    }

    #[test]
    fn a_package_that_is_missing_is_seen() {
        assert_eq!(locked(LOCK).unwrap(), ["b 2.0.0".to_owned()].into());
        assert_ne!(locked(LOCK).unwrap(), listed("| a | 1.0.0 | MIT |"));
    }
}
