//! Problems of files.

/// Problem of a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileProblem {
    /// The system cannot read it.
    #[error(transparent)]
    Read(#[from] std::io::Error),
    /// Its content is not as expected: what was found and what was expected.
    #[error("{0}")]
    Content(String),
}

impl From<String> for FileProblem {
    fn from(found: String) -> Self {
        Self::Content(found)
    }
}

impl From<&str> for FileProblem {
    fn from(found: &str) -> Self {
        Self::Content(found.to_owned())
    }
}
