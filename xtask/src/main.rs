//! Project chores: `cargo xtask test | ci | bless | names`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // it talks to a person at a terminal

mod adapter;
mod names;
mod run;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask COMMAND

  test     format, lints, names, all tests, doc tests, examples; closes with a summary.
           Tests of the GPU backend run on any adapter, and say so where there is none.
           --setup installs Debian's software Vulkan where there is no adapter; one that is
           still missing then fails the tests, as with STRANDLINE_REQUIRE_GPU=1
  ci       test --setup
  bless    record the golden pictures anew; look at each before you commit it
  names    check that every stage has one name everywhere";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let passed = match words[..] {
        ["test"] => run::test(false),
        ["test", "--setup"] | ["ci"] => run::test(true),
        ["bless"] => run::bless(),
        ["names"] => names::check(),
        ["--help" | "-h" | "help"] => {
            println!("{USAGE}");
            true
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
