//! Elapsed time.

use std::time::{Duration, Instant};

/// Measures time. In a browser page, where the standard library has no clock, no time passes.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    begin: Option<Instant>,
}

impl Stopwatch {
    /// Begins to measure.
    pub fn start() -> Self {
        let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
        Self { begin: has_clock.then(Instant::now) }
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.begin.map_or(Duration::ZERO, |begin| begin.elapsed())
    }

    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        self.elapsed().as_secs_f64()
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
    fn a_stage_is_part_of_the_time() {
        let (whole, mut seconds) = (Stopwatch::start(), Vec::new());
        let stage = || {
            std::thread::sleep(Duration::from_millis(2));
            3
        };
        assert_eq!(timed(&mut seconds, "stage", stage), 3);
        let [(name, took)] = seconds[..] else { panic!("one stage") };
        assert!(name == "stage" && took >= 2e-3 && took <= whole.seconds());
    }
}
