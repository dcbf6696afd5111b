//! Output of the program, and its behaviour when the output is closed.

use std::fmt::Arguments;
use std::io::{ErrorKind, Result, Write, stderr, stdout};

use strandline::file::printable;

use crate::exit;

/// Prints a line for a person to standard output.
macro_rules! print_line {
    () => { $crate::output::person(format_args!("\n")) };
    ($($words:tt)*) => { $crate::output::person(format_args!("{}\n", format_args!($($words)*))) };
}

/// Prints a part of such a line.
macro_rules! print_part {
    ($($words:tt)*) => { $crate::output::person(format_args!($($words)*)) };
}

pub(crate) use {print_line, print_part};

/// Text for the terminal, which may quote a file: control characters are spelled out.
pub fn person(text: Arguments) {
    written(stdout().write_all(printable(&text.to_string()).as_bytes()));
}

/// Text for a program, to the letter.
pub fn program(text: &str) {
    written(stdout().write_all(text.as_bytes()));
}

/// Everything that was printed is out.
pub fn finish() {
    written(stdout().flush());
}

/// A reader that ends early has seen enough (`| head`): that is no error, and the run continues to its end and its
/// code, with nobody to print to. A full disk ends the program with an error.
pub fn written(outcome: Result<()>) {
    match outcome {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
        Err(error) => {
            complain(&format!("cannot write to the standard output: {error}"));
            exit::end_now(exit::FAILURE)
        }
    }
}

/// Says something to know on standard error.
pub fn note(note: &str) {
    to_stderr("note", note);
}

/// Prints an error to standard error.
pub fn complain(error: &str) {
    to_stderr("strandline", error);
}

fn to_stderr(who: &str, what: &str) {
    // A closed stderr is no error.
    let _ = writeln!(stderr(), "{who}: {}", printable(what));
}
