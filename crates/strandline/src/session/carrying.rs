//! Hair on a body that jumps, or whose vertices are nowhere.

use std::ops::Range;

use strandline_base::counted;

use super::{
    Simulation,
    jump::{Jump, jump},
};
use crate::{
    body::BodyFrame,
    sim::{Drive, SimError},
};

/// Most jumps that are listed: hair in a window may run for days.
const MOST_LISTED: usize = 10_000;
/// Most jumps of different ways or angles that are noted, and the numbers of jumps that are noted too.
const MOST_NOTED: usize = 8;
const COUNTS: [usize; 3] = [100, 1_000, MOST_LISTED];

impl Simulation {
    /// Carries the hair to where a jump leads within these drives, those of the steps from `first` on, in a span of time
    /// \[s\]: a run with a jump is made where the body ends.
    pub(super) fn carry_over_jumps(
        &mut self,
        drives: &mut [Drive],
        first: u64,
        span: &Range<f64>,
    ) -> Result<(), SimError> {
        let Some(end) = drives.last().map(|drive| drive.body.clone()) else { return Ok(()) };
        let (step, root) = (self.time_step(), self.engine.model().first_root());
        let here = &self.bodies[1];
        let before = std::iter::once(here).chain(drives.iter().map(|drive| &drive.body));
        let of_step = |(index, (before, drive)): (u64, (&BodyFrame, &Drive))| {
            let time = self.clock.step_time(first + index + 1);
            jump(before, &drive.body, root, step).map(|what| Jump { time, what })
        };
        let of_span = || {
            // The way lies between states of steps, however long the frame is that they stand for.
            let what = jump(here, &end, root, drives.len() as f64 * step)?;
            Some(Jump { time: span.end, what })
        };
        let found = (0..).zip(before.zip(&*drives)).find_map(of_step).or_else(of_span);
        let Some(found) = found else { return Ok(()) };
        self.engine.carry(&end)?;
        self.note_jump(&found.what);
        if self.jumps.len() < MOST_LISTED {
            self.jumps.push(found);
            if COUNTS.contains(&self.jumps.len()) {
                self.engine.notes.push(format!("the body has jumped {} times", self.jumps.len()));
            }
        }
        self.bodies = [end.clone(), end.clone()];
        drives.iter_mut().for_each(|drive| drive.body = end.clone());
        Ok(())
    }

    /// Notes a jump, unless one like it or too many were noted before.
    fn note_jump(&mut self, what: &str) {
        if self.told_jumps.len() < MOST_NOTED && !self.told_jumps.iter().any(|told| told == what) {
            self.told_jumps.push(what.to_owned());
            self.engine.notes.push(what.to_owned());
        }
    }

    /// Notes the first time at which vertices of the body have no place.
    pub(super) fn note_held(&mut self, drives: &[Drive], first: u64) {
        if self.told_held {
            return;
        }
        let held = (0..).zip(drives).find(|(_, drive)| drive.body.held_count() > 0);
        let Some((index, count)) = held.map(|(index, drive)| (index, drive.body.held_count())) else {
            return;
        };
        self.told_held = true;
        let time = self.clock.step_time(first + index + 1);
        self.engine.notes.push(format!(
            "{} at no finite place within 1,000 km at {time:.2} s: held as at rest",
            counted(count, "vertex of the body is", "vertices of the body are")
        ));
    }
}
