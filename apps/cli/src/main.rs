//! The `strandline` program.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(strandline_cli::run_program(std::env::args_os()))
}
