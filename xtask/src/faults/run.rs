//! Plants faults in a copy of the tree and runs the tests that have to see them.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use super::kept::kept;
use super::list::Fault;
use super::report::{Outcome, seen};
use super::tree::Tree;
use super::wish::Wish;
use crate::cargo::root;

/// A build and its tests may take so long; a fault may make a test run for ever.
const LONGEST: Duration = Duration::from_secs(1800);

/// Names the folder of grooms that are no part of the project.
const GROOMS: &str = "STRANDLINE_GROOMS";

/// A test binary.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Target {
    package: String,
    name: String,
}

impl Target {
    /// The target and the filter of `laws FILTER` or `PACKAGE/TARGET FILTER`.
    pub fn parse(test: &str) -> Result<(Self, String)> {
        let (target, filter) = test.split_once(' ').with_context(|| format!("no filter: {test:?}"))?;
        ensure!(!filter.trim().is_empty(), "no filter: {test:?}");
        let (package, name) = target.split_once('/').unwrap_or(("strandline-checks", target));
        Ok((Self { package: package.into(), name: name.into() }, filter.trim().into()))
    }

    fn arguments(&self) -> Vec<&str> {
        // A package by itself would have other features of its dependencies, and all of them built once more.
        match self.name.as_str() {
            "lib" => vec!["test", "--no-fail-fast", "--package", &self.package, "--lib"],
            name => vec!["test", "--no-fail-fast", "--workspace", "--test", name],
        }
    }
}

/// The test binaries of some faults, each with its filters.
fn targets<'a>(faults: impl IntoIterator<Item = &'a Fault>) -> Result<BTreeMap<Target, Vec<String>>> {
    let mut targets: BTreeMap<Target, Vec<String>> = BTreeMap::new();
    for test in faults.into_iter().flat_map(|fault| &fault.seen_by) {
        let (target, filter) = Target::parse(test)?;
        let filters = targets.entry(target).or_default();
        if !filters.contains(&filter) {
            filters.push(filter);
        }
    }
    Ok(targets)
}

/// Runs the faults one by one; true when every one that was run was seen.
pub fn all(faults: &[Fault], wish: &Wish) -> Result<bool> {
    let tree = Tree::copy(root(), &kept().join("tree"))?;
    let again = !wish.names.is_empty();
    let old = |fault: &Fault| {
        Outcome::load(&fault.name).filter(|old| old.tree == tree.hash && (old.gpu || wish.cpu))
    };
    let due: Vec<&Fault> = faults.iter().filter(|fault| again || old(fault).is_none()).collect();
    println!("{} faults, {} to run; results are kept in {}", faults.len(), due.len(), kept().display());
    if !due.is_empty() {
        without_faults(&tree, &due, wish)?;
    }
    let mut all_seen = true;
    for (number, fault) in due.iter().enumerate() {
        println!("\n== {} of {}: {}: {}", number + 1, due.len(), fault.name, fault.what);
        let outcome = plant(&tree, fault, wish)?;
        outcome.save(&fault.name)?;
        println!("{}", outcome.summary(fault));
    }
    println!();
    for fault in faults {
        let Some(outcome) = Outcome::load(&fault.name) else { continue };
        println!("{:<32} {}", fault.name, outcome.summary(fault));
        all_seen &= seen(fault, &outcome);
    }
    Ok(all_seen)
}

/// A test that fails by itself sees nothing.
fn without_faults(tree: &Tree, due: &[&Fault], wish: &Wish) -> Result<()> {
    let marker = kept().join(if wish.cpu { "sound_cpu" } else { "sound" });
    let wanted = format!("{}\n{:?}", tree.hash, targets(due.iter().copied())?);
    if std::fs::read_to_string(&marker).is_ok_and(|known| known == wanted) {
        return Ok(());
    }
    println!("== without a fault");
    for (target, filters) in targets(due.iter().copied())? {
        let ran = run(tree, &target, &filters, wish)?;
        ensure!(ran.built, "the tree does not build");
        ensure!(
            ran.failed.is_empty() && ran.in_time,
            "tests fail without a fault: {}",
            ran.failed.join(", ")
        );
        for filter in &filters {
            let found = ran.passed.iter().any(|test| test.contains(filter.as_str()));
            ensure!(found, "no test of {}: {filter}", target.name);
        }
    }
    std::fs::write(marker, wanted)?;
    Ok(())
}

/// Plants one fault, runs its tests and takes it out again.
fn plant(tree: &Tree, fault: &Fault, wish: &Wish) -> Result<Outcome> {
    let begin = Instant::now();
    let mut outcome =
        Outcome { tree: tree.hash.clone(), gpu: !wish.cpu, commit: commit(), ..Outcome::default() };
    let mut before = BTreeMap::new();
    let mut after: BTreeMap<PathBuf, String> = BTreeMap::new();
    for edit in &fault.edit {
        let path = tree.folder.join(&edit.file);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let planted = edit.apply(after.get(&path).unwrap_or(&text));
        before.entry(path.clone()).or_insert(text);
        match planted {
            Ok(text) => after.insert(path, text),
            Err(error) => {
                outcome.note = format!("does not apply: {error}");
                return Ok(outcome);
            }
        };
    }
    let result = write_all(&after).and_then(|()| {
        for (target, filters) in targets([fault])? {
            let ran = run(tree, &target, &filters, wish)?;
            if !ran.built {
                outcome.note = "does not build with the fault".to_owned();
            }
            if !ran.in_time {
                outcome.note = "ran out of time".to_owned();
            }
            outcome.failed.extend(ran.failed.iter().map(|test| format!("{} {test}", target.name)));
            outcome.passed.extend(ran.passed.iter().map(|test| format!("{} {test}", target.name)));
        }
        Ok(())
    });
    write_all(&before)?;
    result?;
    outcome.seconds = begin.elapsed().as_secs();
    Ok(outcome)
}

fn write_all(files: &BTreeMap<PathBuf, String>) -> Result<()> {
    files
        .iter()
        .try_for_each(|(path, text)| std::fs::write(path, text).with_context(|| path.display().to_string()))
}

/// The commit that the tree is at, with a plus where it has changes.
fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(root()).output().ok()?;
        String::from_utf8(output.stdout).ok()
    };
    let name = git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let changed = git(&["status", "--porcelain"]).is_some_and(|changes| !changes.is_empty());
    format!("{}{}", name.trim(), if changed { "+" } else { "" })
}

/// Result of a run of tests.
#[derive(Default)]
struct Ran {
    built: bool,
    in_time: bool,
    passed: Vec<String>,
    failed: Vec<String>,
}

impl Ran {
    /// Takes what a line of a test runner says.
    fn read(&mut self, line: &str) {
        self.built |= line.starts_with("running ");
        let Some((name, result)) = line.strip_prefix("test ").and_then(|rest| rest.rsplit_once(" ... "))
        else {
            return;
        };
        match result {
            "ok" => self.passed.push(name.to_owned()),
            "FAILED" => self.failed.push(name.to_owned()),
            _ => {}
        }
    }
}

fn run(tree: &Tree, target: &Target, filters: &[String], wish: &Wish) -> Result<Ran> {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(target.arguments()).arg("--").args(filters);
    if wish.cpu {
        command.args(["--skip", "::gpu"]);
    }
    command.current_dir(&tree.folder).env("CARGO_TARGET_DIR", kept().join("build"));
    // The copy has no folder of grooms beside it.
    if std::env::var_os(GROOMS).is_none() {
        command.env(GROOMS, root().join("../shared/grooms"));
    }
    command.env("RUST_BACKTRACE", "0").stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().context("cannot run cargo")?;
    let output = child.stdout.take().context("stdout is piped")?;
    let errors = child.stderr.take().context("stderr is piped")?;
    let reader = std::thread::spawn(move || {
        let mut ran = Ran::default();
        BufReader::new(output).lines().map_while(Result::ok).for_each(|line| ran.read(&line));
        ran
    });
    let complaints = std::thread::spawn(move || {
        let mut text = String::new();
        BufReader::new(errors).read_to_string(&mut text).ok();
        text
    });
    let begin = Instant::now();
    let in_time = loop {
        if child.try_wait()?.is_some() {
            break true;
        }
        if begin.elapsed() > LONGEST {
            child.kill()?;
            child.wait()?;
            break false;
        }
        std::thread::sleep(Duration::from_millis(100));
    };
    let mut ran = reader.join().map_err(|_| anyhow::anyhow!("reading the tests' output"))?;
    let complaints = complaints.join().unwrap_or_default();
    if !ran.built {
        complaints
            .lines()
            .filter(|line| line.starts_with("error"))
            .take(5)
            .for_each(|line| println!("{line}"));
    }
    ran.in_time = in_time;
    Ok(ran)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_named_by_target_and_filter() {
        let (target, filter) = Target::parse("laws springs::every").unwrap();
        assert_eq!((target.package.as_str(), target.name.as_str()), ("strandline-checks", "laws"));
        assert_eq!(filter, "springs::every");
        let (target, _) = Target::parse("strandline-sim/lib clock").unwrap();
        assert!(target.arguments().ends_with(&["strandline-sim", "--lib"]));
        assert!(Target::parse("laws").is_err() && Target::parse("laws ").is_err());
    }

    #[test]
    fn results_are_read_from_what_the_runner_prints() {
        let mut ran = Ran::default();
        for line in
            ["   Compiling x", "running 2 tests", "test a::cpu ... ok", "test b ... FAILED", "test result: x"]
        {
            ran.read(line);
        }
        assert!(ran.built);
        assert_eq!((ran.passed, ran.failed), (vec!["a::cpu".to_owned()], vec!["b".to_owned()]));
    }
}
