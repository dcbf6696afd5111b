//! Project chores: `cargo xtask test | ci | python | bless | panels | docs | names | house | faults | bare | web | long | deny | licences`.

#![forbid(unsafe_code)]
#![allow(clippy::print_stdout, clippy::print_stderr)] // it talks to a person at a terminal

mod adapter;
mod bare;
mod beside;
mod cargo;
mod comments;
mod faults;
mod house;
mod licences;
mod long;
mod names;
mod programs;
mod python;
mod run;
mod times;
mod web;
mod workflows;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask COMMAND

  test     format, lints, names, all tests, doc tests, examples; closes with a summary.
           Tests of the GPU backend run on any adapter, and print a note without one.
           --setup installs Debian's software Vulkan if there is no adapter, and Xvfb if there
           is no display; a device that is still missing then fails the tests, as with
           STRANDLINE_REQUIRE_GPU=1 and STRANDLINE_REQUIRE_DISPLAY=1. It also puts numpy and
           usd-core into target/python if python3 has none, and prints a note if it cannot
  ci       test --setup
  python   build the extension with the workspace and run the tests of the Python package; makes
           target/python if no Python has what they need
  bless    record the golden pictures again; look at each before you commit it
  panels   draw the window's panels for docs/window.md anew; look at each before you commit it
  docs     write docs/scene.md and python/strandline/sections.py from the settings table, and
           docs/cli.md from the arguments
  names    check that every stage has one name everywhere, and that comments name their subject first
  house    check the plan of the house: arrows between crates, circles of files, sizes
  faults   plant the faults of checks/faults in a copy of the tree, one after the other, and run
           the tests that have to see each. Results are kept: a run that was stopped early resumes,
           and a fault with a result for the current tree runs again only if it is named.
           [NAME..] these only, --cpu without the tests on a GPU, --list names and meanings,
           --table the page docs/faults.md
  bare     build the program without GPUs and window, check its crates, simulate and draw with it
  web      build the browser page into out/web: the module for WebAssembly, its script, the files of
           apps/web/site. --setup gets a compiler for it where rustup has none, and with --test
           Debian's Chromium; --test compares the module in Node with the native program to the
           bit, and opens the page in Chromium; --pictures draws its poster and the pictures of docs/web.md
           anew: look at each before you commit it; --serve serves it on this machine
  long     bare, web with --test, and the full length of the tests that `test` shortens: kills, random use of the
           window, pictures and skins on a software adapter; records the day of each that passes in
           bench/long.json. [WORD..] those alone whose names hold a word
  deny     check licences, sources and duplicates of dependencies with cargo-deny, and known
           faults if their list can be read; `test` does the first three if it is installed
  licences write docs/licences.md, the list of others' licences; [FILE] their texts as well";

/// A chore of the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Chore {
    Test { setup: bool },
    Python,
    Bless,
    Panels,
    Docs,
    Names,
    House,
    Faults(faults::Wish),
    Bare,
    Web(web::Wish),
    Long(Vec<String>),
    Deny,
    Licences(Option<String>),
    Help,
}

fn main() -> ExitCode {
    if beside::is_called() {
        return beside::compile();
    }
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let passed = match chore(&words) {
        Some(Chore::Test { setup }) => run::test(setup),
        Some(Chore::Python) => python::test(),
        Some(Chore::Bless) => run::bless(),
        Some(Chore::Panels) => run::panels(),
        Some(Chore::Docs) => run::docs(),
        Some(Chore::Names) => names::check(),
        Some(Chore::House) => house::check(),
        Some(Chore::Faults(wish)) => faults::faults(&wish),
        Some(Chore::Bare) => bare::check(),
        Some(Chore::Web(wish)) => web::web(wish),
        Some(Chore::Long(words)) => long::run(&words),
        Some(Chore::Deny) => licences::deny(),
        Some(Chore::Licences(texts)) => licences::write(texts.as_deref()),
        Some(Chore::Help) => {
            println!("{USAGE}");
            true
        }
        None => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Chore named by the words of the command line; `None` for an unknown one.
fn chore(words: &[&str]) -> Option<Chore> {
    if words.iter().any(|word| ["--help", "-h", "help"].contains(word)) {
        return Some(Chore::Help);
    }
    match words {
        ["test"] => Some(Chore::Test { setup: false }),
        ["test", "--setup"] | ["ci"] => Some(Chore::Test { setup: true }),
        ["python"] => Some(Chore::Python),
        ["bless"] => Some(Chore::Bless),
        ["panels"] => Some(Chore::Panels),
        ["docs"] => Some(Chore::Docs),
        ["names"] => Some(Chore::Names),
        ["house"] => Some(Chore::House),
        ["faults", words @ ..] => faults::Wish::parse(words).map(Chore::Faults),
        ["bare"] => Some(Chore::Bare),
        ["web", words @ ..] => web::Wish::parse(words).map(Chore::Web),
        ["long", words @ ..] => Some(Chore::Long(words.iter().map(|word| (*word).to_owned()).collect())),
        ["deny"] => Some(Chore::Deny),
        ["licences"] => Some(Chore::Licences(None)),
        ["licences", file] => Some(Chore::Licences(Some((*file).to_owned()))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_ask_for_chores() {
        assert_eq!(chore(&["test"]), Some(Chore::Test { setup: false }));
        assert_eq!(chore(&["test", "--setup"]), Some(Chore::Test { setup: true }));
        assert_eq!(chore(&["ci"]), Some(Chore::Test { setup: true }));
        assert_eq!(chore(&["test", "--help"]), Some(Chore::Help));
        for wrong in [&[][..], &["test", "--set"], &["ci", "--setup"], &["tset"], &["names", "test"]] {
            assert_eq!(chore(wrong), None, "{wrong:?}");
        }
    }
}
