//! The part of a timeline that is played, and how fast.

use std::time::Duration;

/// Pace at which frames follow each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pace {
    /// Every frame as soon as it is there.
    #[default]
    EveryFrame,
    /// As time passes: frames wait for their time, and kept ones are passed over while pictures take longer.
    OwnSpeed,
}

/// The part that is played.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Range {
    /// First and last frame; without them those of the film.
    pub marks: [Option<u32>; 2],
    /// True where the first follows the last.
    pub loops: bool,
    pub pace: Pace,
    /// Time \[s\] of the clock at which the next frame is due.
    pub due: Duration,
}

impl Range {
    /// All of a film, every frame.
    pub const START: Self =
        Self { marks: [None; 2], loops: false, pace: Pace::EveryFrame, due: Duration::ZERO };

    /// Number of the frame that follows one at a time of the clock; `film_end` is the last of the film, and `is_kept` tells
    /// whether a frame need not be simulated.
    pub fn next(
        &self,
        playhead: u32,
        film_end: u32,
        rate: f64,
        now: Duration,
        is_kept: impl Fn(u32) -> bool,
    ) -> u32 {
        let first = self.marks[0].unwrap_or(0);
        let last = self.marks[1].unwrap_or(film_end).max(first);
        if self.loops && playhead >= last {
            return first;
        }
        let late = match self.pace {
            Pace::EveryFrame => 0,
            Pace::OwnSpeed => (now.saturating_sub(self.due).as_secs_f64() * rate) as u32,
        };
        let end = if self.loops { last } else { u32::MAX };
        let next = playhead.saturating_add(1);
        // Frames that must be simulated are not passed over.
        let passed = (1..=late).take_while(|late| next + late <= end && is_kept(next + late)).count();
        next + passed as u32
    }

    /// Notes that so many frames passed at a time of the clock. Time that was lost is not made up.
    pub fn pass(&mut self, frames: u32, rate: f64, now: Duration) {
        let frame = Duration::from_secs_f64(1.0 / rate);
        let next = self.due + frame * frames;
        self.due = if now > next { now + frame } else { next };
    }

    /// Time until the next frame is due.
    pub fn wait(&self, now: Duration) -> Duration {
        match self.pace {
            Pace::EveryFrame => Duration::ZERO,
            Pace::OwnSpeed => self.due.saturating_sub(now),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Duration = Duration::from_millis(40);

    #[test]
    fn frames_wait_for_their_time_and_kept_ones_are_passed_over() {
        let mut range = Range { pace: Pace::OwnSpeed, ..Range::default() };
        assert_eq!(range.next(3, 100, 25.0, Duration::ZERO, |_| true), 4);
        range.pass(1, 25.0, Duration::ZERO);
        assert_eq!(range.wait(Duration::ZERO), FRAME);
        // Three frames late: those are passed over, unless they must be simulated.
        assert_eq!(range.next(4, 100, 25.0, 4 * FRAME, |_| true), 8);
        assert_eq!(range.next(4, 100, 25.0, 4 * FRAME, |number| number < 7), 6);
        assert_eq!(range.next(4, 100, 25.0, 4 * FRAME, |_| false), 5);
        range.pass(4, 25.0, 4 * FRAME);
        assert_eq!(range.wait(4 * FRAME), FRAME);
        range.pass(1, 25.0, 9 * FRAME);
        assert_eq!(range.wait(9 * FRAME), FRAME, "time that was lost is not made up");
        range.pace = Pace::EveryFrame;
        assert_eq!(range.next(4, 100, 25.0, 90 * FRAME, |_| true), 5);
        assert_eq!(range.wait(Duration::ZERO), Duration::ZERO);
    }

    #[test]
    fn the_first_frame_follows_the_last_where_it_loops() {
        let mut range = Range { marks: [Some(10), Some(20)], ..Range::default() };
        let next = |range: &Range, at| range.next(at, 100, 25.0, Duration::ZERO, |_| true);
        assert_eq!(next(&range, 20), 21, "it goes on");
        range.loops = true;
        assert_eq!([9, 19, 20, 33].map(|at| next(&range, at)), [10, 20, 10, 10]);
        range.marks = [None, None];
        assert_eq!([99, 100].map(|at| next(&range, at)), [100, 0]);
        range.marks = [Some(30), Some(5)];
        assert_eq!(next(&range, 30), 30, "a range of one frame");
    }
}
