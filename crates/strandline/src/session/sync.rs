//! Primitives of the worker; checks/loom has its own of the same names.

pub(crate) use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc::Sender};
pub(crate) use std::thread;

use std::sync::mpsc::{self, RecvError};

/// A receiver that several threads may hold, although one waits at a time.
pub(crate) struct Receiver<T>(Mutex<mpsc::Receiver<T>>);

impl<T> Receiver<T> {
    /// Waits for a message.
    ///
    /// # Errors
    /// All senders are gone.
    pub fn recv(&self) -> Result<T, RecvError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).recv()
    }
}

/// A channel without a bound.
pub(crate) fn channel<T>() -> (Sender<T>, Receiver<T>) {
    let (sender, receiver) = mpsc::channel();
    (sender, Receiver(Mutex::new(receiver)))
}
