//! The order of programs: the longest first, so that the last ones end together.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::PathBuf;

use super::Program;
use crate::cargo::root;

/// Seconds by the clock on a quiet machine of two cores, for programs of which no run is kept here.
const USUAL: [(&str, u32); 0] = [];
/// Seconds of a program of which nothing is known: early, so that it is never the one that all wait for.
const UNKNOWN: u32 = 60;

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
    let usual =
        |name: &str| USUAL.iter().find(|(known, _)| *known == name).map_or(UNKNOWN, |(_, usual)| *usual);
    programs.sort_by_cached_key(|program| {
        let seconds = kept.get(&program.name).copied().unwrap_or_else(|| usual(&program.name).into());
        Reverse((1000.0 * seconds) as u64)
    });
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
            tests: true,
        };
        let kept = Kept::from([("a/short".into(), 0.5), ("a/long".into(), 90.0), ("a/middle".into(), 7.0)]);
        let mut programs = ["a/short", "a/middle", "a/new", "a/long"].map(program).to_vec();
        sort_by(&mut programs, &kept);
        let names: Vec<_> = programs.iter().map(|program| program.name.as_str()).collect();
        assert_eq!(names, ["a/long", "a/new", "a/middle", "a/short"]);
    }
}
