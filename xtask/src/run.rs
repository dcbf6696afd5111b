//! Everything that must hold before a change lands, step by step, with the seconds of each.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::Stdio;

use crate::cargo::{cargo_command, root, wrapper};
use crate::programs::{self, Ran, Tally};
use crate::python::Coming;
use crate::times::{Clock, Times};
use crate::{adapter, bare, beside, house, licences, long, names, python, workflows};

/// Builds every test program and example; the messages of this call name them.
const BUILD: [&str; 4] = ["test", "--workspace", "--no-run", "--message-format=json-render-diagnostics"];

/// The outcome so far.
#[derive(Default)]
struct Report {
    tally: Tally,
    broken: Vec<String>,
    times: Times,
    failures: Vec<Ran>,
}

impl Report {
    /// Runs a step and notes its seconds and whether it passed.
    fn step(&mut self, name: &str, run: impl FnOnce(&mut Tally) -> bool) -> bool {
        let clock = Clock::start();
        let passed = run(&mut self.tally);
        self.times.add(name, clock.stop());
        if !passed {
            self.broken.push(name.to_owned());
        }
        passed
    }

    fn passed(&self) -> bool {
        self.broken.is_empty() && self.tally.failed == 0 && self.tally.passed > 0
    }
}

/// Runs all steps; false when anything failed. `setup` installs an adapter to test on where there is none.
pub fn test(setup: bool) -> bool {
    let whole = Clock::start();
    // Packages are fetched and unpacked beside what needs processors.
    let coming = Coming::begin(setup);
    let there = match adapter::prepare(setup) {
        Ok(there) => there,
        Err(why) => {
            println!("FAILED: {why}\ntests: 0 passed, 1 failed, 0 skipped");
            return false;
        }
    };
    let mut report = Report::default();
    report.times.add("adapter", whole.stop());
    // With what is built where that is built for the first time, by themselves where a checkout is worked in.
    let beside = setup && beside::begin();
    look(&mut report, beside);
    let denied = licences::deny_if_installed();
    report.step("deny", |_| denied.unwrap_or(true));
    let workflows = workflows::check_if_installed();
    report.step("workflows", |_| workflows.unwrap_or(true));
    let clock = Clock::start();
    let python = coming.wait();
    report.times.add("packages of Python", clock.stop());
    let mut wanted = Vec::new();
    if setup {
        wanted.extend([(adapter::REQUIRED, "1"), (adapter::DISPLAY_REQUIRED, "1")]);
    }
    wanted.extend(python.as_deref().map(|python| (python::NAMED, python)));
    tests(&mut report, &wanted, python.as_deref());
    if beside {
        beside::end();
    } else {
        document(&mut report);
    }
    let missing = [
        (there.adapter, adapter::UNTESTED),
        (there.display, adapter::NO_WINDOW),
        (python.is_some(), python::NONE),
        (denied.is_some(), licences::NOT_INSTALLED),
        (workflows.is_some(), workflows::NOT_INSTALLED),
        (grooms_are_there(), NO_GROOMS),
    ];
    report.times.add_sum("all", whole.stop());
    close(&report, missing.into_iter().filter(|(is_there, _)| !is_there).map(|(_, what)| what));
    report.passed()
}

/// The checks that run nothing of the program; lints of our crates unless the build runs them (`beside`).
fn look(report: &mut Report, beside: bool) {
    let passes = |arguments: &[&str]| cargo(arguments, &[], &mut Tally::default());
    let lints = ["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"];
    let without: Vec<&str> = ["clippy", "--quiet", "--no-deps"]
        .into_iter()
        .chain(bare::PACKAGES.iter().flat_map(|name| ["--package", name]))
        .chain(["--no-default-features", "--", "-D", "warnings"])
        .collect();
    report.step("format", |_| passes(&["fmt", "--all", "--check"]));
    report.step("names", |_| names::check());
    report.step("house", |_| house::check());
    report.step("licences", |_| licences::check());
    if !beside {
        report.step("lints", |_| passes(&lints));
    }
    report.step("crates without GPUs and window", |_| bare::is_built_from_what_it_needs());
    if !beside {
        report.step("lints without GPUs and window", |_| passes(&without));
    }
}

/// Builds, then runs the test programs, the tests in Python and the examples side by side, and the doc tests.
fn tests(report: &mut Report, wanted: &[(&str, &str)], python: Option<&str>) {
    let mut messages = String::new();
    // Programs and libraries without tests are linted with the rest.
    let rest = ["build", "--workspace", "--quiet", "--lib", "--bins", "--tests"];
    let is_built = |messages: &mut String| {
        build(messages) && (wrapper().is_none() || cargo(&rest, &[], &mut Tally::default()))
    };
    if !report.step(beside::step(), |_| is_built(&mut messages)) {
        return;
    }
    report.step("second build", |_| nothing_is_built_again());
    let mut programs = programs::found(&messages, &examples());
    report.step("build of the Python package", |_| {
        match python.map(|python| python::program(python, &python::ALL, &[])) {
            Some(Ok(program)) => {
                programs.push(program);
                true
            }
            Some(Err(error)) => {
                println!("the Python package is not tested: {error:#}");
                false
            }
            None => true,
        }
    });
    let clock = Clock::start();
    let ran = programs::run(programs, wanted);
    programs::keep(ran.iter().filter(|ran| ran.passed).map(|ran| (ran.name.clone(), ran.seconds.wall)));
    report.times.add_sum("test programs and examples", clock.stop());
    for ran in ran {
        report.tally.join(ran.tally);
        report.times.add(&ran.name, ran.seconds);
        if !ran.passed {
            report.broken.push(ran.name.clone());
            report.failures.push(ran);
        }
    }
    let docs = ["test", "--workspace", "--doc", "--no-fail-fast"];
    report.step("doc tests", |tally| cargo(&docs, &[], tally));
}

/// The documentation of our crates without a warning.
fn document(report: &mut Report) {
    let documentation = ["doc", "--workspace", "--no-deps", "--quiet"];
    report.step("documentation", |tally| cargo(&documentation, &[("RUSTDOCFLAGS", "-D warnings")], tally));
}

/// Builds what is tested; `messages` receives those of cargo.
fn build(messages: &mut String) -> bool {
    println!("\n== cargo {}", BUILD.join(" "));
    match cargo_command(&BUILD).stderr(Stdio::inherit()).output() {
        Ok(output) => {
            *messages = String::from_utf8_lossy(&output.stdout).into_owned();
            output.status.success()
        }
        Err(error) => {
            eprintln!("cannot run cargo: {error}");
            false
        }
    }
}

/// Checks that a second build of an unchanged tree compiles none of our crates.
fn nothing_is_built_again() -> bool {
    let mut messages = String::new();
    let built = build(&mut messages);
    let stale = programs::stale(&messages);
    stale.iter().for_each(|name| println!("built again although nothing changed: {name}"));
    built && stale.is_empty()
}

/// Prints seconds, failures once more, what was not tested, and the summary as the last line.
fn close(report: &Report, missing: impl Iterator<Item = &'static str>) {
    println!("\n{}", report.times.table());
    for ran in &report.failures {
        println!("== {} once more\n{}", ran.name, ran.failures().trim());
    }
    println!("{}", long::last_run());
    missing.for_each(|what| println!("NOT TESTED: {what}"));
    report.broken.iter().for_each(|name| println!("FAILED: {name}"));
    let Tally { passed, failed, ignored } = report.tally;
    println!("tests: {passed} passed, {failed} failed, {ignored} skipped");
}

/// Summary of the tests that need grooms.
const NO_GROOMS: &str = "grooms and heads that are not part of the project (STRANDLINE_GROOMS names their folder; with STRANDLINE_REQUIRE_GROOMS their tests fail without it)";

/// True if the folder of grooms outside the project exists.
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

/// Draws the panels of the window into docs/window.
pub fn panels() -> bool {
    let folder = root().join("docs/window").display().to_string();
    let pictures = ["test", "-p", "strandline-viewer", "--test", "window", "pictures"];
    cargo(&pictures, &[("STRANDLINE_PANELS", &folder)], &mut Tally::default())
}

/// Writes docs/scene.md and the sections of the Python package from the settings table, and docs/cli.md from the arguments
/// of the program.
pub fn docs() -> bool {
    let pages = [["--test", "it", "scene_reference::the_page"], ["--lib", "--quiet", "documents::the_page"]];
    let write = |page: &[&str; 3]| {
        let arguments: Vec<&str> = ["test", "--workspace"].iter().chain(page).copied().collect();
        cargo(&arguments, &[("STRANDLINE_BLESS", "1")], &mut Tally::default())
    };
    pages.iter().all(write) && python::write_sections()
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

/// Runs cargo in the root, forwards its output, and adds up its test results.
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
