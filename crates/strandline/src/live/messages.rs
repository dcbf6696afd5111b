//! Commands that a [`Live`](crate::Live) takes, pictures and events that it emits.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use super::overlaid::{Overlaid, Overlay};
use super::timeline::{Pace, TimelineShown};
use crate::{
    Error, ErrorKind, OutSettings, Scene, Sources, Written,
    body::Aabb,
    render::{Camera, FrameReport, Picture},
    session::{Change, Ray, Touched},
    sim::{StepReport, Stiffening},
};

/// A command to a [`Live`](crate::Live).
pub enum Command {
    /// Loads a scene; what plays continues until it is there, and stays when it cannot be loaded.
    Load(Box<Scene>),
    /// Loads a scene with grooms, meshes and maps from memory, likewise.
    LoadSources(Box<Scene>, Box<Sources>),
    /// Plays, or stands still.
    Play(bool),
    /// One frame, while it stands still.
    Step,
    /// Shows the kept frame of the timeline that is nearest to this one; nothing is simulated.
    Seek(u32),
    /// The part of the timeline that is played, its first and last frame, where the film's are not, and whether the first
    /// follows the last.
    Range([Option<u32>; 2], bool),
    /// Pace at which frames follow each other; every frame as soon as it is there to begin with.
    Pace(Pace),
    /// Writes kept frames of a scene, the first to the last, to a file without simulating them again.
    Export(Box<Scene>, OutSettings, [u32; 2]),
    /// A change of what plays.
    Change(Change),
    /// Asks for the place of the shown skin on the first line of sight, and the way from there to the second.
    Touch([Ray; 2]),
    /// Saves a scene as TOML, after all commands before it: `groom.pose` names a file beside it with the
    /// hair as it is then, which is what is seen where nothing moves; `film.start` is the time. Hair in a
    /// hand is let go in it. The number is that of the load that the scene goes back to.
    Save(Box<Scene>, u64, PathBuf),
    /// Saves a scene as it began, with the kept frames up to the last that is up to date, in a folder: where that is loaded,
    /// the frames are there at once and the hair goes on after the last, on the CPU to the same bits. The number is as
    /// that of [`Command::Save`].
    SaveProject(Box<Scene>, u64, PathBuf),
    /// Draws simpler pictures while the hair moves or is changed and a full one takes longer than
    /// 80 ms; off to begin with. Hair that stands still is drawn in full after a moment.
    Adapt(bool),
    /// Gives pictures the numbers of an overlay, or none to begin with.
    Overlay(Option<Overlay>),
    /// Writes every frame from the next one on, in full, to a folder: as pictures and a video. Frames are
    /// those of the timeline, however long they take. The size of the pictures stays.
    Record(PathBuf),
    /// Finishes the video.
    StopRecording,
}

impl From<Change> for Command {
    fn from(change: Change) -> Self {
        Self::Change(change)
    }
}

/// A picture of a [`Live`](crate::Live).
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The picture.
    pub picture: Picture,
    /// Pictures drawn so far.
    pub frame: u64,
    /// Commands that were received before it was drawn: see [`Live::send`](crate::Live::send).
    pub drawn_after_command: u64,
    /// Number of commands that came before the step it shows: a picture behind, since the next step is made while
    /// one is drawn.
    pub simulated_after_command: u64,
    /// True where it is simpler than it was asked to be.
    pub draft: bool,
    /// Frames that the video has so far, while one is recorded.
    pub recorded: Option<u32>,
    /// The view of the picture.
    pub camera: Option<Camera>,
    /// True where the view follows the keyframes of the camera.
    pub follows_camera: bool,
    /// The frames that are kept, and the one that is shown.
    pub timeline: TimelineShown,
    /// The guides with the numbers of the overlay, where there is one.
    pub overlaid: Option<Arc<Overlaid>>,
    /// Cost of the picture.
    pub drawing: FrameReport,
    /// The last step that was not reported before.
    pub step: Option<StepReport>,
    /// Strands in the hand.
    pub grabbed: usize,
    /// Strands that are stiffer than their material.
    pub stiffening: Stiffening,
    /// Devices of simulation and pictures.
    pub places: [String; 2],
}

/// A part of loading a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadStage {
    /// Files are read, hair and body grown.
    Growing,
    /// The simulation and the renderer are made.
    Opening,
    /// Kept frames of a project are read.
    Reading,
    /// The hair comes to rest.
    Settling,
}

impl LoadStage {
    /// All of them, in their order.
    pub const ALL: [Self; 4] = [Self::Growing, Self::Opening, Self::Reading, Self::Settling];

    /// The work that is done, for a person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Growing => "growing hair and body",
            Self::Opening => "making the simulation",
            Self::Reading => "reading kept frames",
            Self::Settling => "letting the hair come to rest",
        }
    }
}

/// An event of a [`Live`](crate::Live).
#[derive(Clone, Debug, PartialEq)]
pub enum LiveEvent {
    /// The scene of the command with this number is there: with what it left open chosen to fit its groom, its
    /// camera, the box around hair and body \[m\], and what a person should read.
    Loaded(u64, Box<Scene>, Camera, Aabb, Vec<String>),
    /// The scene of the command with this number is so far; with the hair as it hangs and the camera that sees it, once they
    /// are there.
    Loading(u64, LoadStage, Option<(Arc<Overlaid>, Camera)>),
    /// A note, human-readable.
    Note(String),
    /// The scene of the command with this number could not be loaded: kind and text of the error. The old scene stays.
    NotLoaded(u64, ErrorKind, String),
    /// Kind and text of an error; nothing else changes.
    Error(ErrorKind, String),
    /// It stands still, since a frame failed: its error came before.
    Paused,
    /// The scene, or the project, is saved there.
    Saved(PathBuf),
    /// Share of a project that is written.
    Saving(f32),
    /// The video is over.
    Recorded,
    /// Kept frames are written.
    Exported(Written),
    /// Answer to [`Command::Touch`]; `None` where the first line of sight meets no skin.
    Touched(Option<Touched>),
}

impl From<Error> for LiveEvent {
    fn from(error: Error) -> Self {
        Self::Error(error.kind(), error.to_string())
    }
}

#[derive(Default)]
pub(super) struct Out {
    pub shown: Option<Shown>,
    pub events: VecDeque<LiveEvent>,
}
