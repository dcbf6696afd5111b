//! The order of programs: the longest first, so that the last ones end together.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::PathBuf;

use super::Program;
use crate::cargo::root;

/// Programs that start first while no run is kept, and the seconds that each is taken for: found on two cores with a
/// software adapter, rounded. The first ones decide when all have ended.
const LONG: [(&str, f64); 13] = [
    ("strandline-checks/laws", 900.0),
    ("strandline-checks/pictures", 500.0),
    ("strandline-checks/parity", 480.0),
    ("strandline/it", 470.0),
    ("Python package", 190.0),
    ("strandline-cli/program", 150.0),
    ("strandline-cli/reliability", 100.0),
    ("strandline/memory", 100.0),
    ("strandline/lib", 80.0),
    ("strandline/soak", 75.0),
    ("example figures", 70.0),
    ("strandline-viewer/window", 50.0),
    ("strandline-cli/window", 50.0),
];
/// Seconds that a program is taken for of which neither a run is kept nor anything known.
const UNKNOWN: f64 = 30.0;

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
    let known = |name: &str| LONG.iter().find(|(long, _)| *long == name).map(|(_, seconds)| *seconds);
    let seconds = |name: &str| kept.get(name).copied().or_else(|| known(name)).unwrap_or(UNKNOWN);
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
        let names = ["a/new", "strandline/memory", "strandline/it", "strandline-checks/laws"];
        let order = ["strandline-checks/laws", "strandline/it", "strandline/memory", "a/new"];
        assert_eq!(sorted(&names, &Kept::new()), order);
    }
}
