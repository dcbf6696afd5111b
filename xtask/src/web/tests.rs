//! Tests of the finished page: its module in Node against the native program, and the page in Chromium.

use std::process::{Command, Stdio};

use super::folders::site;
use super::server;
use crate::adapter::install_packages;
use crate::cargo::{example, root};

/// Names of Chromium, by system.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Tests the page; prints what was not tested. `setup` installs Debian's Chromium where there is none.
pub fn test(setup: bool) -> bool {
    if !is_there("node") {
        println!("NOT TESTED: the page, without Node");
        return !setup;
    }
    let same = has_the_same_bits();
    let shown = match chromium(setup) {
        Some(chromium) => is_shown(chromium),
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
fn is_shown(chromium: &str) -> bool {
    println!("\n== the page in {chromium}");
    let Ok(address) = server::serve_beside(&site()) else {
        println!("the page is not served");
        return false;
    };
    node("browser.mjs").args([chromium, &address]).status().is_ok_and(|status| status.success())
}
