//! The module, the script that starts it, and the files of the page.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::folders::{site, work};
use super::toolchain::{Compiler, TARGET};
use crate::cargo::{cargo_command, root};

/// Files of the page as they are in the tree.
const FILES: &str = "apps/web/site";

/// Builds the page into out/web.
pub fn page(compiler: &Compiler) -> Result<()> {
    let (module, site) = (module(compiler)?, site());
    bind(&module, &site)?;
    copy(&root().join(FILES), &site)?;
    let bytes = fs::metadata(site.join("strandline_web_bg.wasm"))?.len();
    println!("the page is in {}; its module has {:.2} MB", site.display(), bytes as f64 / 1e6);
    Ok(())
}

/// Checks that all crates compile for browsers with GPUs too, which the page does not ask for yet.
pub fn compiles_with_gpus(compiler: &Compiler) -> bool {
    println!("\n== all crates with GPUs, for browsers");
    let mut check =
        compiler.cargo(&["check", "--quiet", "--lib", "--package", "strandline", "--features", "gpu"]);
    check.args(["--target", TARGET, "--target-dir"]).arg(work().join("check"));
    check.status().is_ok_and(|status| status.success())
}

/// Compiles the module. A library of the workspace becomes one here alone, so that nothing else links it.
fn module(compiler: &Compiler) -> Result<PathBuf> {
    println!("\n== the module");
    let folder = work().join("build");
    let words = ["rustc", "--release", "--lib", "--package", "strandline-web", "--crate-type", "cdylib"];
    let mut build = compiler.cargo(&words);
    build.args(["--target", TARGET, "--target-dir"]).arg(&folder);
    ensure!(build.status()?.success(), "the module does not compile");
    Ok(folder.join(TARGET).join("release/strandline_web.wasm"))
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

#[cfg(test)]
mod unit_tests {
    use super::*;

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
