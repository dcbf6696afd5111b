//! The error of the reader.

/// Difference between a file and its format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The text or number of the file.
    pub found: String,
    /// The text or number that the format has there.
    pub expected: String,
}

impl Mismatch {
    pub(super) fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { found: found.into(), expected: expected.into() }
    }
}
