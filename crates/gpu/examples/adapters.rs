//! Lists the adapters, one per line; ends with 1 if there is none.

#![allow(clippy::print_stdout)] // it talks to a person at a terminal

use std::process::ExitCode;

fn main() -> ExitCode {
    let adapters = strandline_gpu::Gpu::list();
    adapters.iter().for_each(|adapter| println!("{adapter}"));
    ExitCode::from(u8::from(adapters.is_empty()))
}
