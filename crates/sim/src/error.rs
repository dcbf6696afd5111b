use strandline_base::SettingError;

/// Why a solver could not be made or a state changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A setting outside its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A rest shape that does not fit its guides.
    #[error("the rest shape has {found}, expected {expected}")]
    Rest {
        /// What was given.
        found: String,
        /// What fits.
        expected: &'static str,
    },
    /// What the GPU could not do.
    #[error(transparent)]
    Gpu(#[from] strandline_gpu::GpuError),
}
