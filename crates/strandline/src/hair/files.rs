//! Files of moving hair that a loop of one's own writes and resumes from.

use super::Hair;
use crate::{Cache, Error, Out, OutSettings, Written, sim::StepReport};

impl Hair {
    /// Begins a file that [`Hair::write`] adds frames to: at most `film.frames` of the scene.
    ///
    /// # Errors
    /// A name that no format has; a file or folder that cannot be written; more points than a file may have.
    pub fn begin_file(&mut self, settings: &OutSettings) -> Result<Out, Error> {
        let out = self.session.begin_file(settings, &self.body())?;
        self.unwritten.get_or_insert_default();
        Ok(out)
    }

    /// Adds the current hair as the next frame, at the time that has passed, or after [`Hair::play`] at the time of its
    /// frame. If [`Hair::step`] stopped between two steps, hair and body are one step older, as in pictures. The file
    /// receives the reports of the steps since the last frame of any file.
    ///
    /// # Errors
    /// The file has all frames of the film, no time has passed since the last one, or the file cannot be written; the GPU
    /// failed.
    pub fn write(&mut self, out: &mut Out) -> Result<(), Error> {
        let frame = out.offered();
        let time = self.played.unwrap_or(self.session.simulation().passed);
        out.check_next(self.session.scene().film.frames, time)?;
        self.reports()?;
        self.session.show()?;
        self.session.points()?;
        let state = if out.wants_state(frame) { Some(self.session.snapshot(frame)?) } else { None };
        let reports = self.unwritten.take().unwrap_or_default();
        self.session.add_to(out, frame, time, &reports, state.as_ref())?;
        self.unwritten = Some(Vec::new());
        Ok(())
    }

    /// Ends a file. One with fewer frames than the film can be resumed by [`Hair::resume`].
    ///
    /// # Errors
    /// The file cannot be written; frames that were written before stay.
    pub fn end_file(&mut self, out: Out) -> Result<Written, Error> {
        let made = out.offered();
        self.session.end_file(out, made, self.session.scene().film.frames)
    }

    /// Goes back to where the run of a cache stood: the same steps from there lead to the same bits. `out` gets the frames
    /// of the cache. Returns the number of frames made so far.
    ///
    /// # Errors
    /// A cache of other hair, without a state, or of a film that was over; a file that cannot be written.
    pub fn resume(&mut self, cache: &mut Cache, out: Option<&mut Out>) -> Result<u32, Error> {
        self.session.resume(cache, self.session.scene().film.frames, out)
    }

    /// Keeps reports for the next frame that is written.
    pub(super) fn note_reports(&mut self, reports: &[StepReport]) {
        self.unwritten.iter_mut().for_each(|kept| kept.extend_from_slice(reports));
    }
}
