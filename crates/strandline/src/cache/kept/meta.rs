//! Metadata of kept frames, as JSON in the array `meta`. Numbers that must come back to the bit are written as their bits.

use serde::{Deserialize, Serialize};

/// The version of the layout.
pub(super) const LAYOUT: u32 = 1;

/// The version alone, which is read first.
#[derive(Deserialize)]
pub(super) struct Version {
    pub layout: u32,
    #[serde(default)]
    pub written_by: String,
}

/// The object in `meta`.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Meta {
    pub layout: u32,
    /// Program and version that wrote it.
    pub written_by: String,
    /// The scene as TOML, with paths that start from the folder of the file.
    pub scene: String,
    /// Files that the motion depends on, in the order of the scene's paths.
    pub files: Vec<FileSum>,
    /// Checksum of hair and body at rest: grown hair has no file.
    pub rest: u32,
    /// Guides and their points.
    pub strands: u32,
    pub points: u32,
    /// The first frame with tasks, the first with points, and the shown one.
    pub first: u32,
    pub kept: u32,
    pub shown: u32,
    /// Origin of all places \[m\].
    pub origin: [u32; 3],
    pub direction: DirectionNote,
    /// Scenes as TOML, for the tasks and marks that name one by its number.
    pub scenes: Vec<String>,
    /// The frames, `first` on.
    pub frames: Vec<FrameNote>,
    pub marks: Vec<MarkNote>,
}

/// Content of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct FileSum {
    /// Its name, without folder.
    pub name: String,
    pub bytes: u64,
    pub sum: u32,
}

/// Times \[s\] of motion and wind.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct DirectionNote {
    pub begun: u64,
    pub offset: u64,
    pub begins: bool,
}

/// A frame beside its points.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct FrameNote {
    /// Checksum of its points and its body.
    pub sum: u32,
    /// Tasks that led to it from the frame before; `None` of the first.
    pub tasks: Option<Vec<TaskNote>>,
    /// Mean and largest stretch, deepest penetration and points that are not finite, of each step.
    pub steps: Vec<([u32; 3], u64)>,
}

/// A task.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum TaskNote {
    Live { until: u64, offset: u64, scene: usize, hand: Option<[u32; 3]> },
    Settings(usize),
    Length(u32),
    Grab { index: usize, lane: usize, radius: u32 },
    Release,
}

/// A state of the simulation beside its arrays.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct MarkNote {
    pub frame: u32,
    /// Number of the scene that has its settings.
    pub scene: usize,
    /// Length of a step, start, time and lost time of the clock, and its steps.
    pub clock: ([u64; 4], u64),
    pub share: u32,
    /// Time \[s\] of all runs.
    pub passed: u64,
    pub is_exact: bool,
}
