//! A project: a folder with a scene and its kept frames, from which the hair goes on as if it had never stopped.

mod notes;
mod open;
mod save;
mod sums;

pub(super) use open::open;
pub(super) use save::save;

/// Name of the file of kept frames in a project's folder.
const FRAMES: &str = "frames.npz";
