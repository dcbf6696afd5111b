use strandline_base::settings;
use strandline_gpu::{Gpu, GpuError};

use crate::Backend;

settings! {
    /// Devices of the simulation and of pictures. When both are on one GPU, points stay there.
    pub struct Devices: Copy {
        /// Device of the simulation.
        simulation: Backend = Backend::Auto;
        /// Device of the pictures.
        pictures: Backend = Backend::Auto;
    }
}

impl From<Backend> for Devices {
    /// Both on one.
    fn from(backend: Backend) -> Self {
        Self { simulation: backend, pictures: backend }
    }
}

/// A device, and whether to fall back to the CPU when it fails; `None` is the CPU from the start.
pub(crate) struct Opened {
    pub gpu: Option<Gpu>,
    pub fall_back: bool,
}

/// Both devices, with notes on them, human-readable.
pub(crate) struct Pair {
    pub simulation: Opened,
    pub pictures: Opened,
    pub notes: Vec<String>,
}

impl Pair {
    /// A device of the host for both: nothing falls back to the CPU.
    pub(crate) fn of(gpu: &Gpu) -> Self {
        let opened = || Opened { gpu: Some(gpu.clone()), fall_back: false };
        Self { simulation: opened(), pictures: opened(), notes: Vec::new() }
    }
}

impl Devices {
    /// Opens both; the same adapter once.
    pub(crate) fn open(self) -> Result<Pair, GpuError> {
        let mut notes = Vec::new();
        let simulation = open(self.simulation, "simulating", &mut notes)?;
        let is_shared = match (self.pictures, &simulation.gpu) {
            (pictures, Some(_)) if pictures == self.simulation => true,
            (Backend::Gpu(Some(index)), Some(gpu)) => gpu.adapter().index == index,
            (Backend::Gpu(None), Some(gpu)) => gpu.adapter().index == 0,
            // Hardware comes first, as `auto` opens it.
            (Backend::Auto, Some(gpu)) => gpu.adapter().index == 0 && !gpu.adapter().software,
            _ => false,
        };
        let pictures = if is_shared {
            Opened { gpu: simulation.gpu.clone(), fall_back: self.pictures == Backend::Auto }
        } else {
            let opened = open(self.pictures, "drawing", &mut notes)?;
            let software = opened.gpu.iter().map(Gpu::adapter).filter(|adapter| adapter.software);
            notes.extend(software.map(|adapter| {
                format!("{adapter}: for tests; `--render-device cpu` is several times faster")
            }));
            opened
        };
        Ok(Pair { simulation, pictures, notes })
    }
}

fn open(backend: Backend, doing: &str, notes: &mut Vec<String>) -> Result<Opened, GpuError> {
    let fall_back = backend == Backend::Auto;
    let gpu = match backend.open() {
        Err(error) if fall_back => {
            notes.push(format!("{doing} on the CPU: {error}"));
            None
        }
        opened => opened?,
    };
    Ok(Opened { gpu, fall_back })
}

/// Name of a device, human-readable: cpu, or the adapter's number and name.
pub(crate) fn device_name(gpu: Option<&Gpu>) -> String {
    gpu.map_or_else(|| "cpu".to_owned(), |gpu| gpu.adapter().to_string())
}
