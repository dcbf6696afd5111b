//! The timeline of hair that plays: every frame that was simulated is kept, as far as memory and disk have room.
//!
//! Frame n is the hair n / rate seconds after the beginning, frame 0 the beginning itself. A frame is kept with the tasks
//! that led to it, and some with a bookmark of the simulation, so that the simulation goes on from any of them.

mod range;
mod store;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::io;
use std::sync::Arc;

use glam::Vec3;

pub use range::Pace;
pub(crate) use range::Range;
pub(crate) use store::Points;

use crate::{
    body::BodyFrame,
    scene::TimelineSection,
    session::{Bookmark, HostMoment, Live, Task},
    sim::StepReport,
};
use store::Spool;

/// Frames between two bookmarks, each of which takes the memory of some eight frames.
const MARKS: u32 = 48;
/// Share of the memory for bookmarks.
const FOR_MARKS: u64 = 4;
const MEGABYTE: u64 = 1_000_000;

/// A frame that is kept.
pub(crate) struct KeptFrame {
    /// Its guide points; `None` where there was no room for them.
    pub points: Option<Arc<Points>>,
    /// Body, seen from the origin, and the origin \[m\].
    pub body: BodyFrame,
    pub origin: Vec3,
    /// Time of motion and wind \[s\].
    pub time: f64,
    /// Tasks between the frame before and this one, and its own; `None` of the first.
    pub made: Option<(Vec<Task>, Live)>,
    pub bookmark: Option<Arc<Bookmark>>,
    /// Reports of its steps, without the times of their stages.
    pub reports: Vec<StepReport>,
}

impl KeptFrame {
    /// Bytes in memory, and in the file.
    fn bytes(&self) -> [u64; 2] {
        let [memory, disk] = self.points.as_ref().map_or([0; 2], |points| points.bytes());
        let marks = self.bookmark.as_ref().map_or(0, |bookmark| bookmark.bytes());
        let lists = 28 * (self.body.piece_count() + self.body.roots().map_or(0, <[_]>::len))
            + 12 * self.body.skin().map_or(0, |skin| skin.len());
        let own = size_of::<Self>() + self.reports.len() * size_of::<StepReport>() + lists;
        [memory + marks + own as u64, disk]
    }
}

/// The frames of hair that plays.
pub(crate) struct Timeline {
    /// Most bytes in memory and on disk, and those in use.
    most: [u64; 2],
    used: [u64; 2],
    /// The frames, and the number of the first of them. Before `kept` they have no points.
    frames: VecDeque<KeptFrame>,
    first: u32,
    kept: u32,
    /// The last frame that is up to date: those after it are stale.
    good: u32,
    /// The frame that is shown, and the one that the simulation is at.
    pub playhead: u32,
    pub at: u32,
    /// Tasks of the frame that is being simulated.
    pub under_way: Option<(Vec<Task>, Live)>,
    spool: Option<Arc<Spool>>,
    /// The part that is played.
    pub range: Range,
    /// Last frame of the film.
    pub film_end: u32,
}

/// The part of a timeline that is kept, for a person to see.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimelineShown {
    /// The frame that is shown, n / rate seconds after the beginning.
    pub playhead: u32,
    /// The first and the last frame that is kept, and the last one of them that is up to date.
    pub first: u32,
    /// See [`TimelineShown::first`].
    pub last: u32,
    /// See [`TimelineShown::first`].
    pub good: u32,
    /// The part that is played, and the last frame of the film.
    pub marks: [Option<u32>; 2],
    /// See [`TimelineShown::marks`].
    pub film_end: u32,
    /// Frames of a second, and the time of motion and camera at frame 0 \[s\].
    pub rate: f64,
    /// See [`TimelineShown::rate`].
    pub offset: f64,
    /// Bytes of the frames in memory and on disk, and the most of each.
    pub used: [u64; 2],
    /// See [`TimelineShown::used`].
    pub most: [u64; 2],
}

impl Timeline {
    /// An empty one for a film whose last frame has a number.
    pub fn new(settings: &TimelineSection, film_end: u32) -> Self {
        Self {
            most: [settings.memory, settings.disk].map(|megabytes| u64::from(megabytes) * MEGABYTE),
            used: [0; 2],
            frames: VecDeque::new(),
            first: 0,
            kept: 0,
            good: 0,
            playhead: 0,
            at: 0,
            under_way: None,
            spool: None,
            range: Range::default(),
            film_end,
        }
    }

    /// Begins with the hair at its beginning.
    pub fn begin(&mut self, held: &HostMoment, time: f64, bookmark: Option<Bookmark>) -> Option<String> {
        self.frames.clear();
        (self.first, self.kept, self.good, self.playhead, self.at) = (0, 0, 0, 0, 0);
        (self.used, self.under_way, self.spool) = ([0; 2], None, None);
        self.frames.push_back(frame(held, time, None, bookmark, Vec::new()));
        self.used = self.frames[0].bytes();
        self.make_room()
    }

    /// Numbers of the first frame, of the first with points, and of the last that is up to date.
    pub fn bounds(&self) -> [u32; 3] {
        [self.first, self.kept, self.good]
    }

    /// The frames that are up to date, with and without points.
    pub fn up_to_date(&self) -> impl Iterator<Item = &KeptFrame> {
        self.frames.iter().take((self.good + 1 - self.first) as usize)
    }

    /// Forgets all frames; those that are pushed next begin with a number, and have points from another one on.
    pub fn empty(&mut self, first: u32, kept: u32) {
        self.frames.clear();
        (self.first, self.kept) = (first, kept);
        (self.used, self.under_way, self.spool) = ([0; 2], None, None);
    }

    /// Adds a frame of a project behind the last, and moves the playhead to it. Returns a note where there is no room.
    pub fn push(&mut self, frame: KeptFrame) -> Option<String> {
        let [memory, disk] = frame.bytes();
        self.used = [self.used[0] + memory, self.used[1] + disk];
        self.frames.push_back(frame);
        let number = self.last();
        (self.at, self.good, self.playhead) = (number, number, number);
        self.make_room()
    }

    /// True where the frame after the one that the simulation is at should have a bookmark.
    pub fn wants_mark(&self) -> bool {
        let last = self.upto(self.at).rev().find(|number| self.entry(*number).bookmark.is_some());
        last.is_none_or(|last| self.at + 1 >= last + MARKS)
    }

    fn upto(&self, number: u32) -> impl DoubleEndedIterator<Item = u32> + use<> {
        self.first..=number.min(self.last())
    }

    fn entry(&self, number: u32) -> &KeptFrame {
        &self.frames[(number - self.first) as usize]
    }

    /// Adds the frame that was simulated, and moves the playhead to it. Returns a note where there is no room for it.
    pub fn add(
        &mut self,
        held: &HostMoment,
        time: f64,
        bookmark: Option<Bookmark>,
        reports: Vec<StepReport>,
    ) -> Option<String> {
        let added = frame(held, time, self.under_way.take(), bookmark, reports);
        let number = self.at + 1;
        let [memory, disk] = added.bytes();
        let index = (number - self.first) as usize;
        if let Some(stale) = self.frames.get_mut(index) {
            let [old_memory, old_disk] = std::mem::replace(stale, added).bytes();
            self.used = [self.used[0] - old_memory, self.used[1] - old_disk];
        } else {
            self.frames.push_back(added);
        }
        self.used = [self.used[0] + memory, self.used[1] + disk];
        (self.at, self.good, self.playhead) = (number, number, number);
        self.make_room()
    }

    /// Makes all frames after the shown one stale.
    pub fn invalidate(&mut self) {
        self.good = self.good.min(self.playhead);
    }

    /// Number of the last frame, stale or not.
    fn last(&self) -> u32 {
        self.first + (self.frames.len() as u32).saturating_sub(1)
    }

    /// The frame with a number, if it is kept, stale or not.
    pub fn frame(&self, number: u32) -> Option<&KeptFrame> {
        let index = number.checked_sub(self.first)?;
        self.frames.get(index as usize).filter(|frame| frame.points.is_some())
    }

    /// The frame with a number, if it is kept and up to date.
    pub fn good_frame(&self, number: u32) -> Option<&KeptFrame> {
        self.frame(number).filter(|_| number <= self.good)
    }

    /// The kept frame nearest to a number.
    pub fn nearest(&self, number: u32) -> u32 {
        number.clamp(self.kept, self.last().max(self.kept))
    }

    /// The frame from which the simulation goes on: the shown one, or the last that is up to date before it.
    pub fn from(&self) -> u32 {
        self.playhead.min(self.good)
    }

    /// The way of the simulation to a frame that is up to date: the last bookmark before it, and the tasks from there.
    pub fn way_to(&self, number: u32) -> Option<(&Bookmark, Vec<Task>)> {
        let number = number.min(self.good);
        let start = self.upto(number).rev().find(|at| self.entry(*at).bookmark.is_some())?;
        let bookmark = self.entry(start).bookmark.as_deref()?;
        let mut tasks = Vec::new();
        for at in start + 1..=number {
            let (before, live) = self.entry(at).made.as_ref()?;
            tasks.extend(before.iter().cloned());
            tasks.push(Task::Live(Box::new(live.clone())));
        }
        Some((bookmark, tasks))
    }

    /// The part of it that a person sees.
    pub fn shown(&self, rate: f64, offset: f64) -> TimelineShown {
        TimelineShown {
            playhead: self.playhead,
            first: self.kept,
            last: self.last(),
            good: self.good,
            marks: self.range.marks,
            film_end: self.film_end,
            rate,
            offset,
            used: self.used,
            most: self.most,
        }
    }

    /// Moves frames to the disk, and forgets some, until memory and disk hold no more than they may. Returns a note where
    /// the disk refuses.
    fn make_room(&mut self) -> Option<String> {
        self.thin_marks();
        let mut note = None;
        while self.used[0] > self.most[0] {
            let oldest = self.frames.iter().position(in_memory).filter(|_| note.is_none());
            match oldest.map(|index| self.spill(index)) {
                Some(Ok(true)) => {}
                Some(Err(error)) => {
                    note = Some(format!("frames beyond the memory are not kept: {error}"));
                    self.most[1] = 0;
                }
                _ if !self.forget() => break,
                _ => {}
            }
        }
        note
    }

    /// Moves the points of a frame to the disk. Returns false where the disk has no room for them.
    fn spill(&mut self, index: usize) -> io::Result<bool> {
        let Some(points) = self.frames[index].points.clone() else { return Ok(false) };
        let Points::Memory(positions) = &*points else { return Ok(false) };
        let bytes = points.bytes()[0];
        if self.used[1] + bytes > self.most[1] {
            return Ok(false);
        }
        let spool = match &self.spool {
            Some(spool) => spool.clone(),
            None => self.spool.insert(Spool::new(positions.len())?).clone(),
        };
        self.frames[index].points = Some(Arc::new(Points::Disk(spool.write(positions)?)));
        self.used = [self.used[0] - bytes, self.used[1] + bytes];
        Ok(true)
    }

    /// Forgets a frame: the last stale one, else the first. Returns false where the shown ones alone are left.
    fn forget(&mut self) -> bool {
        if self.last() > self.good.max(self.playhead) {
            let gone = self.frames.pop_back().map_or([0; 2], |frame| frame.bytes());
            self.used = [self.used[0] - gone[0], self.used[1] - gone[1]];
            return true;
        }
        if self.kept >= self.from() {
            return false;
        }
        let index = (self.kept - self.first) as usize;
        let before = self.frames[index].bytes();
        self.frames[index].points = None;
        let after = self.frames[index].bytes();
        self.kept += 1;
        self.used = [self.used[0] + after[0] - before[0], self.used[1] + after[1] - before[1]];
        self.drop_start();
        true
    }

    /// Drops the first frames, of which nothing is left, up to the last bookmark before those that are kept.
    fn drop_start(&mut self) {
        let Some(start) = self.upto(self.kept).rev().find(|at| self.entry(*at).bookmark.is_some()) else {
            return;
        };
        while self.first < start {
            let gone = self.frames.pop_front().map_or([0; 2], |frame| frame.bytes());
            self.used = [self.used[0] - gone[0], self.used[1] - gone[1]];
            self.first += 1;
        }
    }

    /// Takes every second bookmark out where all of them take too much.
    fn thin_marks(&mut self) {
        let bytes = |frame: &KeptFrame| frame.bookmark.as_ref().map_or(0, |bookmark| bookmark.bytes());
        let all: u64 = self.frames.iter().map(bytes).sum();
        if all <= self.most[0] / FOR_MARKS {
            return;
        }
        let marked: Vec<usize> =
            (0..self.frames.len()).filter(|index| self.frames[*index].bookmark.is_some()).collect();
        // The first stays, and the last, so that those after it are not far apart.
        for index in marked.iter().skip(1).step_by(2).filter(|index| Some(*index) != marked.last()) {
            let gone = self.frames[*index].bookmark.take();
            self.used[0] -= gone.map_or(0, |bookmark| bookmark.bytes());
        }
    }
}

fn in_memory(frame: &KeptFrame) -> bool {
    frame.points.as_deref().is_some_and(|points| matches!(points, Points::Memory(_)))
}

fn frame(
    held: &HostMoment,
    time: f64,
    made: Option<(Vec<Task>, Live)>,
    bookmark: Option<Bookmark>,
    mut reports: Vec<StepReport>,
) -> KeptFrame {
    reports.iter_mut().for_each(|report| report.seconds = Vec::new());
    KeptFrame {
        points: Some(Arc::new(Points::Memory(held.positions.to_vec()))),
        body: held.body.clone(),
        origin: held.origin,
        time,
        made,
        bookmark: bookmark.map(Arc::new),
        reports,
    }
}
