//! How long something takes.

use std::time::{Duration, Instant};

/// Measures time. In a browser page, where the standard library has no clock, no time passes.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    last: Option<Instant>,
}

impl Stopwatch {
    /// Begins to measure.
    pub fn start() -> Self {
        let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
        Self { last: has_clock.then(Instant::now) }
    }

    /// Time since the start or the last lap.
    pub fn elapsed(&self) -> Duration {
        self.last.map_or(Duration::ZERO, |last| last.elapsed())
    }

    /// Seconds since the start or the last lap.
    pub fn seconds(&self) -> f64 {
        self.elapsed().as_secs_f64()
    }

    /// Ends a lap and begins the next: the lap's seconds.
    pub fn lap(&mut self) -> f64 {
        let next = Self::start();
        let ended = next.last.zip(self.last).map_or(0.0, |(end, begin)| (end - begin).as_secs_f64());
        *self = next;
        ended
    }
}

/// Runs a stage and notes how long it took \[s\].
pub fn timed<T>(seconds: &mut Vec<(&'static str, f64)>, stage: &'static str, run: impl FnOnce() -> T) -> T {
    let watch = Stopwatch::start();
    let result = run();
    seconds.push((stage, watch.seconds()));
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laps_are_parts_of_the_time() {
        let (whole, mut watch) = (Stopwatch::start(), Stopwatch::start());
        std::thread::sleep(Duration::from_millis(2));
        let first = watch.lap();
        assert!(first >= 2e-3);
        assert!(watch.seconds() <= whole.seconds() - first);
        let mut seconds = Vec::new();
        assert_eq!(timed(&mut seconds, "stage", || 3), 3);
        assert_eq!(seconds[0].0, "stage");
        assert!(seconds[0].1 < whole.seconds());
    }
}
