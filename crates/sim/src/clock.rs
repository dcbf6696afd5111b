/// Turns the time of frames into whole steps, so that results do not depend on the frame rate.
///
/// Sample the motion of the head at [`Clock::step_time`] of every step that is due.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    time_step: f64,
    left_over: f64,
    steps: u64,
}

/// What a frame has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ticks {
    /// Index of the first step that is due; the step ends at `step_time(first + 1)`.
    pub first: u64,
    /// Steps that are due.
    pub count: u32,
    /// Where the frame lies between the last two states: 0 one step ago, 1 at the last step.
    pub share: f32,
}

impl Clock {
    /// Steps that a frame makes at most; a frame that is later than that slows time down.
    pub const MAX_STEPS: u32 = 16;

    /// A clock at time 0 for steps of `time_step` \[s\].
    pub fn new(time_step: f32) -> Self {
        Self { time_step: f64::from(time_step), left_over: 0.0, steps: 0 }
    }

    /// Time \[s\] at the start of a step.
    pub fn step_time(&self, step: u64) -> f64 {
        step as f64 * self.time_step
    }

    /// Lets the time of a frame \[s\] pass; time that is negative or not finite does not.
    pub fn advance(&mut self, frame_seconds: f64) -> Ticks {
        if frame_seconds.is_finite() && frame_seconds > 0.0 {
            self.left_over += frame_seconds;
        }
        // A frame that ends a rounding error before a step belongs to that step.
        let due = (self.left_over / self.time_step + 1e-6).floor();
        let count = due.min(f64::from(Self::MAX_STEPS)) as u32;
        let kept = if due > f64::from(count) { 0.0 } else { self.left_over - due * self.time_step };
        self.left_over = kept;
        let first = self.steps;
        self.steps += u64::from(count);
        Ticks { first, count, share: (kept / self.time_step).clamp(0.0, 1.0) as f32 }
    }
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
    fn a_late_frame_does_not_pile_up_steps() {
        let mut clock = Clock::new(1.0 / 60.0);
        assert_eq!(clock.advance(100.0).count, Clock::MAX_STEPS);
        assert_eq!(clock.advance(0.0).count, 0);
        assert_eq!(clock.advance(f64::NAN).count, 0);
        assert_eq!(clock.advance(-1.0).count, 0);
    }
}
