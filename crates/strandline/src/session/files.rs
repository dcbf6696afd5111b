//! Files of moving hair that a session writes and resumes from.

use strandline_base::counted;

use super::{Executor, Session, resuming};
use crate::{
    Cache, Error, OutSettings, Scene, What, Written,
    body::BodyFrame,
    cache::{Leaving, Out},
    sim::StepReport,
    snapshot::Snapshot,
};

impl<E: Executor> Session<E> {
    /// Begins a file for the frames of the scene's film; `body` is the body at its beginning.
    ///
    /// # Errors
    /// A name that no format has; a file or folder that cannot be written; more points than a file may have.
    pub fn begin_file(&self, settings: &OutSettings, body: &BodyFrame) -> Result<Out, Error> {
        self.begin_file_of(&self.scene, settings, body)
    }

    /// As [`Session::begin_file`], for the film of a scene that was changed since.
    ///
    /// # Errors
    /// As [`Session::begin_file`].
    pub fn begin_file_of(
        &self,
        scene: &Scene,
        settings: &OutSettings,
        body: &BodyFrame,
    ) -> Result<Out, Error> {
        let (view, tags) = (&self.view, &self.tags);
        let leaving = Leaving { guides: &view.guides, bound: view.painter.bound(), tags, body };
        Out::new(settings, scene, leaving)
    }

    /// Adds the shown moment as a frame of the film, where the file takes that frame. The host has its points. `state` is
    /// the simulation's after that frame, where the file wants it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add_to(
        &self,
        out: &mut Out,
        frame: u32,
        time: f64,
        reports: &[StepReport],
        state: Option<&Snapshot>,
    ) -> Result<(), Error> {
        let shown = &self.shown;
        out.add(frame, time, (shown.positions(), &shown.body, shown.origin), reports, state)
    }

    /// The simulation after a frame.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn snapshot(&mut self, frame: u32) -> Result<Snapshot, Error> {
        Ok(self.with(|simulation| simulation.snapshot(frame))?)
    }

    /// Goes back to where the run of a cache stood; `out` gets its frames. Returns the number of frames made so far.
    ///
    /// # Errors
    /// A cache of other hair, without a state, or of a film that was over; a file that cannot be written.
    pub fn resume(&mut self, cache: &mut Cache, frames: u32, out: Option<&mut Out>) -> Result<u32, Error> {
        let guides = &self.view.guides;
        let (strands, points) = (guides.strand_count(), guides.points_per_strand());
        if cache.what() == What::Guides {
            cache.check_guides(strands, points)?;
        }
        let Some(state) = cache.snapshot(strands, points)? else {
            let found = "it holds no state, expected the state_* arrays that `sim --out` writes";
            return Err(Error::cache(cache.path(), found));
        };
        let differences =
            cache.scene().map_or_else(|_| Ok(None), |former| resuming::check(&former, &self.scene));
        let differences = differences.map_err(|found| Error::cache(cache.path(), found))?;
        let made = state.frame + 1;
        if made >= frames {
            let made = counted(made, "frame", "frames");
            let found = format!("its run made {made}, and the film has {frames}: ask for more with --frames");
            return Err(Error::cache(cache.path(), found));
        }
        let steps = cache.steps();
        if state.origin != self.with(|simulation| simulation.origin) {
            let found = "its run has positions about another place: begin another run";
            return Err(Error::cache(cache.path(), found));
        }
        self.with(|simulation| simulation.restore(&state, steps))?;
        self.drawn = made;
        self.view.painter.notes.extend(differences);
        if let Some(out) = out {
            out.copy(cache, &state)?;
        }
        Ok(made)
    }

    /// Ends a file of which `made` frames were made of `frames` in all.
    ///
    /// # Errors
    /// The file cannot be written; frames that were written before stay.
    pub fn end_file(&mut self, out: Out, made: u32, frames: u32) -> Result<Written, Error> {
        let state = made.checked_sub(1).map(|frame| self.snapshot(frame)).transpose()?;
        out.close(made == frames, state.as_ref())
    }
}
