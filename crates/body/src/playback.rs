//! The time of a motion at a time of the scene.

/// Time of a motion at a time of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Time of the motion at the time 0 of the scene \[s\].
    pub start: f64,
    /// Seconds of the motion in a second of the scene.
    pub speed: f64,
    /// Begins again after its end.
    pub is_loop: bool,
}

impl Default for Playback {
    fn default() -> Self {
        Self { start: 0.0, speed: 1.0, is_loop: false }
    }
}

impl Playback {
    /// Time \[s\] of a motion that ends at `end` \[s\], at a time of the scene \[s\].
    pub fn time(&self, time: f64, end: f64) -> f64 {
        let time = self.start + self.speed * time;
        let time = if self.is_loop && end > 0.0 { time.rem_euclid(end) } else { time };
        if time.is_finite() { time } else { 0.0 }
    }

    /// True where a motion that ends at `end` \[s\] begins again at some time.
    pub(crate) fn is_round(&self, end: f64) -> bool {
        self.is_loop && self.speed != 0.0 && end > 0.0
    }

    /// Number of times that the motion has begun again.
    pub(crate) fn rounds(&self, time: f64, end: f64) -> f64 {
        let is_round = self.is_loop && end > 0.0;
        let time = self.start + self.speed * time;
        // Of the same remainder as the time: their quotient alone may round to the next whole number.
        if is_round { ((time - time.rem_euclid(end)) / end).round() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn playback_starts_goes_on_and_begins_again() {
        let playback = Playback { start: 0.5, speed: 2.0, is_loop: true };
        assert_eq!([0.0, 0.5, 1.0].map(|time| playback.time(time, 2.0)), [0.5, 1.5, 0.5]);
        assert_eq!(Playback { speed: -1.0, ..playback }.time(1.0, 2.0), 1.5);
        assert_eq!(Playback { is_loop: false, ..playback }.time(5.0, 2.0), 10.5);
        assert_eq!(playback.time(f64::NAN, 2.0), 0.0);
    }

    #[test]
    fn rounds_and_time_belong_together() {
        let playback = Playback { start: 0.0, speed: 1.0, is_loop: true };
        for end in [0.1, 2.0 / 24.0, 0.04 * 7.0, 1.0 / 3.0] {
            for step in [1.0 / 24.0, 0.04, end] {
                for frame in 0..1000 {
                    let time = f64::from(frame) * step;
                    let [rounds, within] = [playback.rounds(time, end), playback.time(time, end)];
                    assert!((rounds * end + within - time).abs() < 1e-9, "{end} {time}: {rounds} {within}");
                }
            }
        }
    }

    #[test]
    fn motions_stand_still_run_backward_and_may_have_no_length() {
        let playback = Playback { start: 0.5, speed: 0.0, is_loop: true };
        assert_eq!([0.0, 3.0, 1e300].map(|time| playback.time(time, 2.0)), [0.5; 3]);
        assert_eq!(playback.rounds(1e9, 2.0), 0.0);
        let backward = Playback { start: 0.0, speed: -1.0, is_loop: true };
        assert_eq!([playback.is_round(2.0), backward.is_round(2.0), backward.is_round(0.0)], [false, true, false]);
        assert_eq!([0.5, 2.0, 2.5].map(|time| backward.time(time, 2.0)), [1.5, 0.0, 1.5]);
        assert_eq!([0.5, 2.5].map(|time| backward.rounds(time, 2.0)), [-1.0, -2.0]);
        let held = Playback { is_loop: false, ..backward };
        assert_eq!(held.time(3.0, 2.0), -3.0, "before its beginning a motion is held there");
        // A pose alone: nothing begins again.
        assert_eq!((backward.time(3.0, 0.0), backward.rounds(3.0, 0.0)), (-3.0, 0.0));
        let far = Playback { start: 1e300, speed: 1e300, is_loop: true };
        assert!((0.0..=2.0).contains(&far.time(1e300, 2.0)));
    }
}
