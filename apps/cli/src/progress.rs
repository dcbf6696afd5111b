//! A progress bar for anything longer than a second; none without a terminal.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output;

/// Delay after which a bar is shown.
const PATIENCE: Duration = Duration::from_secs(1);

/// Shows how far something has come, how fast it is, and how long it will take.
pub struct Progress {
    begin: Instant,
    total: u64,
    what: &'static str,
    bar: Option<ProgressBar>,
    watched: bool,
}

impl Progress {
    /// Begins to count to `total` of `what`; `quiet` shows nothing.
    pub fn new(total: u64, what: &'static str, quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        Self { begin: Instant::now(), total, what, bar: None, watched }
    }

    /// Says something without tearing the bar.
    pub fn note(&self, note: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| output::note(note)),
            None => output::note(note),
        }
    }

    /// `done` are done.
    pub fn reached(&mut self, done: u64) {
        if !self.watched {
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
pub struct Waiting(Option<ProgressBar>);

impl Waiting {
    /// Begins; nothing is shown without a terminal.
    pub fn begin(what: &'static str) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(None);
        }
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(what);
        bar.enable_steady_tick(PATIENCE);
        Self(Some(bar))
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
