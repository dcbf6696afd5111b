//! Threads as the standard library's: loom's lets every panic through to the test, here `join` tells the
//! one that was asked for.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::thread::Result;

/// The panic of a job; any other fails the test, whichever thread it is in.
pub(crate) struct Asked;

/// Starts threads.
pub(crate) struct Builder(loom::thread::Builder);

/// A thread that can be waited for.
pub(crate) struct JoinHandle<T>(loom::thread::JoinHandle<Result<T>>);

impl Builder {
    pub fn new() -> Self {
        Self(loom::thread::Builder::new())
    }

    pub fn name(self, name: String) -> Self {
        Self(self.0.name(name))
    }

    pub fn spawn<T: Send + 'static>(
        self,
        act: impl FnOnce() -> T + Send + 'static,
    ) -> std::io::Result<JoinHandle<T>> {
        let caught = || match catch_unwind(AssertUnwindSafe(act)) {
            Err(panic) if !panic.is::<Asked>() => resume_unwind(panic),
            result => result,
        };
        Ok(JoinHandle(self.0.spawn(caught)?))
    }
}

impl<T> JoinHandle<T> {
    /// Waits for the end of the thread; an error when it panicked.
    pub fn join(self) -> Result<T> {
        self.0.join()?
    }
}
