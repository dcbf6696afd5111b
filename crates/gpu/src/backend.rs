use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use strandline_base::{Key, Kind, Row, SettingError, Value};

use crate::{Gpu, GpuError};

/// A name that is no backend's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("backend is `{found}`, expected auto, cpu, gpu, or gpu: and a number such as gpu:0")]
pub struct UnknownBackend {
    /// The name.
    pub found: String,
}

/// Device of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Backend {
    /// A hardware GPU if there is one, otherwise the CPU; never a software adapter. When the GPU fails
    /// in the middle of a run, the run falls back to the CPU.
    #[default]
    Auto,
    /// Plain Rust on every core.
    Cpu,
    /// The adapter of this number, or the first: hardware before software.
    Gpu(Option<usize>),
}

impl Backend {
    /// The fastest backend of this machine.
    pub fn auto() -> Self {
        Self::Auto
    }

    /// Opens the device; `None` means the CPU.
    ///
    /// # Errors
    /// A GPU is named and does not exist, or does not start.
    pub fn open(self) -> Result<Option<Gpu>, GpuError> {
        match self {
            Self::Auto => match Gpu::auto() {
                Err(GpuError::NoAdapter { .. } | GpuError::NotBuilt) => Ok(None),
                opened => opened.map(Some),
            },
            Self::Cpu => Ok(None),
            Self::Gpu(None) => Gpu::any().map(Some),
            Self::Gpu(Some(index)) => Gpu::open(index).map(Some),
        }
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Cpu => f.write_str("cpu"),
            Self::Gpu(None) => f.write_str("gpu"),
            Self::Gpu(Some(index)) => write!(f, "gpu:{index}"),
        }
    }
}

impl FromStr for Backend {
    type Err = UnknownBackend;

    fn from_str(name: &str) -> Result<Self, UnknownBackend> {
        let lower = name.to_ascii_lowercase();
        let numbered = || lower.strip_prefix("gpu:")?.parse().ok();
        match lower.as_str() {
            "auto" => Ok(Self::Auto),
            "cpu" => Ok(Self::Cpu),
            "gpu" => Ok(Self::Gpu(None)),
            _ => numbered()
                .map(|index| Self::Gpu(Some(index)))
                .ok_or_else(|| UnknownBackend { found: name.to_owned() }),
        }
    }
}

impl TryFrom<String> for Backend {
    type Error = UnknownBackend;

    fn try_from(name: String) -> Result<Self, UnknownBackend> {
        name.parse()
    }
}

impl From<Backend> for String {
    fn from(backend: Backend) -> Self {
        backend.to_string()
    }
}

impl Value for Backend {
    type Given = Self;
    const KIND: Kind = Kind::Text("auto, cpu, gpu, or gpu:0 and so on for one of several");

    fn take(&mut self, given: Self) {
        *self = given;
    }

    fn check(&self, _: &Row, _: &Key) -> Result<(), SettingError> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for backend in [Backend::Auto, Backend::Cpu, Backend::Gpu(None), Backend::Gpu(Some(3))] {
            assert_eq!(backend.to_string().parse::<Backend>().unwrap(), backend);
        }
        assert_eq!("GPU".parse::<Backend>().unwrap(), Backend::Gpu(None));
        for wrong in ["", "gpu:", "gpu:-1", "gpu:x", "cuda"] {
            let error = wrong.parse::<Backend>().unwrap_err().to_string();
            assert!(error.contains("expected auto, cpu, gpu"), "{error}");
        }
    }

    #[test]
    fn the_cpu_needs_no_device() {
        assert!(Backend::Cpu.open().unwrap().is_none());
        // On any machine: auto never opens a software adapter.
        let opened = Backend::Auto.open().ok().flatten();
        assert!(opened.is_none_or(|gpu| !gpu.adapter().software));
    }
}
