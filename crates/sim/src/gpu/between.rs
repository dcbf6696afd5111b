use strandline_gpu::{Buffer, GpuError, Readback};
use strandline_groom::Vec3Lanes;

use super::buffers::floats_mut;
use crate::state::between;

/// Waits for the device and copies the positions \[m\] between two states that lie there, in the layout of
/// [`GpuRunner::positions`](super::GpuRunner::positions), as [`State::interpolated`](crate::State::interpolated) does
/// on the host.
///
/// # Errors
/// The device was lost.
pub fn read_between(
    states: [&Buffer<f32>; 2],
    share: f32,
    positions: &mut Vec<Vec3Lanes>,
) -> Result<(), GpuError> {
    let mut batch = Readback::new();
    let slots = states.map(|buffer| batch.add(buffer, buffer.len()));
    let copied = batch.read(states[0].gpu())?;
    let [before, after] = slots.map(|slot| {
        let numbers = copied.take(slot);
        let mut lanes = vec![Vec3Lanes::default(); numbers.len() * size_of::<f32>() / size_of::<Vec3Lanes>()];
        floats_mut(&mut lanes).copy_from_slice(&numbers);
        lanes
    });
    between([&before, &after], share, positions);
    Ok(())
}
