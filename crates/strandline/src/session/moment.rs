//! Source of the points of a picture.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_gpu::{Buffer, Gpu, GpuError};

use crate::{
    body::BodyFrame,
    groom::{LANES, Vec3Lanes},
    render::gpu::DevicePoints,
    sim::{
        State,
        gpu::{ComingPoints, read_between},
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
    /// lines; such a moment is on the host.
    pub between: Option<[BodyFrame; 2]>,
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

    /// True where the points are on the host.
    pub fn is_home(&self) -> bool {
        self.on_host || self.device.is_none()
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

    /// True where the points are on the host. Else they are asked for, and a later call finds them; never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn has_come_home(&mut self) -> Result<bool, GpuError> {
        let Some(OnDevice { before, after }) = self.device.as_ref().filter(|_| !self.on_host) else {
            return Ok(true);
        };
        let coming = self.coming.take().map_or_else(|| ComingPoints::begin([before, after]), Ok)?;
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
            Some(bodies) => carried(state, bodies, &self.body, self.at.share, &mut self.positions),
            None => state.interpolated(self.at.share, &mut self.positions),
        }
        (self.on_host, self.device, self.coming) = (true, None, None);
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
        (self.device, self.on_host, self.coming) = (Some(copy), false, None);
        Ok(())
    }
}

/// Points between two states in the root frames of their strands, carried to a body.
fn carried(
    state: &State,
    [before, after]: &[BodyFrame; 2],
    body: &BodyFrame,
    share: f32,
    positions: &mut Vec<Vec3Lanes>,
) {
    let points_per_strand = state.points_per_strand().max(1);
    positions.resize(state.positions.len(), Vec3Lanes::default());
    let old = state.previous_positions.par_chunks(points_per_strand);
    let pairs = old.zip(state.positions.par_chunks(points_per_strand));
    let blocks = positions.par_chunks_mut(points_per_strand).zip(pairs).enumerate();
    blocks.for_each(|(block, (positions, (old, new)))| {
        for lane in 0..LANES {
            let root = |body: &BodyFrame| body.root(block * LANES + lane);
            let [from_before, from_after] = [before, after].map(|body| root(body).inverse());
            let to = root(body);
            for ((position, old), new) in positions.iter_mut().zip(old).zip(new) {
                let [old, new] = [from_before.point(old.get(lane)), from_after.point(new.get(lane))];
                position.set(lane, to.point(old.lerp(new, share)));
            }
        }
    });
}
