//! The part of the timeline that is played.

/// The way in which a person plays the timeline.
#[derive(Default)]
pub struct Playback {
    /// First and last frame of the part that is played, and whether the first follows the last.
    pub marks: [Option<u32>; 2],
    pub loops: bool,
    pub every_frame: bool,
    /// The frame that was asked for last, and the number of its command.
    pub sought: Option<(u64, u32)>,
}
