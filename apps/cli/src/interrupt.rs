//! Ctrl-C, and the request of a system that shuts down.
//!
//! Where pictures or steps follow each other the program stops between two of them, closes what it writes and
//! ends; a second request, or one at any other time, ends it at once, with its half-written files removed.

use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::{flag, low_level};
use strandline::base::abandon_parts;

use crate::{exit, output};

/// How often is looked for a signal. The handlers themselves may do nothing but note it, and a thread that
/// sleeps between looks works on every system.
const LOOK: Duration = Duration::from_millis(20);

/// The last signal that came; 0 for none.
static CAME: AtomicUsize = AtomicUsize::new(0);
/// The signal that asks those who look for it to stop; 0 for none.
static ASKED: AtomicUsize = AtomicUsize::new(0);
/// How many look for it.
static LOOKING: AtomicUsize = AtomicUsize::new(0);

/// Begins to listen. Where the system has no signals or no thread to give, its own way of ending stays.
pub fn listen() {
    let watched = std::thread::Builder::new().name("signals".to_owned()).spawn(watch).is_ok();
    for signal in [SIGINT, SIGTERM] {
        if watched && let Ok(value) = usize::try_from(signal) {
            // What cannot be registered keeps the system's way.
            let _ = flag::register_usize(signal, &CAME, value);
        }
    }
}

fn watch() {
    loop {
        std::thread::sleep(LOOK);
        let signal = CAME.swap(0, SeqCst);
        if signal == 0 {
            continue;
        }
        if LOOKING.load(SeqCst) == 0 || ASKED.swap(signal, SeqCst) != 0 {
            end_now(exit::SIGNAL + signal as i32);
        }
        output::note("stopping after this frame; once more stops at once");
    }
}

/// Ends the program at once: files that are not finished are removed.
pub fn end_now(code: i32) -> ! {
    let _abandoned = abandon_parts();
    // Nothing else of the program runs any more, such as a driver's own farewell beside its threads.
    low_level::exit(code)
}

/// Somebody who looks for the signal between frames, as long as it lives.
pub struct Stoppable(());

impl Stoppable {
    pub fn begin() -> Self {
        LOOKING.fetch_add(1, SeqCst);
        Self(())
    }

    /// The request to stop, if there was one.
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
