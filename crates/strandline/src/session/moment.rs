//! Source of the points of a picture.

use strandline_gpu::{Buffer, Gpu, GpuError};

use crate::{
    body::BodyFrame,
    groom::Vec3Lanes,
    render::gpu::DevicePoints,
    sim::{State, gpu::read_between},
};

/// The points of the guides between two states, where the picture needs them: on its device, or on the host.
#[derive(Default)]
pub(crate) struct Moment {
    /// Guide points \[m\], world space, shape `[block][point]` of lanes; old ones while `device` alone has them.
    positions: Vec<Vec3Lanes>,
    on_host: bool,
    device: Option<OnDevice>,
    pub body: BodyFrame,
    pub at: When,
}

/// When a moment is: steps that the simulation had made, and where between the last two states it lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct When {
    pub step: u64,
    pub share: f32,
}

/// The two states around a moment, copied on their device.
struct OnDevice {
    before: Buffer<f32>,
    after: Buffer<f32>,
}

impl Moment {
    /// The points where they lie on a device.
    pub fn device_points(&self) -> Option<DevicePoints<'_>> {
        let OnDevice { before, after } = self.device.as_ref()?;
        Some(DevicePoints { before, after, share: self.at.share })
    }

    /// The points on the host; those of another moment where only a device has these.
    pub fn positions(&self) -> &[Vec3Lanes] {
        &self.positions
    }

    /// Brings the points to the host, which waits for the device that has them.
    ///
    /// # Errors
    /// The device was lost.
    pub fn bring_home(&mut self) -> Result<(), GpuError> {
        if let Some(OnDevice { before, after }) = self.device.as_ref().filter(|_| !self.on_host) {
            read_between([before, after], self.at.share, &mut self.positions)?;
            self.on_host = true;
        }
        Ok(())
    }

    /// Takes the points of a state; none lie on a device then.
    pub fn fill(&mut self, state: &State) {
        state.interpolated(self.at.share, &mut self.positions);
        (self.on_host, self.device) = (true, None);
    }

    /// Copies the points on their device, so that the next step may begin while they are drawn.
    pub fn fill_on(&mut self, gpu: &Gpu, [after, before]: [&Buffer<f32>; 2]) -> Result<(), GpuError> {
        let copy = match self.device.take().filter(|kept| kept.after.len() == after.len()) {
            Some(kept) => kept,
            None => OnDevice {
                before: Buffer::new(gpu, "points before", before.len())?,
                after: Buffer::new(gpu, "points after", after.len())?,
            },
        };
        gpu.copy("copying points", [[before, &copy.before], [after, &copy.after]])?;
        (self.device, self.on_host) = (Some(copy), false);
        Ok(())
    }
}
