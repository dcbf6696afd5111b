//! Runs the steps one after the other and adds up what the test runners print.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::Stdio;
use std::time::Instant;

use crate::cargo::{cargo_command, example, root};
use crate::{adapter, bare, house, licences, names, python};

/// Sums over every `test result:` line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tally {
    passed: u64,
    failed: u64,
    ignored: u64,
}

impl Tally {
    /// Adds a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; ...`; false when it is not one.
    fn add(&mut self, line: &str) -> bool {
        let Some(counts) = line.trim_start().strip_prefix("test result:") else { return false };
        for part in counts.split([';', '.']) {
            let mut words = part.split_whitespace();
            let (Some(number), Some(word)) = (words.next().and_then(|n| n.parse::<u64>().ok()), words.next())
            else {
                continue;
            };
            match word {
                "passed" => self.passed += number,
                "failed" => self.failed += number,
                "ignored" => self.ignored += number,
                _ => {}
            }
        }
        true
    }
}

/// Everything that must hold before a change lands. False when anything failed. `setup` installs an
/// adapter to test on where there is none.
pub fn test(setup: bool) -> bool {
    let there = match adapter::prepare(setup) {
        Ok(there) => there,
        Err(why) => {
            println!("FAILED: {why}\ntests: 0 passed, 1 failed, 0 skipped");
            return false;
        }
    };
    let python = python::prepare(setup);
    let mut wanted = Vec::new();
    if setup {
        wanted.extend([(adapter::REQUIRED, "1"), (adapter::DISPLAY_REQUIRED, "1")]);
    }
    wanted.extend(python.as_deref().map(|python| (python::NAMED, python)));
    let begin = Instant::now();
    let mut tally = Tally::default();
    let mut broken: Vec<String> = Vec::new();
    let denied = licences::deny_if_installed();
    let mut step = |name: &str, passed: bool| {
        if !passed {
            broken.push(name.to_owned());
        }
    };
    for (name, passed) in look() {
        step(name, passed);
    }
    step("deny", denied.unwrap_or(true));
    let tests = ["test", "--workspace", "--all-targets", "--no-fail-fast"];
    step("tests", cargo(&tests, &wanted, &mut tally));
    step("doc tests", cargo(&["test", "--workspace", "--doc", "--no-fail-fast"], &[], &mut tally));
    let docs = ["doc", "--workspace", "--no-deps", "--quiet"];
    step("documentation", cargo(&docs, &[("RUSTDOCFLAGS", "-D warnings")], &mut tally));
    for name in examples() {
        println!("\n== example {name}");
        let ran = example(&name).is_some_and(|mut program| {
            program.env("STRANDLINE_QUICK", "1").status().is_ok_and(|status| status.success())
        });
        step(&format!("example {name}"), ran);
    }
    println!("\ntook {:.0} s", begin.elapsed().as_secs_f64());
    let missing = [
        (there.adapter, adapter::UNTESTED),
        (there.display, adapter::NO_WINDOW),
        (python.is_some(), python::NONE),
        (denied.is_some(), licences::NOT_INSTALLED),
        (grooms_are_there(), NO_GROOMS),
    ];
    for (_, what) in missing.iter().filter(|(is_there, _)| !is_there) {
        println!("NOT TESTED: {what}");
    }
    for name in &broken {
        println!("FAILED: {name}");
    }
    println!("tests: {} passed, {} failed, {} skipped", tally.passed, tally.failed, tally.ignored);
    broken.is_empty() && tally.failed == 0 && tally.passed > 0
}

/// The checks that run nothing of the program: each one's name, and whether it passed.
fn look() -> [(&'static str, bool); 6] {
    let passes = |arguments: &[&str]| cargo(arguments, &[], &mut Tally::default());
    let lints = ["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"];
    let bare: Vec<&str> =
        ["clippy", "--quiet"].into_iter().chain(bare::CHOICE).chain(["--", "-D", "warnings"]).collect();
    [
        ("format", passes(&["fmt", "--all", "--check"])),
        ("names", names::check()),
        ("house", house::check()),
        ("licences", licences::check()),
        ("lints", passes(&lints)),
        ("without GPUs and window", bare::check() && passes(&bare)),
    ]
}

/// What is left out where the grooms are missing.
const NO_GROOMS: &str = "grooms and heads that are not part of the project (STRANDLINE_GROOMS names their folder; with STRANDLINE_REQUIRE_GROOMS their tests fail without it)";

/// Whether the folder of grooms that are not part of the project is where tests look for it.
fn grooms_are_there() -> bool {
    let beside = || root().join("../shared/grooms");
    std::env::var_os("STRANDLINE_GROOMS").map_or_else(beside, PathBuf::from).join("sintel").is_dir()
}

/// Records the golden pictures again.
pub fn bless() -> bool {
    let mut tally = Tally::default();
    let pictures = ["test", "--workspace", "--test", "pictures", "golden"];
    cargo(&pictures, &[("STRANDLINE_BLESS", "1")], &mut tally)
}

/// Writes docs/scene.md again from the settings table.
pub fn docs() -> bool {
    let mut tally = Tally::default();
    let page = ["test", "--workspace", "--test", "it", "scene_reference::the_page"];
    cargo(&page, &[("STRANDLINE_BLESS", "1")], &mut tally)
}

/// The examples, by the name of their file or folder, in order.
fn examples() -> Vec<String> {
    let folder = root().join("examples");
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let folder = entry.path().join("main.rs").exists();
            if folder { Some(name) } else { name.strip_suffix(".rs").map(str::to_owned) }
        })
        .collect();
    names.sort();
    names
}

/// Runs cargo in the root, prints what it prints, and adds up its test results.
fn cargo(arguments: &[&str], environment: &[(&str, &str)], tally: &mut Tally) -> bool {
    println!("\n== cargo {}", arguments.join(" "));
    let mut command = cargo_command(arguments);
    command.stdout(Stdio::piped());
    command.envs(environment.iter().copied());
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => {
            eprintln!("cannot run cargo: {error}");
            return false;
        }
    };
    let output = BufReader::new(child.stdout.take().expect("stdout is piped"));
    for line in output.lines().map_while(Result::ok) {
        println!("{line}");
        tally.add(&line);
    }
    child.wait().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_added_and_other_lines_are_not() {
        let mut tally = Tally::default();
        assert!(tally.add("test result: FAILED. 3 passed; 1 failed; 2 ignored; 0 measured; 4 filtered out"));
        assert!(!tally.add("running 3 tests"));
        assert!(tally.add("test result: ok. 5 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out"));
        assert_eq!(tally, Tally { passed: 8, failed: 1, ignored: 2 });
    }
}
