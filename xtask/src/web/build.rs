//! The module, the script that starts it, and the files of the page.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::folders::{site, work};
use super::toolchain::{Compiler, TARGET};
use crate::cargo::{cargo_command, root};

/// Files of the page as they are in the tree.
const FILES: &str = "apps/web/site";

/// The script that keeps the page for visits without a network.
const OFFLINE: &str = "offline.js";

/// Cargo's profile of the module: small, and fast where it matters.
const PROFILE: &str = "web";

/// Memory that the module may have in all: 1 GiB.
const MOST_MEMORY: &str = "link-arg=--max-memory=1073741824";

/// Files of the module, as the binder writes them.
const MODULE: [&str; 2] = ["strandline_web.js", "strandline_web_bg.wasm"];

/// Builds the page into out/web.
pub fn page(compiler: &Compiler) -> Result<()> {
    let (module, site) = (module(compiler)?, site());
    bind(&module, &site)?;
    copy(&root().join(FILES), &site)?;
    keep_offline(&root().join(FILES), &site)?;
    let bytes = fs::metadata(site.join("strandline_web_bg.wasm"))?.len();
    println!("the page is in {}; its module has {:.2} MB", site.display(), bytes as f64 / 1e6);
    Ok(())
}

/// Compiles the module. A library of the workspace becomes one here alone, so that nothing else links it.
fn module(compiler: &Compiler) -> Result<PathBuf> {
    println!("\n== the module");
    let folder = work().join("build");
    let words =
        ["rustc", "--profile", PROFILE, "--lib", "--package", "strandline-web", "--crate-type", "cdylib"];
    let mut build = compiler.cargo(&words);
    build.args(["--target", TARGET, "--target-dir"]).arg(&folder).args(["--", "-C", MOST_MEMORY]);
    ensure!(build.status()?.success(), "the module does not compile");
    Ok(folder.join(TARGET).join(PROFILE).join("strandline_web.wasm"))
}

/// Writes module and script with the binder, a program of its own with a lock file of its own.
fn bind(module: &Path, site: &Path) -> Result<()> {
    println!("\n== the script of the module");
    let folder = work().join("binder");
    let manifest = root().join("apps/web/binder/Cargo.toml");
    let mut build = cargo_command(&["build", "--quiet", "--release", "--locked", "--manifest-path"]);
    build.arg(manifest).arg("--target-dir").arg(&folder);
    ensure!(build.status()?.success(), "the binder does not compile");
    fs::create_dir_all(site)?;
    let binder = folder.join("release/strandline-web-binder");
    let bound = Command::new(binder).arg(module).arg(site).status()?;
    ensure!(bound.success(), "the binder does not take {}", module.display());
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let entry = entry?;
        fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}

/// Writes into the script that keeps the page for visits without a network which files those are, and their version.
fn keep_offline(from: &Path, site: &Path) -> Result<()> {
    let mut names: Vec<String> = Vec::new();
    for entry in fs::read_dir(from)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.retain(|name| name != OFFLINE);
    names.extend(MODULE.map(str::to_owned));
    names.sort();
    let mut version = DefaultHasher::new();
    for name in &names {
        (name, fs::read(site.join(name))?).hash(&mut version);
    }
    // A folder shows its index.
    names.insert(0, "./".to_owned());
    let script = site.join(OFFLINE);
    let text = named(&fs::read_to_string(&script)?, version.finish(), &names)?;
    Ok(fs::write(script, text)?)
}

/// The script with version and files in place of the empty ones.
fn named(script: &str, version: u64, names: &[String]) -> Result<String> {
    let [version, names] =
        [serde_json::to_string(&format!("{version:016x}"))?, serde_json::to_string(names)?];
    let mut text = script.to_owned();
    for (empty, full) in
        [("VERSION = \"\"", format!("VERSION = {version}")), ("FILES = []", format!("FILES = {names}"))]
    {
        ensure!(text.matches(empty).count() == 1, "expected `{empty}` once in {OFFLINE}");
        text = text.replace(empty, &full);
    }
    Ok(text)
}

#[cfg(test)]
mod unit_tests {
    use super::*;

    #[test]
    fn a_page_for_visits_without_a_network_has_all_files_and_a_version_of_their_content() {
        let folder = tempfile::tempdir().unwrap();
        let [from, site] = ["from", "site"].map(|name| folder.path().join(name));
        [&from, &site].into_iter().for_each(|folder| fs::create_dir(folder).unwrap());
        let script = || fs::read_to_string(site.join(OFFLINE)).unwrap();
        let build = |page: &str| {
            fs::copy(root().join(FILES).join(OFFLINE), from.join(OFFLINE)).unwrap();
            fs::write(from.join("page.js"), page).unwrap();
            copy(&from, &site).unwrap();
            MODULE.into_iter().for_each(|name| fs::write(site.join(name), "module").unwrap());
            keep_offline(&from, &site).map(|()| script())
        };
        let first = build("one").unwrap();
        let files = r#"FILES = ["./","page.js","strandline_web.js","strandline_web_bg.wasm"]"#;
        assert!(first.contains(files), "{first}");
        assert_eq!(first, build("one").unwrap());
        assert_ne!(first, build("other").unwrap());
        assert!(named("const FILES = [];", 1, &[]).is_err());
    }

    /// Version of a package in a lock file.
    fn locked(lock: &str, name: &str) -> String {
        let lock: toml::Table = fs::read_to_string(root().join(lock)).unwrap().parse().unwrap();
        let packages = lock["package"].as_array().unwrap();
        let package = packages.iter().find(|package| package["name"].as_str() == Some(name)).unwrap();
        package["version"].as_str().unwrap().to_owned()
    }

    #[test]
    fn the_binder_is_of_the_version_that_the_module_is_built_with() {
        let module = locked("Cargo.lock", "wasm-bindgen");
        assert_eq!(locked("apps/web/binder/Cargo.lock", "wasm-bindgen-cli-support"), module);
    }
}
