//! Marks of a motion at which the body is elsewhere at once.

use crate::BodyError;

/// Times of marks \[s\], rising and finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Teleports(Vec<f64>);

impl Teleports {
    /// Marks in any order, those at one time once.
    ///
    /// # Errors
    /// Times that are not finite.
    pub fn new(times: &[f64]) -> Result<Self, BodyError> {
        if let Some(time) = times.iter().find(|time| !time.is_finite()) {
            let (what, found) = ("the time of a teleport", time.to_string());
            return Err(BodyError::Value { what, found, expected: "a finite time of the motion [s]" });
        }
        let mut times = times.to_vec();
        times.sort_by(f64::total_cmp);
        times.dedup();
        Ok(Self(times))
    }

    pub fn times(&self) -> &[f64] {
        &self.0
    }

    /// Of two samples of a motion with a mark between them the one that counts at a time between them: the earlier one
    /// until the mark, then the later one. `None` without a mark: the motion is interpolated.
    pub fn is_after(&self, [from, to]: [f64; 2], time: f64) -> Option<bool> {
        let mark = self.0.get(self.0.partition_point(|mark| *mark <= from)).filter(|mark| **mark <= to)?;
        Some(time >= *mark)
    }

    /// True where a motion that ends at `end` \[s\] begins again behind a mark: one at its beginning, its end or beyond them.
    pub fn are_at_ends(&self, end: f64) -> bool {
        self.0.first().is_some_and(|mark| *mark <= 0.0) || self.0.last().is_some_and(|mark| *mark >= end)
    }

    /// Number of marks up to a time; of a motion that has gone round `rounds` times those of all rounds.
    pub fn passed(&self, time: f64, rounds: f64) -> i64 {
        let rounds = if rounds.is_finite() { rounds as i64 } else { 0 };
        let all = rounds.saturating_mul(self.0.len() as i64);
        all.saturating_add(self.0.partition_point(|mark| *mark <= time) as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_divides_the_way_between_two_samples() {
        let marks = Teleports::new(&[2.5, 1.0, 1.0]).unwrap();
        assert_eq!(marks.times(), [1.0, 2.5]);
        for (span, time, expected) in [
            ([0.0, 1.0], 0.999, Some(false)),
            ([0.0, 1.0], 1.0, Some(true)),
            ([1.0, 2.0], 1.5, None),
            ([2.0, 3.0], 2.4, Some(false)),
            ([2.0, 3.0], 2.5, Some(true)),
            ([3.0, 4.0], 3.5, None),
        ] {
            assert_eq!(marks.is_after(span, time), expected, "{span:?} at {time}");
        }
        assert_eq!([0.0, 1.0, 2.0, 9.0].map(|time| marks.passed(time, 0.0)), [0, 1, 1, 2]);
        assert_eq!([marks.passed(0.0, 3.0), marks.passed(1.0, -1.0)], [6, -1]);
        assert_eq!([3.0, 2.5, 2.0].map(|end| marks.are_at_ends(end)), [false, true, true]);
        assert!(Teleports::new(&[0.0]).unwrap().are_at_ends(9.0) && !Teleports::default().are_at_ends(9.0));
        let error = Teleports::new(&[f64::NAN]).unwrap_err().to_string();
        assert!(error.contains("the time of a teleport"), "{error}");
    }
}
