//! The `strandline` program: view, render, sim, groom, convert, info, scene, bench, plot, gpus, shaders.

#![allow(clippy::print_stdout, clippy::print_stderr)] // it talks to a person at a terminal

mod arguments;
mod bench;
mod files;
mod gpus;
mod non_finite;
mod progress;
mod render;
mod sim;
mod statistics;
mod view;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    // clap ends the program itself: 0 for help, 2 for wrong usage.
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("strandline: {error}");
            ExitCode::from(if error.is::<arguments::Usage>() {
                2
            } else if error.is::<non_finite::NotFinite>() {
                3
            } else {
                1
            })
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.command {
        None => view::view_or_demo(),
        Some(Command::View(options)) => view::view(options),
        Some(Command::Render(options)) => render::render(options),
        Some(Command::Sim(options)) => sim::sim(options),
        Some(Command::Groom(options)) => files::groom(options),
        Some(Command::Convert(options)) => files::convert(options),
        Some(Command::Info(options)) => files::info(options),
        Some(Command::Scene(options)) => files::scene(options),
        Some(Command::Bench(options)) => bench::bench(options),
        Some(Command::Plot(options)) => bench::plot(options),
        Some(Command::Gpus) => gpus::list(),
        Some(Command::Shaders(options)) => gpus::shaders(options),
    }
}
