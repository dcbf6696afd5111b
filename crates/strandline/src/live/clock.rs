//! The time by which hair plays live.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use strandline_base::Stopwatch;

/// The time by which a [`Live`](crate::Live) judges how long pictures take and how long nothing has happened: that of
/// the machine by default, or one that a test moves on.
#[derive(Clone)]
pub struct LiveClock {
    manual: Option<Arc<Mutex<Manual>>>,
    /// The beginning of its time.
    start: Stopwatch,
}

impl Default for LiveClock {
    fn default() -> Self {
        Self { manual: None, start: Stopwatch::start() }
    }
}

/// A time that stands still until it is moved on.
#[derive(Default)]
struct Manual {
    now: Duration,
    /// Time of a picture \[s\].
    picture_seconds: f64,
    /// Called when time moves on.
    wake: Option<Box<dyn Fn() + Send>>,
}

impl LiveClock {
    /// A clock that stands still until it is moved on, by which pictures take no time.
    pub fn manual() -> Self {
        Self { manual: Some(Arc::default()), ..Self::default() }
    }

    /// Moves a manual clock on.
    pub fn advance(&self, by: Duration) {
        let Some(mut manual) = self.manual_time() else { return };
        manual.now += by;
        manual.wake.iter().for_each(|wake| wake());
    }

    /// Sets how long \[s\] every picture takes by a manual clock.
    pub fn set_picture_seconds(&self, seconds: f64) {
        if let Some(mut manual) = self.manual_time() {
            manual.picture_seconds = seconds;
        }
    }

    fn manual_time(&self) -> Option<MutexGuard<'_, Manual>> {
        self.manual.as_ref().map(|manual| manual.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Has `wake` called whenever a manual clock moves on.
    pub(super) fn on_advance(&self, wake: impl Fn() + Send + 'static) {
        if let Some(mut manual) = self.manual_time() {
            manual.wake = Some(Box::new(wake));
        }
    }

    /// Draws a picture, and how long \[s\] that took.
    pub(super) fn timed<T>(&self, draw: impl FnOnce() -> T) -> (T, f64) {
        let watch = Stopwatch::start();
        let drawn = draw();
        let seconds = self.manual_time().map_or_else(|| watch.seconds(), |manual| manual.picture_seconds);
        (drawn, seconds)
    }

    /// Time since its beginning.
    pub(super) fn now(&self) -> Duration {
        self.manual_time().map_or_else(|| self.start.elapsed(), |manual| manual.now)
    }

    /// The end of a time that begins now.
    pub(super) fn after(&self, patience: Duration) -> Deadline {
        Deadline { patience, manual: self.manual_time().map(|manual| manual.now + patience) }
    }

    /// Waits for a message, no longer than until a deadline; `is_advance` recognizes those that a manual clock's wake
    /// sends.
    pub(super) fn receive<T>(
        &self,
        messages: &Receiver<T>,
        deadline: &Deadline,
        is_advance: impl Fn(&T) -> bool,
    ) -> Result<T, RecvTimeoutError> {
        let Some(until) = deadline.manual else { return messages.recv_timeout(deadline.patience) };
        loop {
            let is_over = self.manual_time().is_some_and(|manual| manual.now >= until);
            let message = if is_over {
                messages.recv_timeout(Duration::ZERO)?
            } else {
                messages.recv().map_err(|_| RecvTimeoutError::Disconnected)?
            };
            if !is_advance(&message) {
                return Ok(message);
            }
        }
    }
}

/// The end of a time.
pub(super) struct Deadline {
    patience: Duration,
    /// By a manual clock.
    manual: Option<Duration>,
}
