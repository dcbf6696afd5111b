//! What the drawing thread goes on with from one message to the next.

use std::thread::JoinHandle;
use std::time::Duration;

use super::messages::Command;
use super::recorder::Recorder;
use super::stage::Stage;
use crate::{render::PictureSettings, sim::StepReport};

/// A picture that takes longer than this \[s\] is drawn simpler while the hair moves.
const SLOW: f64 = 0.08;
/// How long \[s\] nothing may happen before what stands still is drawn in full.
const MOMENT: Duration = Duration::from_millis(200);

/// What the thread goes on with.
pub(super) struct Course {
    pub stage: Option<Box<Stage>>,
    pub playing: bool,
    /// Frames to be made while it stands still.
    pub steps: u32,
    /// Whether the picture is older than what it shows.
    pub stale: bool,
    /// Whether pictures may be simpler, and whether full ones take too long.
    pub adapts: bool,
    pub slow: bool,
    /// Whether that was seen of the scene and the look as they are.
    pub tried: bool,
    /// Whether the last picture was simpler.
    pub draft: bool,
    pub frame: u64,
    pub heard: u64,
    /// Number of the last load, and of the one that is on stage.
    pub load: u64,
    pub staged: u64,
    pub recorder: Option<Recorder>,
    /// The last step, and whether there is a frame, of which no picture was drawn yet.
    pub step: Option<StepReport>,
    pub is_frame: bool,
    /// Number of the last film.
    pub film: u64,
    /// Films that are being finished.
    pub finishing: Vec<JoinHandle<()>>,
}

impl Course {
    /// Nothing is on stage.
    pub const START: Self = Self {
        stage: None,
        playing: true,
        steps: 0,
        stale: false,
        adapts: false,
        slow: false,
        tried: false,
        draft: false,
        frame: 0,
        heard: 0,
        load: 0,
        staged: 0,
        recorder: None,
        step: None,
        is_frame: false,
        film: 0,
        finishing: Vec::new(),
    };

    /// Notes how long \[s\] a picture took.
    pub fn judge(&mut self, seconds: f64, draft: bool) {
        if !draft {
            self.slow = seconds > SLOW;
            self.tried = true;
        } else if !self.tried && 4.0 * seconds < SLOW {
            // A full one takes some four times as long: it is tried, once.
            self.slow = false;
        }
    }

    /// How long to wait for a message before going on.
    pub fn patience(&self) -> Duration {
        // Every message wakes it.
        const LONG: Duration = Duration::from_secs(3600);
        match self.stage {
            Some(_) if self.playing || self.steps > 0 || self.stale => Duration::ZERO,
            Some(_) if self.draft => MOMENT,
            _ => LONG,
        }
    }
}

/// Whether pictures may take another time after a command.
pub(super) fn changes_cost(command: &Command) -> bool {
    use Command::{LevelOfDetail, Lights, Look, Picture};
    matches!(command, Look(_) | LevelOfDetail(_) | Lights(_) | Picture(_))
}

/// A command that leaves the pictures as large as they are.
pub(super) fn of_size(command: Command, kept: PictureSettings) -> Command {
    match command {
        Command::Picture(settings) => {
            let PictureSettings { width, height, .. } = kept;
            Command::Picture(PictureSettings { width, height, ..settings })
        }
        other => other,
    }
}
