use crate::Adapter;

/// Errors of a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter that would do.
    #[error("no {wanted} was found{}; install a Vulkan driver or use the CPU backend", found(.offered))]
    NoAdapter {
        /// Adapter that was requested.
        wanted: String,
        /// Adapters of the machine.
        offered: Vec<Adapter>,
    },
    /// This build has no GPUs.
    #[error("this build is without GPUs: use the CPU backend, or build it with the feature `gpu`")]
    NotBuilt,
    /// A page opens no device without waiting for it.
    #[error("a page cannot wait for a GPU: await `Gpu::request`")]
    Page,
    /// The call would wait for the device, and the host never waits ([`crate::Gpu::never_wait`]).
    #[error(
        "{what} would wait for {adapter}, and this host never waits: ask for it, and take it when it has arrived"
    )]
    WouldWait {
        /// The adapter's name.
        adapter: String,
        /// Wanted data.
        what: String,
    },
    /// The adapter or WebGPU's default limits do not allow it.
    #[error("{adapter}: {what} needs {needed}, but the limit is {limit}")]
    Limit {
        /// The adapter's name.
        adapter: String,
        /// Part of the run that needs it.
        what: String,
        /// Amount that it needs.
        needed: u64,
        /// Limit of the device.
        limit: u64,
    },
    /// The device is gone.
    #[error("{adapter}: the device was lost: {reason}")]
    Lost {
        /// The adapter's name.
        adapter: String,
        /// Message of the driver.
        reason: String,
    },
    /// The adapter has no memory left.
    #[error("{adapter}: out of memory: {what}{} was refused", sized(*bytes))]
    OutOfMemory {
        /// The adapter's name.
        adapter: String,
        /// Data to be stored.
        what: String,
        /// Its size; 0 if the driver does not name it.
        bytes: u64,
    },
    /// A shader that the driver does not take.
    #[error("{adapter}: shader module {module}: {message}")]
    Shader {
        /// The adapter's name.
        adapter: String,
        /// The module.
        module: String,
        /// Error, with its line.
        message: String,
    },
    /// Anything else that the device refused.
    #[error("{adapter}: {what}: {message}")]
    Refused {
        /// The adapter's name.
        adapter: String,
        /// Operation that failed.
        what: String,
        /// Message of the device.
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
