//! Settings that were found.

use strandline::edit::Found;

/// The words that are looked for, and the settings that were found.
#[derive(Default)]
pub struct Finding {
    pub words: String,
    pub looked_for: String,
    pub found: Vec<Found>,
    /// The value that is being dragged or typed, by its key.
    pub edited: Option<(String, Edited)>,
}

/// A value that is being dragged or typed.
#[derive(Clone)]
pub enum Edited {
    Number(f64),
    Text(String),
}
