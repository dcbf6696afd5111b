use std::path::PathBuf;

use strandline_base::SettingError;

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
    #[error("cannot read the surroundings: {reason}: {}", path.display())]
    Surroundings {
        /// Content found and content expected.
        reason: String,
        /// The file.
        path: PathBuf,
    },
    /// A picture could not be written.
    #[error("cannot write the picture: {reason}: {}", path.display())]
    Save {
        /// Error and remedy.
        reason: String,
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
