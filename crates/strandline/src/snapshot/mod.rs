//! Snapshots of a run: the numbers from which it resumes to the same bits. A moving cache has one of its last frame, a
//! project several, and a file with the pose of hair is one by itself.

pub(crate) mod arrays;
pub(crate) mod files;
pub(crate) mod hair_pose;
mod pose_file;
pub(crate) mod read;
mod tensors;

use glam::Vec3;
use strandline_base::npz::Array;

use crate::{
    body::BodyFrame,
    sim::{Checkpoint, StateArray},
    strands::bodies::{self, LISTS, Lists, OF_STATE},
};

/// The simulation after a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Snapshot {
    /// The frame, from 0, and the clock's time at its end \[s\].
    pub frame: u32,
    pub time: f64,
    pub state: Checkpoint,
    /// Body at the last two steps, and at the end of the last run.
    pub bodies: [BodyFrame; 3],
    /// Origin of all places in it \[m\], world space.
    pub origin: Vec3,
}

/// The version of the layout of arrays, and the first one that is still read. Layout 1 had no lists of bodies.
pub(crate) const LAYOUT: u32 = 2;
const FIRST_LAYOUT: u32 = 1;
/// Most frames of a file.
pub(crate) const MAX_FRAMES: u64 = 1_000_000;

/// Refuses a layout of another version of the program, and other units.
pub(crate) fn check_layout(layout: u32, units: &str, up_axis: &str) -> Result<(), String> {
    if !(FIRST_LAYOUT..=LAYOUT).contains(&layout) {
        return Err(format!(
            "layout {layout}, expected {FIRST_LAYOUT} to {LAYOUT}: it is of another version of the program"
        ));
    }
    if units != "m" || up_axis != "y" {
        return Err(format!("units `{units}` with {up_axis} up, expected m with y up"));
    }
    Ok(())
}

/// Name of the array of the origin, which a run near that of the world does not have.
const ORIGIN: &str = "state_origin";

/// Bodies of a snapshot: those of [`Snapshot::bodies`], then the state's.
const BODIES: usize = 4;
/// Before the name of every array of a state.
const PREFIX: &str = "state_";

/// Names of the arrays of a state in a file, and those in a checkpoint.
pub(crate) fn names() -> impl Iterator<Item = (String, &'static str)> {
    Checkpoint::NAMES.into_iter().map(|name| (format!("{PREFIX}{name}"), name))
}

impl Snapshot {
    /// The arrays of a file: `state_clock` (the frame, the clock's time and the state's \[s\]), `state_poses` with the
    /// other lists of bodies, and one for each part of the state. `names` outlives them.
    pub fn arrays<'a>(&'a self, names: &'a [(String, &'static str)]) -> Vec<Array<'a>> {
        let clock = [f64::from(self.frame), self.time, self.state.time];
        let bodies: Vec<&BodyFrame> = self.bodies.iter().chain([&self.state.body]).collect();
        let poses = bodies.iter().flat_map(|body| bodies::numbers(&body.world_from_head()));
        let mut arrays =
            vec![Array::f64s("state_clock", &[3], clock), Array::f32s("state_poses", &[BODIES, 7], poses)];
        let lists = Lists::of(bodies.iter().copied());
        arrays.extend(lists.present().map(|(list, length, width)| {
            let numbers = bodies.iter().flat_map(|body| lists.numbers(list, body));
            Array::f32s(OF_STATE[list], &[BODIES, length, width], numbers)
        }));
        if self.origin != Vec3::ZERO {
            arrays.push(Array::f32s(ORIGIN, &[3], self.origin.to_array()));
        }
        arrays.extend(self.state.parts.iter().filter_map(|part| {
            let (name, _) = names.iter().find(|(_, own)| *own == part.name)?;
            Some(Array::f32s(name, &part.shape, part.numbers.iter().copied()))
        }));
        arrays
    }

    /// A snapshot of the numbers of a file.
    ///
    /// # Errors
    /// Numbers that do not make a snapshot.
    pub fn new(
        clock: &[f64],
        poses: &[f32],
        lists: &[Vec<f32>; LISTS],
        parts: Vec<StateArray>,
    ) -> Result<Self, String> {
        let [frame, time, state_time] = clock else {
            return Err("state_clock: expected three numbers".to_owned());
        };
        if !(0.0..MAX_FRAMES as f64).contains(frame) || frame.fract() != 0.0 {
            return Err(format!("state_clock with frame {frame}, expected a whole number"));
        }
        if !(time.is_finite() && state_time.is_finite() && *time >= 0.0) {
            return Err(format!("state_clock with {time} s, expected a time"));
        }
        if poses.len() != 7 * BODIES {
            return Err("state_poses: expected four poses".to_owned());
        }
        let body = |at: usize| {
            let of_body = |list: &Vec<f32>| {
                let each = list.len() / BODIES;
                list[at * each..(at + 1) * each].to_vec()
            };
            bodies::body(bodies::pose(&poses[7 * at..])?, &lists.each_ref().map(of_body))
        };
        let bodies = [body(0)?, body(1)?, body(2)?];
        let state = Checkpoint { parts, body: body(3)?, time: *state_time };
        Ok(Self { frame: *frame as u32, time: *time, state, bodies, origin: Vec3::ZERO })
    }
}
