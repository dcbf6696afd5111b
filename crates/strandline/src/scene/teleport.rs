//! Marks of motions.

use strandline_base::settings;

settings! {
    /// A mark of a motion: there the body is elsewhere at once, and hair is carried with it instead of being pulled.
    pub struct TeleportSection {
        /// Time of the motion. Between its samples on both sides of a mark nothing is interpolated.
        time: f64 = 0.0, required true, in [-1e6, 1e6] "s";
    }
}

impl TeleportSection {
    /// Times of marks \[s\].
    pub(crate) fn times(marks: &[Self]) -> Vec<f64> {
        marks.iter().map(|mark| mark.time).collect()
    }
}
