//! The order of programs: the longest first, so that the last ones end together.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::PathBuf;

use super::Program;
use crate::cargo::root;

/// Programs that start first while no run is kept, in this order: by the work and the waiting in their tests.
const LONG: [&str; 10] = [
    "strandline-checks/laws",
    "strandline/it",
    "strandline-checks/pictures",
    "strandline-checks/parity",
    "strandline-cli/program",
    "Python package",
    "strandline-cli/reliability",
    "strandline-cli/window",
    "strandline/soak",
    "strandline-viewer/window",
];
/// Seconds that such a program is taken for, and every other one without a kept run.
const UNKNOWN: [f64; 2] = [600.0, 30.0];

/// Seconds by program of the runs before.
type Kept = BTreeMap<String, f64>;

fn file() -> PathBuf {
    root().join("target/xtask/seconds.json")
}

fn kept() -> Kept {
    std::fs::read_to_string(file()).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
}

/// Keeps the seconds of programs by name; without them the next run has another order, nothing else.
pub fn keep(ran: impl IntoIterator<Item = (String, f64)>) {
    let mut seconds = kept();
    seconds.extend(ran);
    if let Ok(text) = serde_json::to_string_pretty(&seconds) {
        let written = std::fs::create_dir_all(root().join("target/xtask"));
        if let Err(error) = written.and_then(|()| std::fs::write(file(), text)) {
            println!("the seconds of this run are not kept: {error}: {}", file().display());
        }
    }
}

/// Sorts programs by their last seconds.
pub fn sort(programs: &mut [Program]) {
    sort_by(programs, &kept());
}

fn sort_by(programs: &mut [Program], kept: &Kept) {
    // The order within `LONG` holds because sorting is stable.
    let place = |name: &str| LONG.iter().position(|long| *long == name).unwrap_or(LONG.len());
    programs.sort_by_key(|program| place(&program.name));
    let seconds =
        |name: &str| kept.get(name).copied().unwrap_or(UNKNOWN[usize::from(place(name) == LONG.len())]);
    programs.sort_by_cached_key(|program| Reverse((1000.0 * seconds(&program.name)) as u64));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_of_the_last_run_comes_first_and_an_unknown_one_early() {
        let program = |name: &str| Program {
            name: name.into(),
            path: PathBuf::new(),
            folder: PathBuf::new(),
            prints: super::super::Prints::Tests,
            arguments: Vec::new(),
            environment: Vec::new(),
            longest: super::super::LONGEST,
        };
        let kept = Kept::from([("a/short".into(), 0.5), ("a/long".into(), 90.0), ("a/middle".into(), 7.0)]);
        let sorted = |names: &[&str], kept: &Kept| {
            let mut programs: Vec<_> = names.iter().map(|name| program(name)).collect();
            sort_by(&mut programs, kept);
            programs.into_iter().map(|program| program.name).collect::<Vec<_>>()
        };
        let names = ["a/short", "a/middle", "a/new", "a/long"];
        assert_eq!(sorted(&names, &kept), ["a/long", "a/new", "a/middle", "a/short"]);
        // Without a kept run.
        let names = ["a/new", "strandline/it", "strandline-checks/laws"];
        assert_eq!(sorted(&names, &Kept::new()), ["strandline-checks/laws", "strandline/it", "a/new"]);
    }
}
