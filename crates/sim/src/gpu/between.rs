//! Points between two states: on their way to the host, or carried by a moving body on the device.

use strandline_body::BodyFrame;
use strandline_gpu::{
    Bindings, Buffer, Declaration, Gpu, GpuError, Kernel, Readback, Recorder, Rigid, Slot, Transfer, kernel,
    mirror,
};
use strandline_groom::Vec3Lanes;

use super::buffers::floats_mut;
use crate::state::between;

/// Positions of two states on their way to the host.
#[derive(Debug)]
pub struct ComingPoints {
    transfer: Transfer,
    slots: [Slot<f32>; 2],
}

impl ComingPoints {
    /// Begins to copy two states that lie on a device, in the layout of [`GpuRunner::positions`](super::GpuRunner::positions).
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn begin(states: [&Buffer<f32>; 2]) -> Result<Self, GpuError> {
        let mut batch = Readback::new();
        let slots = states.map(|buffer| batch.add(buffer, buffer.len()));
        Ok(Self { transfer: batch.begin(states[0].gpu())?, slots })
    }

    /// True if they have arrived; never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn has_arrived(&self) -> Result<bool, GpuError> {
        self.transfer.has_arrived()
    }

    /// Writes the positions \[m\] between the two, as [`State::interpolated`](crate::State::interpolated) does on the host;
    /// waits where they have not arrived.
    ///
    /// # Errors
    /// The device was lost.
    pub fn write(self, share: f32, positions: &mut Vec<Vec3Lanes>) -> Result<(), GpuError> {
        let copied = self.transfer.take()?;
        let [before, after] = self.slots.map(|slot| {
            let numbers = copied.take(slot);
            let count = numbers.len() * size_of::<f32>() / size_of::<Vec3Lanes>();
            let mut lanes = vec![Vec3Lanes::default(); count];
            floats_mut(&mut lanes).copy_from_slice(&numbers);
            lanes
        });
        between([&before, &after], share, positions);
        Ok(())
    }
}

/// Waits for the device and copies the positions \[m\] between two states that lie there: see [`ComingPoints`].
///
/// # Errors
/// The device was lost.
pub fn read_between(
    states: [&Buffer<f32>; 2],
    share: f32,
    positions: &mut Vec<Vec3Lanes>,
) -> Result<(), GpuError> {
    states[0].gpu().check_wait("points")?;
    ComingPoints::begin(states)?.write(share, positions)
}

mirror! {
    /// Mirrors `CarryInputs` in between.wesl.
    struct CarryInputs {
        pub share: f32,
        pub points_per_strand: u32,
        pub point_count: u32,
        pub last_motion: u32,
    }
}

mirror! {
    /// Mirrors `RootMotion` in between.wesl.
    struct RootMotion {
        pub from_before: Rigid,
        pub from_after: Rigid,
    }
}

kernel! {
    /// One thread is one point.
    struct CarryPoints in "between" (super::linked::BETWEEN), entry "carry_points" {
        0 inputs: Read CarryInputs,
        1 motions: Read RootMotion,
        2 before: Read f32,
        3 after: Read f32,
        4 carried: ReadWrite f32,
    }
}

/// Declaration of the kernel.
pub(super) fn declaration() -> Declaration {
    CarryPoints::declaration()
}

/// Carries points between two states by the root frames of their strands, on the device that has the states: as
/// [`State::carried`](crate::State::carried) does on the host.
#[derive(Debug)]
pub struct PointCarrier {
    kernel: Kernel<CarryPoints<'static>>,
    inputs: Buffer<CarryInputs>,
    motions: Buffer<RootMotion>,
}

impl PointCarrier {
    /// Compiles the kernel; a device does so once.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            kernel: Kernel::new(gpu, &[])?,
            inputs: Buffer::new(gpu, "inputs of carried points", 1)?,
            motions: Buffer::new(gpu, "motions of roots", 1)?,
        })
    }

    /// Writes the points \[m\] of a moment to a buffer as long as those of the states: `share` is 0 at the state before and
    /// 1 at the one after. `bodies` are those of the states and of the moment; `strand_count` of `points_per_strand` points
    /// each. Submits the work and waits for nothing.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn carry(
        &mut self,
        [before, after]: [&Buffer<f32>; 2],
        bodies: [&BodyFrame; 3],
        share: f32,
        [strand_count, points_per_strand]: [usize; 2],
        carried: &Buffer<f32>,
    ) -> Result<(), GpuError> {
        let gpu = carried.gpu();
        let rides_head = bodies.iter().all(|body| body.roots().is_none());
        let motions = motions(bodies, if rides_head { 1 } else { strand_count.max(1) });
        if self.motions.len() < motions.len() {
            self.motions = Buffer::new(gpu, "motions of roots", motions.len())?;
        }
        self.motions.write(&motions)?;
        let point_count = carried.len() / 3;
        self.inputs.write(&[CarryInputs {
            share,
            points_per_strand: points_per_strand as u32,
            point_count: point_count as u32,
            last_motion: motions.len() as u32 - 1,
        }])?;
        let (inputs, motions) = (&self.inputs, &self.motions);
        let bound = self.kernel.bind(gpu, &CarryPoints { inputs, motions, before, after, carried })?;
        gpu.ask("points between two states", || {
            let mut recorder = Recorder::new(gpu, None);
            recorder.stage("between", &[bound.over(point_count)]);
            gpu.queue().submit([recorder.finish(|_| ())]);
        })
    }
}

/// Motions of the first roots from both states to the moment.
fn motions([before, after, moment]: [&BodyFrame; 3], count: usize) -> Vec<RootMotion> {
    let motion = |strand: usize| {
        let to = moment.root(strand);
        let [from_before, from_after] =
            [before, after].map(|body| Rigid::from(&body.root(strand).motion_to(&to)));
        RootMotion { from_before, from_after }
    };
    (0..count).map(motion).collect()
}
