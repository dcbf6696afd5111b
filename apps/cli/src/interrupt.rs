//! Ctrl-C, a terminal that is closed, and the request of a system that shuts down.
//!
//! A program that makes pictures or steps stops between two of them, closes its files and ends. A second
//! request, or one at any other time, ends it at once and removes its half-written files.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

use crate::{exit, output};

/// Interval of the checks for a signal. The handlers may only set a flag, and a thread that sleeps between
/// checks works on every system.
const LOOK: Duration = Duration::from_millis(20);

/// The last signal; 0 before any.
static CAME: AtomicUsize = AtomicUsize::new(0);
/// The signal that asks observers to stop; 0 before any.
static ASKED: AtomicUsize = AtomicUsize::new(0);
/// Number of observers.
static LOOKING: AtomicUsize = AtomicUsize::new(0);
/// True if the interrupted work has ended by itself: the program only has to report it.
static FINISHED: AtomicBool = AtomicBool::new(false);

/// Begins to listen. Where the system has no signals or no thread to give, its own way of ending stays.
pub fn listen() {
    let watched = std::thread::Builder::new().name("signals".to_owned()).spawn(watch).is_ok();
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        let heeded = signal != SIGHUP || heeds_hangup();
        if watched
            && heeded
            && let Ok(value) = usize::try_from(signal)
        {
            // A signal that cannot be registered keeps the system's behaviour.
            let _ = flag::register_usize(signal, &CAME, value);
        }
    }
}

/// True if a closed terminal is to end the program. `nohup`, or a shell's `trap '' HUP`, makes a program
/// begin with that signal ignored. Only Linux reports it without an unsafe call; elsewhere the signal keeps
/// the system's behaviour.
fn heeds_hangup() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    ignored_signals(&status).is_some_and(|ignored| ignored & (1 << (SIGHUP - 1)) == 0)
}

/// The mask of ignored signals of a process, as Linux reports it; signal 1 is its lowest bit.
fn ignored_signals(status: &str) -> Option<u64> {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    u64::from_str_radix(mask.trim(), 16).ok()
}

fn watch() {
    loop {
        std::thread::sleep(LOOK);
        let signal = CAME.swap(0, SeqCst);
        if signal == 0 {
            continue;
        }
        // In this order: an observer that finishes sets the flag before the count of observers falls.
        let looking = LOOKING.load(SeqCst) > 0;
        let finished = FINISHED.load(SeqCst);
        if !(looking || finished) || ASKED.swap(signal, SeqCst) != 0 {
            exit::end_now(exit::SIGNAL + signal as i32);
        }
        if finished {
            continue;
        }
        output::note("stopping after this frame; once more stops at once");
    }
}

/// An observer of the signal between frames, as long as it lives.
pub struct Stoppable(());

impl Stoppable {
    pub fn begin() -> Self {
        LOOKING.fetch_add(1, SeqCst);
        Self(())
    }

    /// Marks the work as done and written: a request to stop that comes later has no effect.
    pub fn finish(self) {
        FINISHED.store(true, SeqCst);
    }

    /// Fails where a person or the system has asked the program to stop; `done` of `of` are finished.
    pub fn check(&self, done: u64, of: u64, what: &'static str) -> Result<(), Stopped> {
        match ASKED.load(SeqCst) {
            0 => Ok(()),
            signal => Err(Stopped { signal, done, of, what }),
        }
    }
}

impl Drop for Stoppable {
    fn drop(&mut self) {
        LOOKING.fetch_sub(1, SeqCst);
    }
}

/// The program was asked to stop before it was done.
#[derive(Debug, thiserror::Error)]
#[error("stopped after {done} of {of} {what}")]
pub struct Stopped {
    pub signal: usize,
    done: u64,
    of: u64,
    what: &'static str,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mask_of_ignored_signals_is_read() {
        let status =
            "Name:\tx\nSigBlk:\t0000000000000000\nSigIgn:\t0000000000001001\nSigCgt:\t0000000000000000\n";
        assert_eq!(ignored_signals(status), Some(0x1001));
        assert_eq!(ignored_signals("Name:\tx\n"), None);
        assert_eq!(ignored_signals("SigIgn:\tx\n"), None);
    }
}
