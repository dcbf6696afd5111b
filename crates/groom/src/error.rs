use std::path::{Path, PathBuf};

use strandline_base::{SettingError, memory::MemoryError};

/// Why a groom could not be read, written or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GroomError {
    /// A setting outside its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// More memory than may be taken.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// A groom without a strand.
    #[error("the groom has no strand that could be used")]
    Empty,
    /// The bytes violate the format.
    #[error("not a sound {format} file: {found}, expected {expected}; {mend}")]
    Malformed {
        /// The format.
        format: &'static str,
        /// Content that was found, and its place.
        found: String,
        /// Content that was expected there.
        expected: String,
        /// Remedy.
        mend: &'static str,
    },
    /// A strand that cannot be used.
    #[error("strand {strand} {found}, expected {expected}; load it leniently to leave such strands out")]
    Strand {
        /// Its index, from 0.
        strand: usize,
        /// Its fault.
        found: &'static str,
        /// Requirement of a strand.
        expected: &'static str,
    },
    /// A groom that a format cannot hold.
    #[error("a {format} file cannot hold this groom: {found}, expected {expected}; {mend}")]
    CannotHold {
        /// The format.
        format: &'static str,
        /// Content of the groom.
        found: String,
        /// Limit of the format.
        expected: &'static str,
        /// Remedy.
        mend: &'static str,
    },
    /// A file ending that names no format.
    #[error("the ending `{found}` names no groom format, expected {expected}; {mend}: {}", path.display())]
    Ending {
        /// The ending.
        found: String,
        /// The endings of the formats.
        expected: String,
        /// The way in.
        mend: &'static str,
        /// The file.
        path: PathBuf,
    },
    /// A format that is only read.
    #[error(".{ending} files are read, not written; expected {expected}: {}", path.display())]
    NotWritten {
        /// The ending.
        ending: &'static str,
        /// The endings of formats that are written.
        expected: String,
        /// The file.
        path: PathBuf,
    },
    /// A file could not be opened, read or written.
    #[error("cannot {action} the groom: {source}: {}", path.display())]
    File {
        /// "read" or "write".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// Error in the content of a file.
    #[error("{source}: {}", path.display())]
    In {
        /// The file.
        path: PathBuf,
        /// The error.
        source: Box<GroomError>,
    },
}

impl GroomError {
    /// Adds the path to an error about content, unless it has one.
    pub(crate) fn of(self, path: &Path) -> Self {
        match self {
            Self::In { .. } => self,
            error => Self::In { path: path.to_owned(), source: Box::new(error) },
        }
    }
}
