use strandline_base::SettingError;

/// Why a model or a runner could not be made or a state changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A setting outside its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A rest shape that does not fit its guides.
    #[error("the rest shape has {found}, expected {expected}")]
    Rest {
        /// Value that was given.
        found: String,
        /// Values that fit.
        expected: &'static str,
    },
    /// A checkpoint of other hair, or one that is damaged.
    #[error("the state that was saved has {found}, expected {expected}: start again")]
    Checkpoint {
        /// Value that it has.
        found: String,
        /// Values that fit.
        expected: String,
    },
    /// A fluid volume that does not fit the GPU.
    #[error(
        "simulation.volume.cells is {} x {} x {}, too many for the GPU ({source}): \
         take fewer, or simulate on the CPU", cells[0], cells[1], cells[2]
    )]
    Cells {
        /// Cells asked for in x, y, z.
        cells: [u32; 3],
        /// The refusal.
        source: strandline_gpu::GpuError,
    },
    /// More memory than may be taken.
    #[error(transparent)]
    Memory(#[from] strandline_base::memory::MemoryError),
    /// An error of the GPU.
    #[error(transparent)]
    Gpu(#[from] strandline_gpu::GpuError),
}

impl SimError {
    /// The GPU's refusal, if it is one.
    pub fn gpu(&self) -> Option<&strandline_gpu::GpuError> {
        match self {
            Self::Gpu(source) | Self::Cells { source, .. } => Some(source),
            _ => None,
        }
    }
}
