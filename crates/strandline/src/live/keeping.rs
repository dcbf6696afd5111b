//! Playing along a timeline: frames that are kept are shown, others simulated and kept.

use std::time::Duration;

use super::loaded::Loaded;
use crate::{
    Error,
    session::{Change, Simulation},
};

impl Loaded {
    /// Begins the timeline with the hair as it is. Returns a note for a person.
    pub fn begin(&mut self) -> Result<Option<String>, Error> {
        self.resets = false;
        self.session.hold()?;
        let bookmark = self.session.with(Simulation::bookmark)?;
        let time = self.session.motion_time();
        Ok(self.timeline.begin(&self.session.held(), time, Some(bookmark)))
    }

    /// Frames of a second.
    pub fn rate(&self) -> f64 {
        f64::from(self.session.scene().film.frames_per_second)
    }

    /// Moves on by a frame at a time of the clock: shows one that is kept, or starts to simulate it. Returns true where one
    /// is shown.
    pub fn advance(&mut self, received: u64, now: Duration) -> Result<bool, Error> {
        let (rate, timeline) = (self.rate(), &mut self.timeline);
        // Stale frames are not played.
        timeline.playhead = timeline.from();
        let is_kept = |number| timeline.good_frame(number).is_some();
        let (playhead, range) = (timeline.playhead, &timeline.range);
        let next = range.next(playhead, timeline.film_end, rate, now, is_kept);
        let is_back = next <= playhead;
        let next = if is_back { timeline.nearest(next) } else { next };
        if timeline.good_frame(next).is_some() {
            let frames = if is_back { 1 } else { next - playhead };
            self.timeline.range.pass(frames, rate, now);
            self.show(next)?;
            return Ok(true);
        }
        self.simulate(received)?;
        Ok(false)
    }

    /// Starts the frame after the shown one, so that it is there when it is wanted, unless it is kept.
    pub fn prepare(&mut self, received: u64) -> Result<(), Error> {
        let timeline = &self.timeline;
        let next = timeline.playhead + 1;
        let wraps = timeline.range.next(timeline.playhead, timeline.film_end, 1.0, Duration::ZERO, |_| false);
        if wraps == next && timeline.playhead == timeline.from() && timeline.good_frame(next).is_none() {
            self.simulate(received)?;
        }
        Ok(())
    }

    fn simulate(&mut self, received: u64) -> Result<(), Error> {
        self.come_to_playhead()?;
        let marks = self.timeline.wants_mark();
        self.timeline.under_way = Some(self.session.start_kept(received, marks)?);
        Ok(())
    }

    /// Brings the simulation to the shown frame, where it is elsewhere.
    pub fn come_to_playhead(&mut self) -> Result<(), Error> {
        let timeline = &mut self.timeline;
        let from = timeline.from();
        if timeline.under_way.is_some() || timeline.at == from {
            return Ok(());
        }
        timeline.playhead = from;
        if let Some((bookmark, tasks)) = timeline.way_to(from) {
            self.session.go_back(bookmark, tasks)?;
            self.timeline.at = from;
        }
        Ok(())
    }

    /// Takes the oldest result of the simulation, and keeps it where it is a frame; returns that, and a note.
    pub fn take(&mut self, now: Duration) -> Result<(bool, Option<String>), Error> {
        let earlier = self.session.event_count();
        let is_frame = self.session.take()?;
        let mut note = None;
        if is_frame && !self.resets {
            let reports = self.session.reports_after(earlier);
            let (bookmark, time) = (self.session.take_bookmark(), self.session.motion_time());
            note = self.timeline.add(&self.session.held(), time, bookmark, reports);
            let rate = self.rate();
            self.timeline.range.pass(1, rate, now);
        }
        if self.resets && self.session.started() == 0 {
            note = self.begin()?;
        }
        Ok((is_frame, note))
    }

    /// Shows a frame that is kept.
    pub fn show(&mut self, number: u32) -> Result<(), Error> {
        let Some(frame) = self.timeline.frame(number) else { return Ok(()) };
        let Some(points) = frame.points.clone() else { return Ok(()) };
        let positions = points.read().map_err(Error::KeptFrames)?;
        self.session.show_held(&positions, &frame.body, frame.origin, frame.time);
        self.timeline.playhead = number;
        Ok(())
    }

    /// Applies a change. Where the hair moves otherwise after it, the frames after the shown one are stale.
    pub fn change(&mut self, change: Change) -> Result<(), Error> {
        match change {
            Change::Settings(_) | Change::Length(_) | Change::Grab(..) => {
                self.timeline.invalidate();
                self.come_to_playhead()?;
            }
            Change::Wind(_) | Change::Motion(_) => self.timeline.invalidate(),
            Change::Reset => {
                (self.resets, self.timeline.under_way) = (true, None);
                self.timeline.playhead = 0;
            }
            Change::Camera(_)
            | Change::CameraKeys(_)
            | Change::Look(_)
            | Change::BodyLook(_)
            | Change::Lights(_)
            | Change::LevelOfDetail(_)
            | Change::Picture(_)
            | Change::Drag(_)
            | Change::Release => {}
        }
        let are_keys = matches!(change, Change::CameraKeys(_));
        self.session.change(change)?;
        // The view is that of the shown frame, not of the one that is simulated.
        if are_keys && self.timeline.at != self.timeline.playhead {
            self.show(self.timeline.playhead)?;
        }
        Ok(())
    }
}
