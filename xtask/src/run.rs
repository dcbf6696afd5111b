//! Runs the steps one after the other and adds up what the test runners print.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

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
    let mut step = |name: &str, passed: bool| {
        if !passed {
            broken.push(name.to_owned());
        }
    };
    step("format", cargo(&["fmt", "--all", "--check"], &[], &mut tally));
    step("names", names::check());
    step("house", house::check());
    step("licences", licences::check());
    let denied = licences::deny_if_installed();
    step("deny", denied.unwrap_or(true));
    let lints = ["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"];
    step("lints", cargo(&lints, &[], &mut tally));
    let bare: Vec<&str> =
        ["clippy", "--quiet"].into_iter().chain(bare::CHOICE).chain(["--", "-D", "warnings"]).collect();
    step("without GPUs and window", bare::check() && cargo(&bare, &[], &mut tally));
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
    if !there.adapter {
        println!("NOT TESTED: {}", adapter::UNTESTED);
    }
    if !there.display {
        println!("NOT TESTED: {}", adapter::NO_WINDOW);
    }
    if python.is_none() {
        println!("NOT TESTED: {}", python::NONE);
    }
    if denied.is_none() {
        println!("NOT TESTED: {}", licences::NOT_INSTALLED);
    }
    if !grooms_are_there() {
        println!("NOT TESTED: {NO_GROOMS}");
    }
    for name in &broken {
        println!("FAILED: {name}");
    }
    println!("tests: {} passed, {} failed, {} skipped", tally.passed, tally.failed, tally.ignored);
    broken.is_empty() && tally.failed == 0 && tally.passed > 0
}

/// What is left out where nobody has put the grooms.
const NO_GROOMS: &str = "grooms and heads that are not part of the project (STRANDLINE_GROOMS names their folder; with STRANDLINE_REQUIRE_GROOMS their tests fail without it)";

/// Whether the folder of grooms that are not part of the project is where tests look for it.
fn grooms_are_there() -> bool {
    let beside = || root().join("../shared/grooms");
    std::env::var_os("STRANDLINE_GROOMS").map_or_else(beside, PathBuf::from).join("sintel").is_dir()
}

/// Records the golden pictures anew.
pub fn bless() -> bool {
    let mut tally = Tally::default();
    let pictures = ["test", "--workspace", "--test", "pictures", "golden"];
    cargo(&pictures, &[("STRANDLINE_BLESS", "1")], &mut tally)
}

/// Writes docs/scene.md anew from the settings table.
pub fn docs() -> bool {
    let mut tally = Tally::default();
    let page = ["test", "--workspace", "--test", "scene_reference", "the_page"];
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

/// The repository's root.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the root")
}

/// Cargo in the root.
pub fn cargo_command(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(root());
    command
}

/// An example's program, built with the workspace: a package by itself has other features of its dependencies, so
/// that all of them would be built once more. None where it does not build.
pub fn example(name: &str) -> Option<Command> {
    let build = ["build", "--workspace", "--quiet", "--example", name];
    let mut command = cargo_command(&build);
    let output = command.arg("--message-format=json-render-diagnostics").stderr(Stdio::inherit()).output();
    let output = output.ok().filter(|output| output.status.success())?;
    let mut program = Command::new(executable(&String::from_utf8_lossy(&output.stdout), name)?);
    program.current_dir(root());
    Some(program)
}

/// The file of an example in what cargo tells line by line.
fn executable(messages: &str, name: &str) -> Option<PathBuf> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    messages.filter(|message| message["target"]["name"] == name).find_map(|message| {
        let is_example = message["target"]["kind"].as_array()?.iter().any(|kind| kind == "example");
        message["executable"].as_str().filter(|_| is_example).map(PathBuf::from)
    })
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
    fn the_program_of_an_example_is_found_in_what_cargo_tells() {
        let messages = r#"not json
{"reason":"compiler-artifact","target":{"kind":["lib"],"name":"hello"},"executable":null}
{"reason":"compiler-artifact","target":{"kind":["bin"],"name":"hello"},"executable":"/t/hello"}
{"reason":"compiler-artifact","target":{"kind":["example"],"name":"length"},"executable":"/t/examples/length"}
{"reason":"compiler-artifact","target":{"kind":["example"],"name":"hello"},"executable":"/t/examples/hello"}"#;
        assert_eq!(executable(messages, "hello"), Some("/t/examples/hello".into()));
        assert_eq!(executable(messages, "gallery"), None);
    }

    #[test]
    fn results_are_added_and_other_lines_are_not() {
        let mut tally = Tally::default();
        assert!(tally.add("test result: FAILED. 3 passed; 1 failed; 2 ignored; 0 measured; 4 filtered out"));
        assert!(!tally.add("running 3 tests"));
        assert!(tally.add("test result: ok. 5 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out"));
        assert_eq!(tally, Tally { passed: 8, failed: 1, ignored: 2 });
    }
}
