//! The long forms of checks that are short in `cargo xtask test`, and the day on which they last passed.

use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::cargo::{cargo_command, root};
use crate::{adapter, bare, python, web};

/// Long tests: an environment, and the words for cargo behind `test --workspace --test`.
const TESTS: [((&str, &str), [&str; 2]); 7] = [
    // Each command is ended as often as this, at random times.
    (("STRANDLINE_KILLS", "52"), ["reliability", "kills::"]),
    // Seconds of random clicks, keys and files.
    (("STRANDLINE_RANDOM_USE", "60"), ["window", "random_use::"]),
    // Actions of a person in a window without a display.
    (("STRANDLINE_ACTIONS", "2000"), ["window", "measured::random_actions"]),
    // On a software adapter, which else has fewer lights, steps and cells.
    (("STRANDLINE_FULL", "1"), ["pictures", "gpu"]),
    (("STRANDLINE_FULL", "1"), ["laws", "skin_contact::hair_on_a_gpu"]),
    (("STRANDLINE_FULL", "1"), ["laws", "rods::hair_on_a_head"]),
    // More styles on a software adapter, and steps down to 1/480 s.
    (("STRANDLINE_FULL", "1"), ["laws", "rod_styles::"]),
];

/// Contents of bench/long.json.
#[derive(Debug, Deserialize, Serialize)]
struct Record {
    /// Day in UTC, as `2026-11-25`.
    date: String,
    /// Checks that passed on that day.
    checks: Vec<String>,
}

fn file() -> PathBuf {
    root().join("bench/long.json")
}

/// Runs the long checks and records the day where all passed.
pub fn run() -> bool {
    let mut checks = vec!["bare".to_owned()];
    let mut passed = bare::check();
    for ((name, value), test) in TESTS {
        println!("\n== {name}={value} {}", test.join(" "));
        let mut command = cargo_command(&["test", "--workspace", "--test"]);
        let required = [(name, value), (adapter::REQUIRED, "1"), (adapter::DISPLAY_REQUIRED, "1")];
        passed &= command.args(test).envs(required).status().is_ok_and(|status| status.success());
        checks.push(format!("{name}={value} {}", test.join(" ")));
    }
    let (sweep, swept) = python::long();
    let (page, shown) = web::long();
    checks.extend([sweep, page]);
    passed && swept && shown && record(checks)
}

fn record(checks: Vec<String>) -> bool {
    let days = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs() / 86_400);
    let record = serde_json::to_string_pretty(&Record { date: date(days), checks });
    let text = record.expect("texts are JSON") + "\n";
    let written = std::fs::write(file(), text);
    if let Err(error) = &written {
        println!("the day is not recorded: {error}: {}", file().display());
    }
    written.is_ok()
}

/// A line with the day on which the long checks last passed.
pub fn last_run() -> String {
    let text = std::fs::read_to_string(file()).ok();
    line(text.and_then(|text| serde_json::from_str(&text).ok()))
}

fn line(record: Option<Record>) -> String {
    let last = match record {
        Some(Record { date, checks }) => format!("last passed on {date}: {}", checks.join(", ")),
        None => "never passed".to_owned(),
    };
    format!("long checks (`cargo xtask long`) {last}")
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
    fn the_last_day_is_named() {
        let record =
            Record { date: "2026-11-25".into(), checks: vec!["bare".into(), "STRANDLINE_KILLS=52".into()] };
        let line_of_it = line(Some(record));
        assert!(line_of_it.ends_with("last passed on 2026-11-25: bare, STRANDLINE_KILLS=52"), "{line_of_it}");
        assert!(line(None).ends_with("never passed"));
    }
}
