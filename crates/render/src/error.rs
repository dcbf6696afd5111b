use std::io::ErrorKind;
use std::path::PathBuf;

use strandline_base::{FileProblem, SettingError};

/// Why a picture could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A setting outside its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A body that cannot be drawn.
    #[error(transparent)]
    Body(#[from] strandline_body::BodyError),
    /// More memory than a picture may take.
    #[error(
        "{what} would take {needed} MiB, more than the {allowed} MiB that a picture may take: \
         choose a smaller size or supersampling 1"
    )]
    Memory {
        /// Setting of the request.
        what: String,
        /// Memory that it needs \[MiB\].
        needed: u64,
        /// Allowed memory \[MiB\].
        allowed: u64,
    },
    /// More memory than a run may take.
    #[error(transparent)]
    TooMuch(#[from] strandline_base::memory::MemoryError),
    /// More than a GPU draws; the CPU knows no such limit.
    #[error("{found} {what}, at most {most} are drawn on a GPU: take fewer, or draw on the CPU")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// Number given.
        found: usize,
        /// Largest number.
        most: usize,
    },
    /// Whatever the GPU refuses.
    #[error(transparent)]
    Gpu(#[from] strandline_gpu::GpuError),
    /// A picture of the surroundings could not be read.
    #[error("cannot read the surroundings: {problem}: {}", path.display())]
    Surroundings {
        /// The problem.
        problem: FileProblem,
        /// The file.
        path: PathBuf,
    },
    /// A picture could not be written.
    #[error("cannot write the picture: {}: {}", remedy(source), path.display())]
    Save {
        /// The system's error.
        source: std::io::Error,
        /// Path of the file.
        path: PathBuf,
    },
}

impl RenderError {
    /// True for errors of the GPU, which the CPU may avoid.
    pub fn is_of_gpu(&self) -> bool {
        matches!(self, Self::Gpu(_) | Self::TooMany { .. })
    }
}

/// Error of writing a file, with its remedy, human-readable.
fn remedy(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "the folder does not exist, create it first".into(),
        ErrorKind::PermissionDenied => "no permission to write there, choose another folder".into(),
        ErrorKind::NotADirectory => "its folder is a file, choose another folder".into(),
        ErrorKind::StorageFull => "the disk is full, make room or choose another folder".into(),
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only, choose another folder".into(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_reported_with_its_remedy_and_keeps_its_kind() {
        let error = RenderError::Save { source: ErrorKind::StorageFull.into(), path: "a.png".into() };
        assert_eq!(
            error.to_string(),
            "cannot write the picture: the disk is full, make room or choose another folder: a.png"
        );
        let RenderError::Save { source, .. } = error else { panic!("{error}") };
        assert_eq!(source.kind(), ErrorKind::StorageFull);
    }
}
