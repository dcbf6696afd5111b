//! Bookmarks of a simulation: places in time that it can go back to.

use super::simulation::Simulation;
use crate::{
    body::BodyFrame,
    sim::{Checkpoint, Clock, Settings, SimError},
};

/// A simulation between two tasks, without a hand that holds hair. The same tasks lead on from it to the same bits.
#[derive(Clone)]
pub(crate) struct Bookmark {
    pub state: Checkpoint,
    pub settings: Settings,
    pub clock: Clock,
    pub share: f32,
    /// The body at the end of the last run, where the shown moment is that; else none.
    pub exact: Option<BodyFrame>,
    pub bodies: [BodyFrame; 2],
    pub end: BodyFrame,
    pub passed: f64,
}

impl Bookmark {
    /// Memory of its numbers \[byte\].
    pub fn bytes(&self) -> u64 {
        self.state.parts.iter().map(|part| 4 * part.numbers.len() as u64).sum()
    }
}

impl Simulation {
    /// A bookmark of the simulation as it is. A GPU is waited for.
    pub fn bookmark(&mut self) -> Result<Bookmark, SimError> {
        Ok(Bookmark {
            state: self.engine.state()?.checkpoint(),
            settings: self.settings().clone(),
            clock: self.clock,
            share: self.share,
            exact: self.exact.clone(),
            bodies: self.bodies.clone(),
            end: self.end.clone(),
            passed: self.passed,
        })
    }

    /// Goes back to a bookmark; no hand holds hair then.
    pub fn go_back(&mut self, to: &Bookmark) -> Result<(), SimError> {
        self.release()?;
        if *self.settings() != to.settings {
            self.set_settings(&to.settings)?;
        }
        self.engine.restore(&to.state)?;
        // Reports on their way are of steps that do not count.
        self.engine.reports()?;
        (self.clock, self.share, self.exact) = (to.clock, to.share, to.exact.clone());
        (self.bodies, self.end, self.passed) = (to.bodies.clone(), to.end.clone(), to.passed);
        Ok(())
    }
}
