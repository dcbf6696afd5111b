//! Points that are not finite: the run continues with their strands at rest, reports it, and ends with code 3.

use std::fmt;

use serde::Serialize;
use strandline::StepReport;
use strandline::file::counted;

/// The points of a run that were not finite.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NonFinite {
    /// The most in a step.
    #[serde(rename = "non_finite")]
    pub points: usize,
    /// The first place.
    #[serde(rename = "non_finite_first", skip_serializing_if = "Option::is_none")]
    pub first: Option<First>,
}

/// The first place of points that were not finite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct First {
    /// The frame, from 0.
    pub frame: u32,
    /// The strand, from 0; a GPU does not tell.
    pub strand: Option<usize>,
}

impl fmt::Display for First {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "frame {}", self.frame)?;
        self.strand.map_or(Ok(()), |strand| write!(f, ", strand {strand}"))
    }
}

impl NonFinite {
    /// Adds a step of a frame; the first time there is something to say, says it.
    pub fn add(&mut self, report: &StepReport, frame: u32) -> Option<String> {
        self.points = self.points.max(report.non_finite);
        if report.non_finite == 0 || self.first.is_some() {
            return None;
        }
        let first = First { frame, strand: report.non_finite_strand };
        self.first = Some(first);
        Some(format!(
            "{first}: {} not finite; strands that have them go back to rest",
            counted(report.non_finite, "point is", "points are")
        ))
    }

    /// Result of the run.
    ///
    /// # Errors
    /// There were such points.
    pub fn outcome(&self) -> Result<(), NotFinite> {
        self.first.map_or(Ok(()), |first| Err(NotFinite { points: self.points, first }))
    }
}

/// A run of which some points were not finite; ends with code 3.
#[derive(Debug, thiserror::Error)]
#[error(
    "at most {}, first in {first}; strands that had them went back to rest: \
     look for extreme values in the scene, its groom and its body",
    counted(*points, "point was not finite", "points were not finite")
)]
pub struct NotFinite {
    points: usize,
    first: First,
}

/// The larger of two numbers; unlike a maximum it keeps NaN.
pub fn larger(one: f32, other: f32) -> f32 {
    if other > one || other.is_nan() { other } else { one }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_kept() {
        assert_eq!(larger(1.0, 2.0), 2.0);
        assert!(larger(f32::NAN, 2.0).is_nan() && larger(2.0, f32::NAN).is_nan());
    }

    #[test]
    fn the_first_is_said_once_and_the_end_is_an_error() {
        let bad =
            |non_finite, strand| StepReport { non_finite, non_finite_strand: strand, ..Default::default() };
        let mut found = NonFinite::default();
        assert_eq!(found.add(&bad(0, None), 3), None);
        found.outcome().unwrap();
        let note = found.add(&bad(2, Some(17)), 4).unwrap();
        assert!(note.starts_with("frame 4, strand 17: 2 points are not finite"), "{note}");
        assert_eq!(found.add(&bad(5, None), 6), None);
        let error = found.outcome().unwrap_err().to_string();
        assert!(
            error.starts_with("at most 5 points were not finite, first in frame 4, strand 17"),
            "{error}"
        );
        let json = serde_json::to_string(&found).unwrap();
        assert_eq!(json, r#"{"non_finite":5,"non_finite_first":{"frame":4,"strand":17}}"#);
    }
}
