//! Source of the points of a picture.

use glam::Vec3;
use strandline_gpu::{Buffer, Gpu, GpuError};

use crate::{
    body::BodyFrame,
    groom::Vec3Lanes,
    render::gpu::DevicePoints,
    sim::{
        State,
        gpu::{ComingPoints, PointCarrier, read_between},
    },
};

/// The points of the guides between two states, where the picture needs them: on its device, or on the host.
#[derive(Default)]
pub(crate) struct Moment {
    /// Guide points \[m\], seen from the origin, shape `[block][point]` of lanes; old ones while `device` alone has them.
    positions: Vec<Vec3Lanes>,
    on_host: bool,
    /// The points on their way to the host.
    coming: Option<ComingPoints>,
    device: Option<OnDevice>,
    /// Body, seen from the origin.
    pub body: BodyFrame,
    /// Origin of its places \[m\], world space.
    pub origin: Vec3,
    pub at: When,
    /// Bodies of the two states around it, where the points follow the way of the body between them, and not straight
    /// lines.
    pub between: Option<[BodyFrame; 2]>,
}

/// When a moment is: steps that the simulation had made, and where between the last two states it lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct When {
    pub step: u64,
    pub share: f32,
}

/// Copies of the two states around a moment on their device; or, once `is_carried`, the points of the moment in `after`.
struct OnDevice {
    before: Buffer<f32>,
    after: Buffer<f32>,
    is_carried: bool,
    carrier: Option<PointCarrier>,
}

impl OnDevice {
    fn new(gpu: &Gpu, len: usize) -> Result<Self, GpuError> {
        Ok(Self {
            before: Buffer::new(gpu, "points before", len)?,
            after: Buffer::new(gpu, "points after", len)?,
            is_carried: false,
            carrier: None,
        })
    }

    /// The states between which the moment lies; twice the same where its points are carried.
    fn states(&self) -> [&Buffer<f32>; 2] {
        [if self.is_carried { &self.after } else { &self.before }, &self.after]
    }
}

impl Moment {
    /// The points where they lie on a device.
    pub fn device_points(&self) -> Option<DevicePoints<'_>> {
        let [before, after] = self.device.as_ref()?.states();
        Some(DevicePoints { before, after, share: self.at.share })
    }

    /// The points on the host; those of another moment where only a device has these.
    pub fn positions(&self) -> &[Vec3Lanes] {
        &self.positions
    }

    /// True where the points are on the host.
    pub fn is_home(&self) -> bool {
        self.on_host || self.device.is_none()
    }

    /// Brings the points to the host, which waits for the device that has them.
    ///
    /// # Errors
    /// The device was lost.
    pub fn bring_home(&mut self) -> Result<(), GpuError> {
        if let Some(device) = self.device.as_ref().filter(|_| !self.on_host) {
            read_between(device.states(), self.at.share, &mut self.positions)?;
            self.on_host = true;
        }
        Ok(())
    }

    /// True where the points are on the host. Else they are asked for, and a later call finds them; never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn has_come_home(&mut self) -> Result<bool, GpuError> {
        let Some(device) = self.device.as_ref().filter(|_| !self.on_host) else {
            return Ok(true);
        };
        let coming = self.coming.take().map_or_else(|| ComingPoints::begin(device.states()), Ok)?;
        if !coming.has_arrived()? {
            self.coming = Some(coming);
            return Ok(false);
        }
        coming.write(self.at.share, &mut self.positions)?;
        self.on_host = true;
        Ok(true)
    }

    /// Takes points that were kept, and their body; none lie on a device then.
    pub fn hold(&mut self, positions: &[Vec3Lanes], body: &BodyFrame, origin: Vec3) {
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        (self.on_host, self.device, self.between, self.coming) = (true, None, None, None);
        (self.body, self.origin) = (body.clone(), origin);
    }

    /// Takes the points of a state; none lie on a device then.
    pub fn fill(&mut self, state: &State) {
        match &self.between {
            Some([before, after]) => {
                state.carried([before, after], &self.body, self.at.share, &mut self.positions);
            }
            None => state.interpolated(self.at.share, &mut self.positions),
        }
        (self.on_host, self.device, self.coming) = (true, None, None);
    }

    /// Takes the points of the last two states on their device, so that the next step may begin while they are drawn: copies
    /// of both, or the points between them where they follow a body. The strands are `shape[0]` of `shape[1]` points.
    pub fn fill_on(
        &mut self,
        gpu: &Gpu,
        [after, before]: [&Buffer<f32>; 2],
        shape: [usize; 2],
    ) -> Result<(), GpuError> {
        let mut device = match self.device.take().filter(|kept| kept.after.len() == after.len()) {
            Some(kept) => kept,
            None => OnDevice::new(gpu, after.len())?,
        };
        device.is_carried = self.between.is_some();
        match &self.between {
            Some([from, to]) => {
                let carrier = match device.carrier.take() {
                    Some(carrier) => carrier,
                    None => PointCarrier::new(gpu)?,
                };
                let bodies = [from, to, &self.body];
                device.carrier.insert(carrier).carry(
                    [before, after],
                    bodies,
                    self.at.share,
                    shape,
                    &device.after,
                )?;
            }
            None => gpu.copy("copying points", [[before, &device.before], [after, &device.after]])?,
        }
        (self.device, self.on_host, self.coming) = (Some(device), false, None);
        Ok(())
    }
}
