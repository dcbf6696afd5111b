//! Tests of the finished page: its module in Node against the native program, and the page in Chromium.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::folders::{site, work};
use super::server;
use crate::adapter::install_packages;
use crate::cargo::{example, root};

/// Names of Chromium, by system.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Exit status of the test on WebGPU where the browser has no adapter.
const NO_ADAPTER: i32 = 3;
/// Largest mean FLIP of the device's picture from the processor's: samples at edges fall to either side.
const MOST_FLIP: &str = "0.02";

/// Draws the poster of the page, and the pictures of it in docs/web.md, anew.
pub fn pictures(setup: bool) -> bool {
    println!("\n== pictures of the page");
    let Some(chromium) = chromium(setup).filter(|_| is_there("node")) else {
        println!("no pictures without Chromium and Node");
        return false;
    };
    let folder = root().join("docs/web");
    let address = server::serve_beside(&site());
    let (Ok(address), Ok(())) = (address, fs::create_dir_all(&folder)) else {
        println!("the page is not served, or there is no folder {}", folder.display());
        return false;
    };
    let poster = root().join("apps/web/site/poster.webp");
    let drawn = node("pictures.mjs").args([chromium, &address]).arg(&folder).arg(&poster).status();
    drawn.is_ok_and(|status| status.success())
}

/// Tests the page; prints what was not tested. `setup` installs Debian's Chromium where there is none.
pub fn test(setup: bool) -> bool {
    if !is_there("node") {
        println!("NOT TESTED: the page, without Node");
        return !setup;
    }
    let same = has_the_same_bits();
    let shown = match chromium(setup) {
        Some(chromium) => is_shown(chromium, setup),
        None => {
            println!(
                "NOT TESTED: the page in a browser, without Chromium (`cargo xtask web --setup --test` installs Debian's)"
            );
            !setup
        }
    };
    same && shown
}

fn is_there(program: &str) -> bool {
    let mut command = Command::new(program);
    command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

fn chromium(setup: bool) -> Option<&'static str> {
    let known = || CHROMIUM.into_iter().find(|name| is_there(name));
    known().or_else(|| if setup && install_packages(&["chromium"]) { known() } else { None })
}

fn node(script: &str) -> Command {
    let mut node = Command::new("node");
    node.current_dir(root()).arg(format!("apps/web/tests/{script}")).arg(site());
    node
}

/// Compares the bits of scenes in the module with those of the native program.
fn has_the_same_bits() -> bool {
    println!("\n== the module in Node against the native program");
    let Some(mut native) = example("web_bits") else {
        println!("the native program does not build");
        return false;
    };
    // The module has one thread.
    native.env("RAYON_NUM_THREADS", "1").stderr(Stdio::inherit());
    let outputs =
        [&mut native, node("bits.mjs").stderr(Stdio::inherit())].map(|command| command.output().ok());
    let [Some(native), Some(module)] = outputs.map(|output| output.filter(|output| output.status.success()))
    else {
        println!("the module or the native program fails");
        return false;
    };
    let [native, module] =
        [native, module].map(|output| String::from_utf8_lossy(&output.stdout).into_owned());
    println!("scene, sums of the bits of a step and of a picture\n{}", native.trim_end());
    if native != module || native.is_empty() {
        println!("the module has other bits:\n{}", module.trim_end());
        return false;
    }
    println!("the module has the same");
    true
}

/// Opens the page in Chromium without a screen.
fn is_shown(chromium: &str, setup: bool) -> bool {
    println!("\n== the page in {chromium}");
    let Ok(address) = server::serve_beside(&site()) else {
        println!("the page is not served");
        return false;
    };
    let shown = node("browser.mjs").args([chromium, &address]).status().is_ok_and(|status| status.success());
    shown & is_shown_on_webgpu(chromium, &address, setup)
}

/// Opens the page on WebGPU, which is software where there is no GPU, and holds its picture to the processor's.
fn is_shown_on_webgpu(chromium: &str, address: &str, setup: bool) -> bool {
    println!("\n== the page on WebGPU in {chromium}");
    let pictures = work().join("pictures");
    if fs::create_dir_all(&pictures).is_err() {
        println!("no folder: {}", pictures.display());
        return false;
    }
    let status = node("gpu.mjs").args([chromium, address]).arg(&pictures).status();
    match status.ok().and_then(|status| status.code()) {
        Some(0) => looks_the_same(&pictures),
        Some(NO_ADAPTER) => {
            println!("NOT TESTED: the page on WebGPU, for which {chromium} has no adapter");
            !setup
        }
        _ => false,
    }
}

/// Holds the picture of the device to that of the processor.
fn looks_the_same(pictures: &Path) -> bool {
    let Some(mut flip) = example("web_flip") else {
        println!("the program that compares pictures does not build");
        return false;
    };
    flip.args(["device.ppm", "processor.ppm"].map(|name| pictures.join(name))).arg(MOST_FLIP);
    flip.status().is_ok_and(|status| status.success())
}
