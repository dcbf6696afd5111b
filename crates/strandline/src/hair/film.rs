//! The film of a scene, frame by frame, in a loop of one's own.

use glam::Vec3;

use super::Hair;
use crate::{Error, body::BodyFrame, session::film_timing::FilmTiming, sim::StepReport};

impl Hair {
    /// Advances to the end of a frame of the scene's film, with the motion and the wind of the scene. Frame 0 begins with
    /// the settling time of the scene. Frames in order, from 0, equal those of [`Player`](crate::Player) to the bit.
    /// Returns reports as [`Hair::step`] does.
    ///
    /// # Errors
    /// As [`Hair::step`].
    pub fn play(&mut self, frame: u32) -> Result<Vec<StepReport>, Error> {
        let timing = self.timing().clone();
        let reports = timing.run(self.session.simulation_mut(), frame)?;
        self.played = Some(timing.time(frame));
        self.note_reports(&reports);
        Ok(reports)
    }

    /// Changes the number of frames of the scene's film, the most that a file may hold.
    ///
    /// # Errors
    /// A number outside its range; the old one stays.
    pub fn set_frames(&mut self, frames: u32) -> Result<(), Error> {
        self.session.set_frames(frames)
    }

    /// Time of the film at which a frame is shown \[s\].
    pub fn frame_time(&mut self, frame: u32) -> f64 {
        self.timing().time(frame)
    }

    /// The timing of the scene's film, which begins with the body as it is at the first call.
    fn timing(&mut self) -> &FilmTiming {
        let session = &self.session;
        self.timing.get_or_insert_with(|| {
            let here = session.simulation().end().world_from_head();
            FilmTiming::new(session.scene(), session.head_from_origin().clone(), here)
        })
    }

    /// Lets the hair hang on the resting body for a time \[s\], in whole steps without reports: no time of the film
    /// passes.
    ///
    /// # Errors
    /// As [`Hair::step`].
    pub fn settle(&mut self, seconds: f64) -> Result<(), Error> {
        let wind = self.wind;
        Ok(self.session.simulation_mut().settle(seconds, wind)?)
    }

    /// The body at the end of the last step, in the world.
    pub fn body(&self) -> BodyFrame {
        let simulation = self.session.simulation();
        simulation.end().moved(simulation.origin)
    }

    /// Puts the points of [`Hair::points`] into memory of the caller, shape `[strand][point]`.
    ///
    /// # Errors
    /// As [`Hair::points`].
    ///
    /// # Panics
    /// Another number of points than the guides have.
    pub fn points_into(&mut self, points: &mut [Vec3]) -> Result<(), Error> {
        self.session.show()?;
        self.session.points_into(points)
    }
}
