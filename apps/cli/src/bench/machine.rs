use serde::Serialize;

/// What the measurements were made on.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// Name of the processor, where the system tells it.
    pub cpu: String,
    /// Threads that can run at once.
    pub threads: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Largest memory that this process held \[MB\], where the system tells it.
    pub peak_memory_mb: Option<f64>,
}

impl Machine {
    /// This machine, now.
    pub fn here() -> Self {
        Self {
            cpu: field("/proc/cpuinfo", "model name").unwrap_or_else(|| "unknown processor".to_owned()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            peak_memory_mb: field("/proc/self/status", "VmHWM")
                .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok())
                .map(|kilobytes| kilobytes * 1024e-6),
        }
    }
}

/// The first `name: value` of a system file; none where there is no such file.
fn field(path: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    text.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == name).then(|| value.trim().to_owned())
    })
}
