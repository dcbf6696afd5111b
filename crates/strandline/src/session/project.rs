//! A session that goes on from the kept frames of a project.

use std::sync::Arc;

use glam::Vec3;

use super::{Bookmark, Executor, Session, Simulation, Task, job::Weather};
use crate::{
    Error,
    body::BodyFrame,
    scene::{MotionSection, WindSection},
};

impl<E: Executor> Session<E> {
    /// Times of motion and wind \[s\] at their beginning and when that of the clock is 0, and true where the motion begins
    /// with the next frame.
    pub fn motion_times(&self) -> ([f64; 2], bool) {
        self.direction.times()
    }

    /// Weather of a former frame.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn weather_of(&mut self, motion: MotionSection, wind: WindSection) -> Result<Arc<Weather>, Error> {
        self.direction.weather_of(motion, wind)
    }

    /// Brings the simulation to a frame of a former session, with [`Session::motion_times`] of that.
    ///
    /// # Errors
    /// A state of other hair; then state and times are as before. The GPU failed.
    pub fn go_on(
        &mut self,
        (bookmark, tasks): (&Bookmark, Vec<Task>),
        times: ([f64; 2], bool),
    ) -> Result<(), Error> {
        let before = self.motion_times();
        let start = self.with(Simulation::bookmark)?;
        self.kept.settings = Some(Box::new(self.scene.simulation.clone()));
        self.kept.length = Some(self.scene.groom.length);
        self.direction.set_times(times);
        let gone = self.go_back(bookmark, tasks);
        if gone.is_err() {
            self.direction.set_times(before);
            self.go_back(&start, [])?;
            self.direction.set_times(before);
        }
        gone
    }

    /// Makes the scene one that names no kept frames: it is told of with those that were read.
    pub fn begin_without_frames(&mut self) {
        self.scene.timeline.frames = None;
    }

    /// Origin of all places \[m\], world space.
    pub fn origin(&mut self) -> Vec3 {
        self.with(|simulation| simulation.origin)
    }

    /// A body that was saved: see [`SkinCarrier::recognized`](super::skin_carrier::SkinCarrier::recognized).
    pub fn recognized(&mut self, body: BodyFrame) -> BodyFrame {
        self.with(|simulation| simulation.skin.recognized(body))
    }
}
