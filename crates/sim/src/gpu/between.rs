use strandline_gpu::{Buffer, GpuError, Readback, Slot, Transfer};
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
