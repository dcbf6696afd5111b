//! What a [`Live`](crate::Live) is told, and what it has to tell.

use std::collections::VecDeque;
use std::path::PathBuf;

use crate::{
    Ray, Scene,
    body::Aabb,
    render::{BodyLook, Camera, FrameReport, LevelOfDetail, Light, Look, Picture, PictureSettings},
    scene::{MotionSection, WindSection},
    sim::{Settings, StepReport},
};

/// Time that passes in a frame \[s\].
pub(super) const FRAME: f64 = 1.0 / 60.0;
/// Steps of a frame at most, so that a window stays awake: with steps shorter than that time slows down.
pub(super) const MOST_STEPS: f64 = 16.0;

/// What a [`Live`](crate::Live) may be told. What changes the picture shows in the next one that is begun, what
/// changes the motion in the one after it.
pub enum Command {
    /// Loads a scene; what plays goes on until it is there, and stays when it cannot be loaded.
    Load(Box<Scene>),
    /// Goes on, or stands still.
    Play(bool),
    /// One frame, while it stands still.
    Step,
    /// Back to rest, and to the beginning of the motion.
    Reset,
    /// Another view.
    Camera(Camera),
    /// Another look of the hair.
    Look(Box<Look>),
    /// Another look of the body.
    BodyLook(BodyLook),
    /// Other lights.
    Lights(Vec<Light>),
    /// Another level of detail.
    LevelOfDetail(LevelOfDetail),
    /// Another size or finish of the pictures.
    Picture(PictureSettings),
    /// Other settings of the simulation.
    Settings(Box<Settings>),
    /// Another length of all strands, 0.05 to 2 of their own.
    Length(f32),
    /// Another wind.
    Wind(WindSection),
    /// Another motion of the head, from its beginning, or another turn besides the one that there is; the
    /// pivot stays.
    Motion(Box<MotionSection>),
    /// Takes the hair that a line of sight meets first, and all within a distance \[m\] of it, into a hand.
    Grab(Ray, f32),
    /// Moves the hand to a line of sight, as far from the camera as it is.
    Drag(Ray),
    /// Lets go of the hair.
    Release,
    /// Saves a scene as TOML, after all commands before it: `groom.pose` names a file beside it with the
    /// hair as it is then, which is what is seen where nothing moves; `film.start` is the time. Hair in a
    /// hand is let go in it. The number is that of the load that the scene goes back to.
    Save(Box<Scene>, u64, PathBuf),
    /// Whether pictures are simpler while the hair moves or is changed and a full one takes longer than
    /// 80 ms; they are not unless this is told. What stands still is drawn in full after a moment.
    Adapt(bool),
    /// Writes every frame from the next one on, in full, to a folder: as pictures and a video. Frames are
    /// 1/60 s of the hair's time apart, however long they take. The size of the pictures stays.
    Record(PathBuf),
    /// Finishes the video.
    StopRecording,
}

/// What a [`Live`](crate::Live) shows.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The picture.
    pub picture: Picture,
    /// Pictures drawn so far.
    pub frame: u64,
    /// Commands that were heard before it was drawn: see [`Live::tell`](crate::Live::tell).
    pub heard: u64,
    /// Those of them that the step it shows had heard: a picture behind, since the next step is made while
    /// one is drawn.
    pub felt: u64,
    /// Whether it is simpler than it was asked to be.
    pub draft: bool,
    /// Frames that the video has so far, while one is recorded.
    pub recorded: Option<u32>,
    /// What the picture cost.
    pub drawing: FrameReport,
    /// The last step of which nobody was told before.
    pub step: Option<StepReport>,
    /// Strands in the hand.
    pub grabbed: usize,
    /// Where the hair is simulated and drawn.
    pub places: [String; 2],
}

/// What a [`Live`](crate::Live) has to tell, in its order.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// The scene of the command with this number is there: with what it left open chosen to fit its groom, its
    /// camera, the box around hair and body \[m\], and what a person should read.
    Loaded(u64, Box<Scene>, Camera, Aabb, Vec<String>),
    /// Something that a person should read.
    Note(String),
    /// The scene of the command with this number could not be loaded; what was there stays.
    NotLoaded(u64, String),
    /// Something could not be done; what was there stays.
    Error(String),
    /// It stands still, since going on failed: the error was told before.
    Paused,
    /// The scene is saved there.
    Saved(PathBuf),
    /// The video is over.
    Recorded,
}

#[derive(Default)]
pub(super) struct Out {
    pub shown: Option<Shown>,
    pub news: VecDeque<News>,
}
