//! Where a run stands: what resuming it needs to make the same bits.

use glam::{Quat, Vec3};
use strandline_base::npz::Array;

use crate::{
    body::Pose,
    sim::{Checkpoint, Part},
};

/// The simulation after a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Snapshot {
    /// The frame, from 0, and the clock's time at its end \[s\].
    pub frame: u32,
    pub time: f64,
    pub state: Checkpoint,
    /// Poses of the head at the last two steps, and where the last run ended.
    pub poses: [Pose; 3],
}

/// Before the name of every array of a state.
const PREFIX: &str = "state_";

/// Names of the arrays of a state in a file, and those in a checkpoint.
pub(super) fn names() -> impl Iterator<Item = (String, &'static str)> {
    Checkpoint::NAMES.into_iter().map(|name| (format!("{PREFIX}{name}"), name))
}

/// A pose as seven numbers: quaternion x, y, z, w and translation \[m\].
pub(super) fn numbers(pose: &Pose) -> [f32; 7] {
    let ([x, y, z, w], [a, b, c]) = (pose.rotation.to_array(), pose.translation.to_array());
    [x, y, z, w, a, b, c]
}

/// The pose of seven numbers, as they are to the bit.
///
/// # Errors
/// A quaternion that is not of length 1, a translation that is not finite.
pub(super) fn pose(numbers: &[f32]) -> Result<Pose, String> {
    let (rotation, translation) = (Quat::from_slice(&numbers[..4]), Vec3::from_slice(&numbers[4..7]));
    if !rotation.is_normalized() {
        return Err(format!("a head with the quaternion {rotation}, expected one of length 1"));
    }
    if !translation.is_finite() {
        return Err(format!("a head at {translation}, expected finite numbers"));
    }
    Ok(Pose { rotation, translation })
}

impl Snapshot {
    /// The arrays of a file: `state_clock` (the frame, the clock's time and the state's \[s\]), `state_poses`
    /// and one for each part of the state. `names` outlives them.
    pub fn arrays<'a>(&'a self, names: &'a [(String, &'static str)]) -> Vec<Array<'a>> {
        let clock = [f64::from(self.frame), self.time, self.state.time];
        let head = [self.state.world_from_head];
        let poses = self.poses.iter().chain(&head).flat_map(numbers);
        let mut arrays =
            vec![Array::f64s("state_clock", &[3], clock), Array::f32s("state_poses", &[4, 7], poses)];
        arrays.extend(self.state.parts.iter().filter_map(|part| {
            let (name, _) = names.iter().find(|(_, own)| *own == part.name)?;
            Some(Array::f32s(name, &part.shape, part.numbers.iter().copied()))
        }));
        arrays
    }

    /// A snapshot of the numbers of a file.
    ///
    /// # Errors
    /// Numbers that are none of a snapshot.
    pub fn new(clock: &[f64], poses: &[f32], parts: Vec<Part>) -> Result<Self, String> {
        let [frame, time, state_time] = clock else {
            return Err("state_clock: expected three numbers".to_owned());
        };
        if !(0.0..super::MAX_FRAMES as f64).contains(frame) || frame.fract() != 0.0 {
            return Err(format!("state_clock with frame {frame}, expected a whole number"));
        }
        if !(time.is_finite() && state_time.is_finite() && *time >= 0.0) {
            return Err(format!("state_clock with {time} s, expected a time"));
        }
        let each: Vec<Pose> = poses.chunks_exact(7).map(pose).collect::<Result<_, _>>()?;
        let [first, second, end, head] = each[..] else {
            return Err("state_poses: expected four poses".to_owned());
        };
        let state = Checkpoint { parts, world_from_head: head, time: *state_time };
        Ok(Self { frame: *frame as u32, time: *time, state, poses: [first, second, end] })
    }
}
