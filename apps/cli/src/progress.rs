//! Progress of anything longer than a second: a bar on a terminal, a line now and then elsewhere.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output;

/// Delay after which a bar is shown.
const PATIENCE: Duration = Duration::from_secs(1);
/// Delay after which a line is written, and the interval of further lines.
const FIRST_LINE: Duration = Duration::from_secs(2);
const LINE_EVERY: Duration = Duration::from_secs(30);

/// Shows how far something has come, how fast it is, and how long it will take.
pub struct Progress {
    begin: Instant,
    total: u64,
    what: &'static str,
    bar: Option<ProgressBar>,
    quiet: bool,
    watched: bool,
    /// Time of the next line where no bar is shown.
    next_line: Duration,
    /// Tells that the first one is under way, whose end nobody knows.
    first: Option<Waiting>,
}

impl Progress {
    /// Begins to count to `total` of `what`; `quiet` shows nothing.
    pub fn new(total: u64, what: &'static str, quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        let first = (!quiet).then(|| Waiting::begin("making the first frame"));
        Self { begin: Instant::now(), total, what, bar: None, quiet, watched, next_line: FIRST_LINE, first }
    }

    /// Says something without tearing the bar.
    pub fn note(&self, note: &str) {
        match self.bar.as_ref().or(self.first.as_ref().and_then(|first| first.bar.as_ref())) {
            Some(bar) => bar.suspend(|| output::note(note)),
            None => output::note(note),
        }
    }

    /// `done` are done.
    pub fn reached(&mut self, done: u64) {
        if done > 0 {
            self.first = None;
        }
        if !self.watched {
            self.tell(done);
            return;
        }
        if self.bar.is_none() && self.begin.elapsed() > PATIENCE {
            let bar = ProgressBar::new(self.total).with_elapsed(self.begin.elapsed());
            let style = format!("{{bar:32}} {{pos}}/{{len}} {}, {{per_sec}}, {{eta}} left", self.what);
            if let Ok(style) = ProgressStyle::with_template(&style) {
                bar.set_style(style);
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }
}

impl Progress {
    /// Writes a line where it is time for one.
    fn tell(&mut self, done: u64) {
        let passed = self.begin.elapsed();
        if self.quiet || done == 0 || done >= self.total || passed < self.next_line {
            return;
        }
        self.next_line = passed + LINE_EVERY;
        output::note(&line(done, self.total, self.what, passed));
    }
}

/// A line about progress.
fn line(done: u64, total: u64, what: &str, passed: Duration) -> String {
    let left = passed.as_secs_f64() / done as f64 * total.saturating_sub(done) as f64;
    format!("{done} of {total} {what} in {:.0} s, about {left:.0} s left", passed.as_secs_f64())
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Message while hair and body are loaded or grown and the body's distances are computed.
pub const LOADING: &str = "loading hair and body";

/// Shows that something is under way whose progress is not known.
pub struct Waiting {
    bar: Option<ProgressBar>,
    /// Ends the thread that writes lines where no bar is shown.
    lines: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Waiting {
    /// Begins.
    pub fn begin(what: &'static str) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self { bar: None, lines: lines(what) };
        }
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(what);
        bar.enable_steady_tick(PATIENCE);
        Self { bar: Some(bar), lines: None }
    }
}

/// A thread that writes a line now and then until its sender is gone; none where the system gives none.
fn lines(what: &'static str) -> Option<(Sender<()>, JoinHandle<()>)> {
    let (sender, receiver) = channel();
    let begin = Instant::now();
    let tell = move || {
        let mut wait = FIRST_LINE;
        while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(wait) {
            output::note(&format!("{what}: {:.0} s so far", begin.elapsed().as_secs_f64()));
            wait = LINE_EVERY;
        }
    };
    let thread = std::thread::Builder::new().name("waiting".to_owned()).spawn(tell).ok()?;
    Some((sender, thread))
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        if let Some((sender, thread)) = self.lines.take() {
            drop(sender);
            // It ends at once.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_how_long_it_will_take() {
        let text = line(3, 12, "frames", Duration::from_secs(6));
        assert_eq!(text, "3 of 12 frames in 6 s, about 18 s left");
    }
}
