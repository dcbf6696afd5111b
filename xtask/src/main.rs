//! Project chores: `cargo xtask test | ci | bless | names`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // it talks to a person at a terminal

mod names;
mod run;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask COMMAND

  test     format, lints, names, all tests, doc tests, examples; closes with a summary
  ci       the same
  bless    record the golden pictures anew; look at each before you commit it
  names    check that every stage has one name everywhere";

fn main() -> ExitCode {
    let command = std::env::args().nth(1).unwrap_or_default();
    let passed = match command.as_str() {
        "test" | "ci" => run::test(),
        "bless" => run::bless(),
        "names" => names::check(),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
