use crate::Adapter;

/// Why a GPU could not do what was asked.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter that would do.
    #[error("no {wanted} was found{}; install a Vulkan driver or use the CPU backend", found(.offered))]
    NoAdapter {
        /// What was looked for.
        wanted: String,
        /// What there is.
        offered: Vec<Adapter>,
    },
    /// This build has no GPUs.
    #[error("this build is without GPUs: use the CPU backend, or build it with the feature `gpu`")]
    NotBuilt,
    /// The adapter or WebGPU's default limits do not allow it.
    #[error("{adapter}: {what} needs {needed}, but the limit is {limit}")]
    Limit {
        /// The adapter's name.
        adapter: String,
        /// What needs it.
        what: String,
        /// How much it needs.
        needed: u64,
        /// How much may be had.
        limit: u64,
    },
    /// The device is gone.
    #[error("{adapter}: the device was lost: {reason}")]
    Lost {
        /// The adapter's name.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// The adapter has no memory left.
    #[error("{adapter}: out of memory: {what}{} was refused", sized(*bytes))]
    OutOfMemory {
        /// The adapter's name.
        adapter: String,
        /// What was to be stored.
        what: String,
        /// Its size; 0 where the driver does not tell what it lacked.
        bytes: u64,
    },
    /// A shader that the driver does not take.
    #[error("{adapter}: shader module {module}: {message}")]
    Shader {
        /// The adapter's name.
        adapter: String,
        /// The module.
        module: String,
        /// What is wrong, with the line.
        message: String,
    },
    /// Anything else that the device refused.
    #[error("{adapter}: {what}: {message}")]
    Refused {
        /// The adapter's name.
        adapter: String,
        /// What was being done.
        what: String,
        /// What the device says.
        message: String,
    },
}

fn sized(bytes: u64) -> String {
    if bytes == 0 { String::new() } else { format!(" of {bytes} bytes") }
}

fn found(offered: &[Adapter]) -> String {
    if offered.is_empty() {
        return String::new();
    }
    let names: Vec<String> = offered.iter().map(ToString::to_string).collect();
    format!(" among {}", names.join(", "))
}
