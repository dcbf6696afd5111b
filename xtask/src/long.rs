//! The long forms of checks that are short in `cargo xtask test`, and the day on which each last passed.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::cargo::{cargo_command, root};
use crate::{adapter, bare, python, web};

/// Long tests: an environment, and the words for cargo behind `test --workspace --test`.
const TESTS: [((&str, &str), [&str; 2]); 24] = [
    // Each command is ended as often as this, at random times.
    (("STRANDLINE_KILLS", "52"), ["reliability", "kills::"]),
    // Seconds of random clicks, keys and files.
    (("STRANDLINE_RANDOM_USE", "60"), ["window", "random_use::"]),
    // Actions of a person in a window without a display.
    (("STRANDLINE_ACTIONS", "2000"), ["window", "measured::random_actions"]),
    // On a software adapter, which else has fewer lights, steps and cells.
    (("STRANDLINE_FULL", "1"), ["pictures", "gpu"]),
    // Laws of whole scenes on a software adapter, which the short run leaves out there.
    (("STRANDLINE_FULL", "1"), ["laws", "gpu"]),
    // Styles, small motion, a skin and the groom of Sintel on the CPU.
    (("STRANDLINE_FULL", "1"), ["laws", "rods::"]),
    (("STRANDLINE_FULL", "1"), ["laws", "small_motion::"]),
    (("STRANDLINE_FULL", "1"), ["laws", "skin_contact::"]),
    (("STRANDLINE_FULL", "1"), ["laws", "sintel::"]),
    // Every third step of both clips on the CPU.
    (("STRANDLINE_FULL", "1"), ["laws", "skin_depth::"]),
    // A hundred thousand damaged motions of vertices of each kind.
    (("STRANDLINE_FULL", "1"), ["body", "damaged::"]),
    // 64 strands thrown at 64 on the CPU.
    (("STRANDLINE_FULL", "1"), ["laws", "bundles::a_bundle_that_is_thrown"]),
    // Ten thousand pictures with changes at random, and a minute of shaking, in one process.
    (("STRANDLINE_FULL", "1"), ["soak", "::"]),
    // A minute of nods and turns on the CPU, twenty seconds on a software adapter.
    (("STRANDLINE_FULL", "1"), ["laws", "lasting::"]),
    // A minute of shaking on the CPU.
    (("STRANDLINE_FULL", "1"), ["laws", "shake::a_minute"]),
    // Ten minutes of it on the CPU.
    (("STRANDLINE_FULL", "1"), ["laws", "rod_mechanics::a_rod_shaken_at_twenty_g"]),
    // Every style, and more strands of each.
    (("STRANDLINE_FULL", "1"), ["laws", "drawn_strands_"]),
    (("STRANDLINE_FULL", "1"), ["program", "exported::"]),
    (("STRANDLINE_FULL", "1"), ["pictures", "scalp::"]),
    (("STRANDLINE_FULL", "1"), ["pictures", "heads::"]),
    (("STRANDLINE_FULL", "1"), ["pictures", "shares::"]),
    // Hair of every pigment in four lights by a path tracer of the checks.
    (("STRANDLINE_FULL", "1"), ["pictures", "traced_again::"]),
    // Hair of every pigment on a turned ball, in five lights.
    (("STRANDLINE_FULL", "1"), ["pictures", "traced::hair_that_is_turned"]),
    // All styles on the CPU, more on a software adapter, and steps down to 1/480 s.
    (("STRANDLINE_FULL", "1"), ["laws", "rod_styles::"]),
];

/// The browser page, which the workflow `ci` tests at each push.
const WEB: &str = "web";

/// Contents of bench/long.json: the day in UTC, as `2026-11-25`, on which each check last passed.
#[derive(Debug, Default, Deserialize, Serialize)]
struct Record(BTreeMap<String, String>);

fn file() -> PathBuf {
    root().join("bench/long.json")
}

/// A long check: its name, and what runs it and says whether it passed.
type Check = (String, Box<dyn Fn() -> bool>);

/// All long checks, in the order in which they run.
fn checks() -> Vec<Check> {
    let own = |name: &str, run: fn() -> bool| -> Check { (name.to_owned(), Box::new(run)) };
    let test = |(variable, words): ((&'static str, &'static str), [&'static str; 2])| -> Check {
        let name = format!("{}={} {}", variable.0, variable.1, words.join(" "));
        (name, Box::new(move || passes(variable, words)))
    };
    let first = [own("bare", bare::check)];
    first
        .into_iter()
        .chain(TESTS.map(test))
        .chain([
            own("python cluster", python::long_cluster),
            own("python guide", python::long_guide),
            own("python blender", python::long_blender),
            own(WEB, web::long),
        ])
        .collect()
}

/// Runs the long checks whose names hold one of the words, all without words, and records the day for each that passes.
/// False if one fails, or if no name holds a word.
pub fn run(words: &[String]) -> bool {
    let wanted = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    let checks: Vec<Check> = checks().into_iter().filter(|(name, _)| wanted(name)).collect();
    if checks.is_empty() {
        println!("no long check is called {}", words.join(" or "));
        return false;
    }
    let mut failed = Vec::new();
    for (name, run) in checks {
        println!("\n== {name}");
        let passed = run() && record(&name);
        failed.extend((!passed).then_some(name));
    }
    println!("{}", last_run());
    if !failed.is_empty() {
        println!("FAILED: {}", failed.join(", "));
    }
    failed.is_empty()
}

/// Runs tests by cargo's words for them.
fn passes(variable: (&str, &str), words: [&str; 2]) -> bool {
    let mut command = cargo_command(&["test", "--workspace", "--test"]);
    let required = [variable, (adapter::REQUIRED, "1"), (adapter::DISPLAY_REQUIRED, "1")];
    command.args(words).envs(required).status().is_ok_and(|status| status.success())
}

fn read() -> Record {
    let text = std::fs::read_to_string(file()).ok();
    text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
}

fn record(name: &str) -> bool {
    let days = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs() / 86_400);
    let mut record = read();
    record.0.insert(name.to_owned(), date(days));
    let text = serde_json::to_string_pretty(&record).expect("texts are JSON") + "\n";
    let written = std::fs::write(file(), text);
    if let Err(error) = &written {
        println!("the day is not recorded: {error}: {}", file().display());
    }
    written.is_ok()
}

/// A line with the day on which each of the long checks last passed.
pub fn last_run() -> String {
    let names: Vec<String> = checks().into_iter().map(|(name, _)| name).collect();
    line(&names, &read())
}

fn line(names: &[String], record: &Record) -> String {
    let day = |name: &String| record.0.get(name).map_or("never", String::as_str);
    let days: Vec<String> = names.iter().map(|name| format!("{name}: {}", day(name))).collect();
    format!("long checks (`cargo xtask long`), last passed: {}", days.join(", "))
}

/// The date of a day since 1970-01-01, in the Gregorian calendar.
fn date(days: u64) -> String {
    // Years begin in March, so that a leap day is the last of its year; 1970-01-01 is day 719,468 since 0000-03-01.
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * era + year + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_become_dates() {
        let known = [
            (0, "1970-01-01"),
            (11_016, "2000-02-29"),
            (20_782, "2026-11-25"),
            (47_540, "2100-02-28"),
            (47_541, "2100-03-01"),
        ];
        for (days, wanted) in known {
            assert_eq!(date(days), wanted);
        }
    }

    #[test]
    fn the_last_day_of_each_is_named_and_one_that_never_passed() {
        let record = Record([("bare".to_owned(), "2026-11-25".to_owned())].into());
        let names = ["bare".to_owned(), "web".to_owned()];
        assert!(line(&names, &record).ends_with("last passed: bare: 2026-11-25, web: never"));
    }

    /// Words of the jobs of the weekly workflow.
    fn words(workflow: &str) -> Vec<&str> {
        let lists = workflow.lines().filter_map(|line| line.trim().strip_prefix("words: '"));
        lists.flat_map(|list| list.split('"').skip(1).step_by(2)).collect()
    }

    #[test]
    fn each_check_but_the_page_has_a_job_of_the_weekly_workflow() {
        let workflow = std::fs::read_to_string(root().join(".github/workflows/long.yml")).unwrap();
        let words = words(&workflow);
        let names: Vec<String> = checks().into_iter().map(|(name, _)| name).collect();
        for word in &words {
            assert!(names.iter().any(|name| name.contains(word)), "no long check is called {word}");
        }
        for name in &names {
            let jobs = words.iter().filter(|word| name.contains(**word)).count();
            assert_eq!(jobs, usize::from(name != WEB), "{name}");
        }
        // GitHub ends a job after six hours.
        let minutes = workflow.lines().filter_map(|line| line.trim().strip_prefix("minutes: "));
        assert!(minutes.map(|minutes| minutes.parse::<u32>().unwrap()).all(|minutes| minutes <= 350));
    }

    #[test]
    fn names_differ_and_an_unknown_one_is_refused() {
        let mut names: Vec<String> = checks().into_iter().map(|(name, _)| name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(!run(&["no such check".to_owned()]));
    }
}
