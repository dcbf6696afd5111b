/// Why a groom could not be read, written or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GroomError {
    /// A setting outside its range.
    #[error("{name} is {found}, expected {expected}")]
    Setting {
        /// The setting.
        name: &'static str,
        /// What was given.
        found: String,
        /// The range.
        expected: &'static str,
    },
    /// A groom without a strand.
    #[error("the groom has no strand that could be used")]
    Empty,
}
