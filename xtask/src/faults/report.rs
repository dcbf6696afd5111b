//! Results of planted faults, kept from run to run, and the page that lists them.

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::kept::{kept, make_room};
use super::list::{Backends, Fault};

/// Result of the tests of a fault.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The files that it was planted in.
    pub tree: String,
    /// Their commit, with a plus where there were changes on top.
    pub commit: String,
    /// True if tests ran on a GPU.
    pub gpu: bool,
    /// Wall-clock time of build and tests \[s\].
    pub seconds: u64,
    /// Reason why it was not planted or not tested.
    pub note: String,
    /// Tests that failed, each with its target.
    pub failed: Vec<String>,
    /// Tests that passed.
    pub passed: Vec<String>,
}

impl Outcome {
    fn path(name: &str) -> PathBuf {
        kept().join("results").join(format!("{name}.toml"))
    }

    /// The last one of a fault.
    pub fn load(name: &str) -> Option<Self> {
        toml::from_str(&std::fs::read_to_string(Self::path(name)).ok()?).ok()
    }

    /// Keeps it.
    pub fn save(&self, name: &str) -> Result<()> {
        let path = Self::path(name);
        make_room(&path)?;
        std::fs::write(&path, toml::to_string(self)?).with_context(|| path.display().to_string())
    }

    /// The tests on a backend that saw the fault.
    fn seen_on(&self, gpu: bool) -> Vec<&str> {
        let all = self.failed.iter().map(String::as_str);
        all.filter(|test| on_gpu(test) == gpu).collect()
    }

    /// In a line.
    pub fn summary(&self, fault: &Fault) -> String {
        let only = self.note.is_empty() && !self.failed.is_empty();
        let word = match [seen(fault, self), only, self.seen_on(true).is_empty()] {
            [true, ..] => "seen",
            [_, true, true] => "UNSEEN on a GPU, seen",
            [_, true, false] => "UNSEEN on the CPU, seen",
            _ => "UNSEEN",
        };
        let by = if self.failed.is_empty() { "no test".to_owned() } else { self.failed.join(", ") };
        let note = if self.note.is_empty() { String::new() } else { format!(" ({})", self.note) };
        format!("{word} by {by}{note}, {} s", self.seconds)
    }
}

/// True for tests that run on a GPU: laws ending in `::gpu`, all of parity, and tests with `_on_a_gpu_`.
fn on_gpu(test: &str) -> bool {
    test.ends_with("::gpu") || test.starts_with("parity ") || test.contains("_on_a_gpu_")
}

/// True if tests saw the fault on every backend that it affects and that was tried.
pub fn seen(fault: &Fault, outcome: &Outcome) -> bool {
    let applies = outcome.note.is_empty() || outcome.note == "ran out of time";
    let missing = |gpu: bool| outcome.seen_on(gpu).is_empty();
    let cpu = fault.on == Backends::Gpu || !missing(false);
    let gpu = fault.on == Backends::Cpu || !outcome.gpu || !missing(true);
    applies && cpu && gpu
}

const HEAD: &str = "\
# Planted faults

A law that nothing can break proves nothing. Each fault below is a small change of the code, in Rust and in the
kernel alike, so that comparing one backend with the other shows nothing; where only one of them has what is spoiled,
the other one's column says `as it was`. [checks/faults](../checks/faults) lists
them; `cargo xtask faults` plants each in a copy of the tree, runs the tests that have to see it, and prints this
page with `--table`. All take half an hour; it is no part of `cargo xtask test`, which only checks that
every fault still applies. A fault that goes unseen is a missing law.

";

/// The page of all results.
pub fn page(faults: &[Fault]) -> Result<String> {
    let mut page = HEAD.to_owned();
    let outcomes: Vec<_> = faults.iter().map(|fault| (fault, Outcome::load(&fault.name))).collect();
    let run = outcomes.iter().filter(|(_, outcome)| outcome.is_some()).count();
    let found =
        outcomes.iter().filter(|(fault, outcome)| outcome.as_ref().is_some_and(|o| seen(fault, o))).count();
    writeln!(page, "{} faults; {run} were run, {found} of them seen.\n", faults.len())?;
    writeln!(
        page,
        "| fault | what it does | seen on the CPU by | seen on a GPU by | commit |\n|---|---|---|---|---|"
    )?;
    for (fault, outcome) in outcomes {
        let [cpu, gpu, commit] = match &outcome {
            None => ["not run".to_owned(), "not run".to_owned(), String::new()],
            Some(outcome) => {
                let gpu = if outcome.gpu { cell(fault, outcome, true) } else { "not run".to_owned() };
                [cell(fault, outcome, false), gpu, outcome.commit.clone()]
            }
        };
        writeln!(page, "| {} | {} | {cpu} | {gpu} | {commit} |", fault.name, fault.what)?;
    }
    Ok(page)
}

/// The tests of a backend that saw a fault.
fn cell(fault: &Fault, outcome: &Outcome, gpu: bool) -> String {
    let spoiled = fault.on != if gpu { Backends::Cpu } else { Backends::Gpu };
    if !outcome.note.is_empty() && outcome.failed.is_empty() {
        return format!("**unseen** ({})", outcome.note);
    }
    let name = |test: &&str| {
        let name = test.split(' ').next_back().unwrap_or_default();
        format!("`{}`", name.trim_end_matches("::cpu").trim_end_matches("::gpu"))
    };
    let tests = outcome.seen_on(gpu);
    match (tests.is_empty(), spoiled) {
        (false, _) => tests.iter().map(name).collect::<Vec<_>>().join(", "),
        (true, true) => "**unseen**".to_owned(),
        (true, false) => "as it was".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(on: Backends) -> Fault {
        Fault { name: "f".into(), what: "w".into(), on, seen_by: Vec::new(), edit: Vec::new() }
    }

    #[test]
    fn a_fault_is_seen_only_where_every_backend_sees_it() {
        let outcome = |gpu: bool, failed: &[&str]| Outcome {
            gpu,
            failed: failed.iter().map(|test| (*test).to_owned()).collect(),
            ..Outcome::default()
        };
        assert!(seen(&fault(Backends::Both), &outcome(true, &["laws a::cpu", "laws a::gpu"])));
        assert!(!seen(&fault(Backends::Both), &outcome(true, &["laws a::cpu"])));
        assert!(seen(&fault(Backends::Both), &outcome(false, &["laws a::cpu"])));
        assert!(seen(&fault(Backends::Cpu), &outcome(true, &["laws a::cpu"])));
        assert!(seen(&fault(Backends::Gpu), &outcome(true, &["parity b"])));
        assert!(!seen(&fault(Backends::Both), &outcome(false, &[])));
        let broken = Outcome { note: "does not build".into(), ..outcome(false, &["laws a::cpu"]) };
        assert!(!seen(&fault(Backends::Both), &broken));
    }
}
