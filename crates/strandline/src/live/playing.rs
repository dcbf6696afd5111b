//! State of the drawing thread between two messages.

use std::sync::mpsc::Sender;
use std::thread::JoinHandle;
use std::time::Duration;

use super::loaded::Loaded;
use super::overlaid::Overlay;
use super::recorder::Recorder;
use super::timeline::Range;
use crate::{
    render::PictureSettings,
    session::{Change, Draft},
    sim::StepReport,
};

/// A picture that takes longer than this \[s\] is drawn simpler while the hair moves.
const SLOW: f64 = 0.08;
/// Simpler pictures become coarser after [`ALIKE`] in a row that take longer than the first time \[s\], and finer after as
/// many that take less than the second: the aim is eight a second.
const SLOW_DRAFT: f64 = 0.12;
const QUICK_DRAFT: f64 = 0.06;
const ALIKE: i32 = 3;
/// Time \[s\] without events after which hair that stands still is drawn in full.
const MOMENT: Duration = Duration::from_millis(200);

/// Which simpler pictures are drawn.
pub(super) struct Drafts {
    pub now: Draft,
    /// Number of the last that took too long, or, below 0, were quick.
    alike: i32,
}

impl Drafts {
    pub const START: Self = Self { now: Draft::FINEST, alike: 0 };

    /// Notes how long \[s\] one took.
    fn judge(&mut self, seconds: f64) {
        self.alike = if seconds > SLOW_DRAFT {
            self.alike.max(0) + 1
        } else if seconds < QUICK_DRAFT {
            self.alike.min(0) - 1
        } else {
            0
        };
        if self.alike.abs() == ALIKE {
            self.now = if self.alike > 0 { self.now.coarser() } else { self.now.finer() };
            self.alike = 0;
        }
    }
}

/// State of the drawing thread.
pub(super) struct Playing {
    pub scene: Option<Box<Loaded>>,
    pub playing: bool,
    /// Frames to be made while it stands still.
    pub steps: u32,
    /// True where the picture is older than its hair.
    pub stale: bool,
    /// True where pictures may be simpler, and where full ones take too long.
    pub adapts: bool,
    pub slow: bool,
    /// True where that was measured with the scene and the look as they are.
    pub tried: bool,
    /// True where the last picture was simpler; the simpler ones that are drawn.
    pub draft: bool,
    pub drafts: Drafts,
    /// The overlay of pictures.
    pub overlay: Option<Overlay>,
    pub frame: u64,
    pub received: u64,
    /// Number of the last load, and of the scene that plays; loads that are under way.
    pub load: u64,
    pub loaded: u64,
    pub loading: usize,
    pub recorder: Option<Recorder>,
    /// The last step without a picture yet, and true where a frame has none yet.
    pub step: Option<StepReport>,
    pub is_frame: bool,
    /// Number of the last film.
    pub film: u64,
    /// Films that are being finished.
    pub finishing: Vec<JoinHandle<()>>,
    /// Callers that wait until nothing is left to do.
    pub idlers: Vec<Sender<()>>,
    /// The part of the timeline that is played, for the next scene too.
    pub range: Range,
}

impl Playing {
    /// No scene is there.
    pub const START: Self = Self {
        scene: None,
        playing: true,
        steps: 0,
        stale: false,
        adapts: false,
        slow: false,
        tried: false,
        draft: false,
        drafts: Drafts::START,
        overlay: None,
        frame: 0,
        received: 0,
        load: 0,
        loaded: 0,
        loading: 0,
        recorder: None,
        step: None,
        is_frame: false,
        film: 0,
        finishing: Vec::new(),
        idlers: Vec::new(),
        range: Range::START,
    };

    /// Notes how long \[s\] a picture took.
    pub fn judge(&mut self, seconds: f64, draft: bool) {
        if !draft {
            self.slow = seconds > SLOW;
            self.tried = true;
            return;
        }
        self.drafts.judge(seconds);
        if !self.tried && 8.0 * seconds < SLOW {
            // A full one takes some eight times as long: it is tried, once.
            self.slow = false;
        }
    }

    /// True where only time brings further work.
    pub fn is_idle(&self) -> bool {
        let works = self.playing || self.steps > 0 || self.stale;
        self.loading == 0 && !(works && self.scene.is_some())
    }

    /// Plays from a time of the clock on. Steps that were asked for before are among the frames it plays.
    pub fn play(&mut self, now: Duration) {
        (self.playing, self.steps) = (true, 0);
        self.set_range(|range| range.due = now);
    }

    /// Changes the part of the timeline that is played.
    pub fn set_range(&mut self, change: impl Fn(&mut Range)) {
        change(&mut self.range);
        self.scene.iter_mut().for_each(|loaded| change(&mut loaded.timeline.range));
    }

    /// Time to wait for a message before the next frame, at a time of the clock.
    pub fn patience(&self, now: Duration) -> Duration {
        // Every message wakes it.
        const LONG: Duration = Duration::from_secs(3600);
        match &self.scene {
            Some(_) if self.steps > 0 || self.stale => Duration::ZERO,
            Some(loaded) if self.playing => loaded.timeline.range.wait(now),
            Some(_) if self.draft => MOMENT,
            _ => LONG,
        }
    }
}

/// True where pictures may take another time after a change.
pub(super) fn changes_cost(change: &Change) -> bool {
    use Change::{LevelOfDetail, Lights, Look, Picture};
    matches!(change, Look(_) | LevelOfDetail(_) | Lights(_) | Picture(_))
}

/// A change that leaves the pictures as large as they are.
pub(super) fn of_size(change: Change, kept: PictureSettings) -> Change {
    match change {
        Change::Picture(settings) => {
            let PictureSettings { width, height, .. } = kept;
            Change::Picture(PictureSettings { width, height, ..settings })
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drafts_become_as_coarse_as_their_time_asks_for() {
        let mut drafts = Drafts::START;
        let mut after = |seconds: &[f64]| {
            seconds.iter().for_each(|seconds| drafts.judge(*seconds));
            drafts.now
        };
        let (first, second) = (Draft::FINEST, Draft::FINEST.coarser());
        assert_eq!(after(&[0.3, 0.3, 0.1, 0.3, 0.3]), first, "one was not slow");
        assert_eq!(after(&[0.3]), second);
        assert_eq!(after(&[0.1; 9]), second, "as it should be");
        let coarsest = after(&[0.3; 90]);
        assert_eq!(coarsest.coarser(), coarsest, "there is none coarser");
        assert_eq!(after(&[0.05; 3]), coarsest.finer());
        assert_eq!(after(&[0.05; 90]), first);
    }
}
