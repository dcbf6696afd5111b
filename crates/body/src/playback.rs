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

    /// Times \[s\] of a motion, from the earliest to the latest, between two times of the scene \[s\], without going round.
    pub fn played(&self, film: [f64; 2]) -> [f64; 2] {
        let [one, other] = film.map(|time| self.start + self.speed * time);
        [one.min(other), one.max(other)]
    }

    /// True where a motion with samples from `begin` to `end` \[s\] runs between two times of the scene \[s\], and all of
    /// these lie before its beginning or after its end.
    pub fn misses(&self, film: [f64; 2], [begin, end]: [f64; 2]) -> bool {
        let [mut from, mut until] = self.played(film);
        if self.is_loop && end > 0.0 {
            let length = until - from;
            from = from.rem_euclid(end);
            until = from + length;
        }
        begin < end && from < until && (until <= begin || from >= end)
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
    fn a_motion_outside_of_the_film_is_missed() {
        let late = [41.7, 42.7];
        let plain = Playback::default();
        assert!(plain.misses([0.0, 4.0], late) && !plain.misses([0.0, 42.0], late));
        assert!(!plain.misses([43.0, 43.0], late), "a picture");
        assert!(plain.misses([0.0, 4.0], [-1.0, 0.0]) && !plain.misses([0.0, 4.0], [-1.0, 0.1]));
        assert!(
            !Playback { speed: 0.0, ..plain }.misses([0.0, 4.0], late),
            "it stands still as it is asked to"
        );
        assert!(!Playback { start: 9.0, ..plain }.misses([0.0, 4.0], [3.0, 3.0]), "a pose");
        let backward = Playback { speed: -1.0, ..plain };
        assert!(backward.misses([0.0, 4.0], [0.0, 2.8]), "it begins at its beginning");
        assert!(!Playback { start: 2.8, ..backward }.misses([0.0, 4.0], [0.0, 2.8]));
        let rounds = Playback { is_loop: true, ..plain };
        assert!(rounds.misses([0.0, 4.0], late) && !rounds.misses([0.0, 50.0], late));
        assert!(!Playback { start: 500.0, ..rounds }.misses([0.0, 1.0], [0.0, 2.8]));
        assert!(Playback { start: -1.0, speed: -1.0, ..rounds }.played([0.0, 4.0]) == [-5.0, -1.0]);
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
        assert_eq!(
            [playback.is_round(2.0), backward.is_round(2.0), backward.is_round(0.0)],
            [false, true, false]
        );
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
