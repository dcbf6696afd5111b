//! The `strandline` program: view, render, sim, groom, convert, info, scene, bench, plot, gpus, shaders.

#![forbid(unsafe_code)]

mod arguments;
mod bench;
mod convert;
#[cfg(test)]
mod documents;
mod exit;
mod files;
mod gpus;
mod inputs;
mod interrupt;
mod logging;
mod manual;
mod non_finite;
mod output;
mod progress;
mod quiet;
mod reading;
mod render;
mod sim;
mod sim_report;
mod statistics;
mod values;
#[cfg(feature = "window")]
mod view;
#[cfg(not(feature = "window"))]
#[path = "no_view.rs"]
mod view;

use std::ffi::OsString;

use clap::Parser;

use arguments::{Arguments, Command};

/// Runs the program with the words of a command line, the first of which is its name. Returns its exit code. The process
/// is the program's: it handles signals, and may end or begin anew at once.
pub fn run_program(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    if words.get(1).is_some_and(|word| word == "sweep") {
        output::complain(
            "`sweep` is a command of the `strandline` that `pip install 'strandline[sweep]'` installs",
        );
        return exit::USAGE as u8;
    }
    let arguments = match Arguments::try_parse_from(words) {
        Ok(arguments) => arguments,
        Err(error) => return help(&error),
    };
    if arguments.command.as_ref().is_none_or(Command::opens_gpu) {
        quiet::quiet_mesa();
    }
    logging::begin(arguments.log);
    interrupt::listen();
    let outcome = run(&arguments);
    output::finish();
    let code = match outcome {
        Ok(()) => exit::SUCCESS,
        Err(error) => {
            output::complain(&error.to_string());
            code(&error)
        }
    };
    u8::try_from(code).unwrap_or(u8::MAX)
}

/// Prints clap's help, which is an error to it, or what is wrong with the command line.
fn help(error: &clap::Error) -> u8 {
    if error.use_stderr() {
        // It quotes what was given. A reader that closed standard error does not want to know.
        let _ = error.print();
        return exit::USAGE as u8;
    }
    output::written(error.print());
    output::finish();
    exit::SUCCESS as u8
}

/// The code that an error ends the program with.
fn code(error: &anyhow::Error) -> i32 {
    if let Some(stopped) = error.downcast_ref::<interrupt::Stopped>() {
        return exit::SIGNAL + stopped.signal as i32;
    }
    if error.is::<arguments::Usage>() {
        exit::USAGE
    } else if error.is::<non_finite::NotFinite>() {
        exit::NOT_FINITE
    } else if error.is::<render::NoVideo>() {
        exit::NO_VIDEO
    } else {
        exit::FAILURE
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.command {
        None => view::view_or_demo(),
        Some(Command::View(options)) => view::view(options),
        Some(Command::Render(options)) => render::render(options),
        Some(Command::Sim(options)) => sim::sim(options),
        Some(Command::Groom(options)) => files::groom(options),
        Some(Command::Convert(options)) => convert::convert(options),
        Some(Command::Info(options)) => files::info(options),
        Some(Command::Scene(options)) => files::scene(options),
        Some(Command::Bench(options)) => bench::bench(options),
        Some(Command::Plot(options)) => bench::plot(options),
        Some(Command::Gpus) => gpus::list(),
        Some(Command::Completions(options)) => manual::completions(options),
        Some(Command::Man(options)) => manual::pages(options),
        Some(Command::Shaders(options)) => gpus::shaders(options),
    }
}
