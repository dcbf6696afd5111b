//! A progress bar for anything longer than a second; none when nobody watches.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// How long something may take before a bar is shown.
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
            Some(bar) => bar.suspend(|| eprintln!("note: {note}")),
            None => eprintln!("note: {note}"),
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
