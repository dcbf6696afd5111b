/// Turns the time of frames into whole steps, so that results do not depend on the frame rate.
///
/// A time step of single precision stands for the simplest fraction that rounds to it: 1/60 is a
/// sixtieth of a second, not 2e-9 s more, so that three seconds have 180 steps.
/// Sample the motion of the head and the wind at [`Clock::step_time`] of every step that is due.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    time_step: f64,
    /// Time \[s\] at the start of step 0.
    start: f64,
    /// Time that has passed \[s\], and what its sums have lost to rounding.
    time: f64,
    lost: f64,
    steps: u64,
}

/// Steps of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ticks {
    /// Index of the first step that is due; the step ends at `step_time(first + 1)`.
    pub first: u64,
    /// Steps that are due.
    pub count: u32,
    /// Place of the frame between the last two states: 0 one step ago, 1 at the last step.
    pub share: f32,
}

/// A frame that ends this part of a step before a step does, a rounding error, has that step too.
const SLACK: f64 = 1e-6;

/// Longest time \[s\] of a clock that is read from a file: some 30 years.
const MOST_SECONDS: f64 = 1e9;

impl Clock {
    /// A clock at time 0 for steps of `time_step` \[s\].
    pub fn new(time_step: f32) -> Self {
        Self { time_step: simplest(time_step), start: 0.0, time: 0.0, lost: 0.0, steps: 0 }
    }

    /// Makes steps of another length \[s\], which are counted from 0, from the end of the last one on.
    pub fn set_time_step(&mut self, time_step: f32) {
        (self.start, self.steps) = (self.step_time(self.steps), 0);
        self.time_step = simplest(time_step);
    }

    /// Time \[s\] at the start of a step.
    pub fn step_time(&self, step: u64) -> f64 {
        self.start + step as f64 * self.time_step
    }

    /// Time \[s\] that has passed.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Length of a step \[s\].
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Lets the time of a frame \[s\] pass; time that is negative or not finite does not.
    pub fn advance(&mut self, frame_seconds: f64) -> Ticks {
        if frame_seconds.is_finite() && frame_seconds > 0.0 {
            // The rounding error of a sum is added to the next one [Kahan1965].
            let add = frame_seconds + self.lost;
            let sum = self.time + add;
            self.lost = add - (sum - self.time);
            self.time = sum;
        }
        self.ticks()
    }

    /// Lets time pass until `time` \[s\]; a time that is past or not finite changes nothing. The last step that is due
    /// ends at that time or reaches beyond it.
    pub fn reach(&mut self, time: f64) -> Ticks {
        if time.is_finite() && time > self.time {
            (self.time, self.lost) = (time, 0.0);
        }
        let (first, count) = self.make((self.passed() - SLACK).ceil());
        let share = 1.0 - (self.step_time(self.steps) - self.time) / self.time_step;
        Ticks { first, count, share: if self.is_at_step() { 1.0 } else { share.clamp(0.0, 1.0) as f32 } }
    }

    /// Sets a clock to a time \[s\] of a run that made a number of steps: with [`Clock::reach`] if the last step ends
    /// beyond that time, else with [`Clock::advance`]. Returns the clock and the share of the way between the last two
    /// states, 0 to 1.
    pub fn resumed(time_step: f32, time: f64, steps: u64) -> (Self, f32) {
        let mut clock = Self::new(time_step);
        let reached = clock.reach(time);
        if u64::from(reached.count) == steps || clock.is_at_step() {
            return (clock, reached.share);
        }
        clock = Self::new(time_step);
        let share = clock.advance(time).share;
        (clock, share)
    }

    /// The numbers of a clock, for a file: length of a step, start, time, lost time \[s\], and steps.
    pub fn numbers(&self) -> ([f64; 4], u64) {
        ([self.time_step, self.start, self.time, self.lost], self.steps)
    }

    /// The clock with these [`Clock::numbers`]; `None` where they are those of no clock.
    pub fn of_numbers([time_step, start, time, lost]: [f64; 4], steps: u64) -> Option<Self> {
        let is_sound = time_step.is_finite()
            && time_step > 0.0
            && [start, time].iter().all(|time| (0.0..MOST_SECONDS).contains(time))
            && lost.abs() <= time_step
            && steps as f64 * time_step < MOST_SECONDS;
        is_sound.then_some(Self { time_step, start, time, lost, steps })
    }

    /// True where the time is the end of a step, but for rounding.
    pub fn is_at_step(&self) -> bool {
        (self.time - self.step_time(self.steps)).abs() <= SLACK * self.time_step
    }

    /// Steps that fit into the time that has passed.
    fn passed(&self) -> f64 {
        (self.time - self.start) / self.time_step
    }

    /// The steps that end in the time that has passed.
    fn ticks(&mut self) -> Ticks {
        let (first, count) = self.make((self.passed() + SLACK).floor());
        let over = self.time - self.step_time(self.steps);
        Ticks { first, count, share: (over / self.time_step).clamp(0.0, 1.0) as f32 }
    }

    /// Counts steps up to `due`: the first of them, and their number.
    fn make(&mut self, due: f64) -> (u64, u32) {
        let first = self.steps;
        let count = u32::try_from((due as u64).saturating_sub(first)).unwrap_or(u32::MAX);
        self.steps += u64::from(count);
        (first, count)
    }
}

/// The first continued fraction of a number, 0 to 1, that rounds to it in single precision.
fn simplest(number: f32) -> f64 {
    let exact = f64::from(number);
    let ([mut above, mut below], [mut last_above, mut last_below]) = ([0.0_f64, 1.0], [1.0_f64, 0.0]);
    let mut rest = exact;
    // Denominators grow by the golden ratio at least: 24 turns pass all that single precision tells apart.
    for _ in 0..24 {
        if above > 0.0 && (above / below) as f32 == number {
            return above / below;
        }
        if rest.fract() == 0.0 {
            break;
        }
        rest = 1.0 / rest.fract();
        let whole = rest.floor();
        (above, last_above) = (whole * above + last_above, above);
        (below, last_below) = (whole * below + last_below, below);
    }
    exact
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_rate_makes_the_same_number_of_steps() {
        for rate in [24.0, 30.0, 60.0, 144.0] {
            let mut clock = Clock::new(1.0 / 64.0);
            let mut steps = 0;
            for _ in 0..(10.0 * rate) as usize {
                let ticks = clock.advance(1.0 / rate);
                assert_eq!(ticks.first, steps);
                steps += u64::from(ticks.count);
                assert!((0.0..=1.0).contains(&ticks.share));
            }
            assert_eq!(steps, 640, "{rate} frames/s");
        }
    }

    #[test]
    fn a_time_has_exactly_its_steps() {
        // Steps of a second, and how the step is written.
        let steps =
            [(60, 1.0 / 60.0), (1000, 1e-3), (960, 1.0 / 960.0), (7, 1.0 / 7.0), (10, 0.1), (400, 0.0025)];
        for (each_second, time_step) in steps {
            for rate in [1.0, 5.0, 24.0, 29.0, 30.0, 60.0, 144.0] {
                let (mut added, mut reached) = (Clock::new(time_step), Clock::new(time_step));
                let mut counts = [0; 2];
                for frame in 1..=3600 * rate as u32 {
                    counts[0] += added.advance(1.0 / rate).count;
                    counts[1] += reached.reach(f64::from(frame) / rate).count;
                    if f64::from(frame) == 3.0 * rate {
                        assert_eq!(counts, [3 * each_second; 2], "{time_step} s at {rate} frames/s");
                    }
                }
                assert_eq!(counts, [3600 * each_second; 2], "an hour of {time_step} s at {rate} frames/s");
            }
        }
    }

    #[test]
    fn a_step_stands_for_the_simplest_fraction() {
        assert_eq!(simplest(1.0 / 60.0), 1.0 / 60.0);
        assert_eq!(simplest(0.013), 0.013);
        assert_eq!(simplest(1e-5), 1e-5);
        assert_eq!(simplest(0.0625), 0.0625);
        for number in [0.016_123_4_f32, 0.099_999_994, 1.234_567_8e-5, 0.0] {
            assert_eq!(simplest(number) as f32, number);
        }
    }

    #[test]
    fn a_late_frame_makes_all_its_steps() {
        let mut clock = Clock::new(1.0 / 60.0);
        assert_eq!(clock.advance(100.0), Ticks { first: 0, count: 6000, share: 0.0 });
        assert_eq!(clock.advance(0.0).count, 0);
        assert_eq!(clock.advance(f64::NAN).count, 0);
        assert_eq!(clock.advance(-1.0).count, 0);
        assert_eq!(clock.reach(99.0).count, 0);
        assert_eq!(clock.reach(101.0).count, 60);
    }

    #[test]
    fn a_time_that_is_reached_lies_between_its_two_last_states() {
        let mut clock = Clock::new(0.1);
        for (time, count, share) in
            [(0.2, 2, 1.0), (0.25, 1, 0.5), (0.29, 0, 0.9), (0.3, 0, 1.0), (0.51, 3, 0.1)]
        {
            let ticks = clock.reach(time);
            assert_eq!(ticks.count, count, "{time} s");
            assert!((ticks.share - share).abs() < 1e-5, "{ticks:?} at {time} s");
            assert_eq!(clock.is_at_step(), share == 1.0);
        }
        assert_eq!(clock.reach(0.51), Ticks { first: 6, ..clock.reach(0.51) });
    }

    #[test]
    fn a_resumed_clock_has_the_steps_that_were_made() {
        // Between two steps a film has made the next one, a loop of one's own has not.
        for (steps, share) in [(3, 0.5), (2, 0.5), (7, 0.5)] {
            let (mut clock, found) = Clock::resumed(0.1, 0.25, steps);
            assert!((found - share).abs() < 1e-5, "{found}");
            assert_eq!(clock.reach(0.3).first, if steps == 3 { 3 } else { 2 });
        }
        assert_eq!(Clock::resumed(0.1, 0.3, 3).1, 1.0);
    }

    #[test]
    fn no_time_is_lost_where_steps_change_their_length() {
        let mut clock = Clock::new(0.1);
        assert_eq!(clock.advance(0.25).count, 2);
        clock.set_time_step(0.02);
        // 0.05 s are left over.
        assert_eq!(clock.advance(0.01), Ticks { first: 0, count: 3, share: 0.0 });
        assert!((clock.step_time(3) - 0.26).abs() < 1e-15);
    }
}
