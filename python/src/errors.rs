//! Errors of the package, and panics of ours, which are errors too.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use strandline::{Error, ErrorKind};

thread_local! {
    /// Place and text of the last panic of this thread.
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Keeps texts of panics for the error that reports them, in place of a trace on the terminal.
pub fn keep_panics_quiet() {
    set_hook(Box::new(|panic| PANIC.with(|text| *text.borrow_mut() = panic.to_string())));
}

/// Runs something long while other Python threads run; Ctrl-C raises `KeyboardInterrupt` after it.
pub fn run<T: Send>(py: Python<'_>, act: impl FnOnce() -> Result<T, Error> + Send) -> PyResult<T> {
    let done = py.detach(|| {
        catch_unwind(AssertUnwindSafe(act)).map_err(|_| PANIC.with(|text| text.borrow().replace('\n', " ")))
    });
    py.check_signals()?;
    match done {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => Err(refused(py, &error)),
        Err(panic) => {
            Err(error(py, &format!("an error of strandline's own, please report it: {panic}"), "other"))
        }
    }
}

/// The exception of an error, with the text that the program prints.
pub fn refused(py: Python<'_>, problem: &Error) -> PyErr {
    error(py, &problem.to_string(), kind(problem.kind()))
}

/// The exception of a value of the wrong kind or shape.
pub fn value(py: Python<'_>, text: &str) -> PyErr {
    error(py, text, "value")
}

/// `strandline.Error` with a text and a kind.
pub fn error(py: Python<'_>, text: &str, kind: &str) -> PyErr {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    match CLASS.import(py, "strandline.errors", "Error") {
        Ok(class) => PyErr::from_type(class.clone(), (text.to_owned(), kind.to_owned())),
        Err(error) => error,
    }
}

/// The word of a kind.
fn kind(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::DeviceLost => "device_lost",
        ErrorKind::OutOfMemory => "out_of_memory",
        ErrorKind::Refused => "refused",
        ErrorKind::Value => "value",
        ErrorKind::TooLarge => "too_large",
        ErrorKind::File => "file",
        ErrorKind::Busy => "busy",
        _ => "other",
    }
}
