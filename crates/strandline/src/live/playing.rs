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
/// Simpler pictures become coarser after [`MANY_SLOW`] in a row that take longer than the first time \[s\], at once as coarse
/// as that takes: the aim is fifteen a second. They become finer after [`MANY_QUICK`] of which finer ones should take no
/// longer than the second. Where these took too long after all, it takes four times as many the next time.
const SLOW_DRAFT: f64 = 0.066;
const QUICK_DRAFT: f64 = 0.05;
const MANY_SLOW: i32 = 2;
const MANY_QUICK: i32 = 3;
const MOST_QUICK: i32 = 768;
/// Time \[s\] without events after which hair that stands still is drawn in full.
const MOMENT: Duration = Duration::from_millis(200);

/// Simpler pictures that are drawn: the same ones again when hair that rested moves.
pub(super) struct Drafts {
    pub now: Draft,
    /// Number of the last that took too long, or, below 0, were quick; the least time \[s\] of those, or the most of these.
    alike: i32,
    seconds: f64,
    /// Number of quick ones that finer ones follow.
    many_quick: i32,
}

impl Drafts {
    /// The first is there soon, and finer ones follow where they are quick.
    pub const START: Self = Self { now: Draft::COARSEST, alike: 0, seconds: 0.0, many_quick: MANY_QUICK };

    /// Notes how long \[s\] one took.
    fn judge(&mut self, seconds: f64) {
        let is_slow = seconds > SLOW_DRAFT;
        let is_quick = self.now.within(seconds, QUICK_DRAFT).is_finer_than(self.now);
        (self.alike, self.seconds) = match self.alike {
            alike @ 1.. if is_slow => (alike + 1, self.seconds.min(seconds)),
            alike @ ..=-1 if is_quick => (alike - 1, self.seconds.max(seconds)),
            _ => (i32::from(is_slow) - i32::from(is_quick), seconds),
        };
        if self.alike == MANY_SLOW {
            if self.now != Draft::COARSEST {
                self.many_quick = (4 * self.many_quick).min(MOST_QUICK);
            }
            self.become_of(SLOW_DRAFT);
        } else if self.alike == -self.many_quick {
            self.become_of(QUICK_DRAFT);
        }
    }

    /// Chooses the finest that should take no longer than a time \[s\].
    fn become_of(&mut self, most: f64) {
        (self.now, self.alike) = (self.now.within(self.seconds, most), 0);
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
        let full = self.drafts.now.full_seconds(seconds);
        self.drafts.judge(seconds);
        if !self.tried && full < SLOW {
            // A full one may be quick: it is tried, once.
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
        let mut drafts = Drafts { now: Draft::of(0), ..Drafts::START };
        let mut after = |seconds: &[f64]| {
            seconds.iter().for_each(|seconds| drafts.judge(*seconds));
            drafts.now
        };
        let (finest, coarsest) = (Draft::of(0), Draft::COARSEST);
        assert_eq!(after(&[0.3, 0.06, 0.3]), finest, "one was not slow");
        assert_eq!(after(&[0.3]), coarsest, "at once as coarse as it must be");
        assert_eq!(after(&[0.3; 90]), coarsest, "there is none coarser");
        assert_eq!(after(&[0.045; 90]), coarsest, "as it should be");
        let quick = [0.01; 4 * MANY_QUICK as usize];
        assert_eq!(after(&quick[1..]), coarsest, "finer ones were too slow before");
        assert_eq!(after(&[0.06]), coarsest, "one was not quick");
        assert_eq!(after(&quick), finest, "at once as fine as it may be");
        let second = after(&[0.08, 0.1]);
        assert!(finest.is_finer_than(second) && second.is_finer_than(coarsest), "the quicker of both counts");
    }

    #[test]
    fn a_full_picture_is_tried_where_simpler_ones_are_quick() {
        let mut playing = Playing { slow: true, ..Playing::START };
        playing.judge(0.03, true);
        assert!(playing.slow);
        playing.judge(0.001, true);
        assert!(!playing.slow);
        // It was not quick, and is not tried again.
        playing.judge(0.2, false);
        playing.judge(0.001, true);
        assert!(playing.slow);
    }
}
