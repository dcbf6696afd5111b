use std::fmt;
#[cfg(feature = "wgpu")]
use std::time::Duration;

/// Description of an adapter before it is opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// Its number in the list.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// The interface that drives it: Vulkan, Metal, Dx12.
    pub interface: String,
    /// True for a processor that emulates a GPU: for tests only.
    pub software: bool,
}

/// Bytes that crossed between a host and a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Crossed {
    /// To the device.
    pub to_device: u64,
    /// From the device.
    pub from_device: u64,
}

#[cfg(feature = "wgpu")]
impl Adapter {
    pub(crate) fn new(index: usize, info: &wgpu::AdapterInfo) -> Self {
        Self {
            index,
            name: info.name.clone(),
            interface: info.backend.to_string(),
            software: info.device_type == wgpu::DeviceType::Cpu,
        }
    }

    /// Time after which a submission counts as hung. A software adapter compiles a kernel when it first runs: Mesa 22.3 takes
    /// a minute of a processor for the search of a skin, and two and a half on a busy machine.
    pub(crate) fn patience(&self) -> Duration {
        Duration::from_secs(if self.software { 600 } else { 120 })
    }
}

impl fmt::Display for Adapter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let software = if self.software { ", software" } else { "" };
        write!(f, "gpu:{} {} ({}{software})", self.index, self.name, self.interface)
    }
}
