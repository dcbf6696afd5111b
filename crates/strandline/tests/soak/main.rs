//! Long use of small hair: memory and results stay as they are at the beginning.

mod pictures;
mod shaken;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Runs one test after the other: the memory that they measure is that of the process.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// True in `cargo xtask long`, which sets `STRANDLINE_FULL` to 1.
fn in_full() -> bool {
    std::env::var_os("STRANDLINE_FULL").is_some_and(|value| value == "1")
}
