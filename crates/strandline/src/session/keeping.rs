//! Work of a session for a timeline: the tasks that lead to a frame, frames that were kept, and the way back to one.

use glam::Vec3;

use super::{
    Bookmark, Executor, Live, Session, Task, air_hairs::with_hairs, job::Job, kept::HostMoment,
    moment::Moment,
};
use crate::{
    Error,
    body::BodyFrame,
    groom::Vec3Lanes,
    sim::{Settings, State},
};

impl<E: Executor> Session<E> {
    /// Hands a task over, as [`Session::start`], with a bookmark at its end where `marks`.
    pub(super) fn start_marked(
        &mut self,
        task: Task,
        home: bool,
        commands: u64,
        marks: bool,
    ) -> Result<(), Error> {
        if let Some(tasks) = self.kept.tasks.as_mut().filter(|_| !task.is_frame()) {
            tasks.push(task.clone());
        }
        let (gpu, moment) = (self.view.painter.gpu().cloned(), self.spare.pop().unwrap_or_default());
        self.executor.start(Job { task, moment, gpu, home, commands, marks }).map_err(|_| Error::WorkerGone)
    }

    /// Makes frames those of the scene's film, and keeps the tasks that lead to them.
    pub fn keep_frames(&mut self) {
        self.direction.film(f64::from(self.scene.film.frames_per_second));
        self.kept.tasks = Some(Vec::new());
    }

    /// Starts the next frame under the direction of a person, with a bookmark at its end where `marks`. Returns the tasks
    /// before it, and its own.
    ///
    /// # Errors
    /// As [`Session::start`].
    pub fn start_kept(&mut self, commands: u64, marks: bool) -> Result<(Vec<Task>, Live), Error> {
        let live = self.direction.next();
        self.start_marked(Task::Live(Box::new(live.clone())), true, commands, marks)?;
        Ok((self.kept.tasks.as_mut().map(std::mem::take).unwrap_or_default(), live))
    }

    /// The bookmark of the frame that was taken last, if it has one.
    pub fn take_bookmark(&mut self) -> Option<Bookmark> {
        self.kept.bookmark.take()
    }

    /// The shown moment; its points must be on the host.
    pub fn held(&self) -> HostMoment<'_> {
        let Moment { body, origin, .. } = &self.shown;
        HostMoment { positions: self.shown.positions(), body, origin: *origin }
    }

    /// Brings the shown moment to the host. Tasks so far lead to it: the next frame begins with none.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn hold(&mut self) -> Result<(), Error> {
        let Self { executor, shown, .. } = self;
        executor.with(|simulation| simulation.bring_home(shown))?;
        self.kept.tasks.iter_mut().for_each(Vec::clear);
        Ok(())
    }

    /// Time of motion and wind \[s\] at the end of the last frame.
    pub fn motion_time(&self) -> f64 {
        self.direction.time_shown(0.0)
    }

    /// Time of motion, wind and camera \[s\] at the time 0 of the clock.
    pub fn motion_offset(&self) -> f64 {
        self.direction.offset()
    }

    /// Shows a moment that was kept, of a time of the motion \[s\]; the simulation stays where it is.
    pub fn show_held(&mut self, positions: &[Vec3Lanes], body: &BodyFrame, origin: Vec3, time: f64) {
        self.shown.hold(positions, body, origin);
        if let Some(motion) = self.camera_motion.as_ref().filter(|_| self.follows_camera) {
            self.view.camera = motion.at(time);
        }
    }

    /// Brings the simulation to the end of a frame: from a bookmark by the tasks that led there. Settings and length are
    /// then those last asked for.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn go_back(
        &mut self,
        bookmark: &Bookmark,
        tasks: impl IntoIterator<Item = Task>,
    ) -> Result<(), Error> {
        let guides = self.view.guides.strand_count();
        let (settings, length) = (self.kept.settings.clone(), self.kept.length);
        let (time, led) = self.executor.with(|simulation| {
            simulation.go_back(bookmark)?;
            for task in tasks {
                let is_frame = task.is_frame();
                // A task that was refused is refused again.
                match task.perform(simulation) {
                    Err(error) if is_frame || error.gpu().is_some() => return Err(error),
                    _ => {}
                }
            }
            simulation.reports()?;
            let now = simulation.settings();
            let settings = settings.filter(|wanted| with_hairs(wanted, simulation.hairs) != *now);
            let length = length.filter(|wanted| simulation.engine.last_state().length_scale(0) != *wanted);
            let releases = (simulation.engine.grabbed() > 0).then_some(Task::Release);
            let lengths = length.map(|length| Task::Lengths(vec![length; guides]));
            let mut led = Vec::new();
            for task in [releases, settings.map(Task::Settings), lengths].into_iter().flatten() {
                match task.clone().perform(simulation) {
                    Ok(_) => led.push(task),
                    // Refused when it was asked for, and told then.
                    Err(error) if error.gpu().is_none() => {}
                    Err(error) => return Err(error),
                }
            }
            Ok((simulation.clock.time(), led))
        })?;
        self.kept.tasks.iter_mut().for_each(|tasks| tasks.clone_from(&led));
        self.direction.go_to(time);
        self.grabbed = 0;
        Ok(())
    }

    /// Other settings of the simulation; those that are refused are not asked for again on the way back.
    pub(super) fn set_settings(&mut self, settings: Box<Settings>) -> Result<(), Error> {
        if settings.check().is_ok() {
            self.kept.settings = Some(settings.clone());
        }
        self.start(Task::Settings(settings), false, 0)
    }

    /// Settings of the simulation that were last asked for.
    pub fn settings_asked(&self) -> &Settings {
        self.kept.settings.as_deref().unwrap_or(&self.scene.simulation)
    }

    /// Length of the strands over their own that was last asked for.
    pub fn length_asked(&self) -> f32 {
        self.kept.length.unwrap_or(self.scene.groom.length)
    }

    /// Another length of all strands; as with settings, one that is refused is not asked for again.
    pub(super) fn set_length(&mut self, scale: f32) -> Result<(), Error> {
        if State::LENGTH_SCALES.contains(&scale) {
            self.kept.length = Some(scale);
        }
        self.start(Task::Lengths(vec![scale; self.view.guides.strand_count()]), false, 0)
    }
}
