//! A session: hair that moves and is drawn. Commands, which are data, go in; events come out. `Hair`, `Player` and
//! `Live` are its faces.

mod air_hairs;
mod asking;
mod bookmark;
mod carrying;
mod change;
mod direction;
mod draft;
pub(crate) mod engine;
mod event;
#[cfg(test)]
mod far_tests;
mod files;
pub(crate) mod film_timing;
mod following;
mod job;
mod jump;
mod keeping;
mod kept;
pub(crate) mod moment;
mod open;
mod painter;
mod pick;
#[cfg(test)]
mod pieces_tests;
mod project;
pub(crate) mod resuming;
mod simulation;
mod skin_carrier;
mod sync;
mod view;
pub(crate) mod worker;
#[cfg(test)]
mod worker_tests;

pub(crate) use asking::AskedPoints;
pub(crate) use bookmark::Bookmark;
pub use change::Change;
pub(crate) use draft::Draft;
pub use event::Event;
pub(crate) use job::{Executor, Inline, Live, Task, Weather};
pub use jump::Jump;
pub(crate) use kept::HostMoment;
pub use pick::{Ray, Touched};
pub(crate) use simulation::Simulation;
pub(crate) use view::View;

use std::collections::VecDeque;

use glam::Vec3;

use crate::{
    Error, HeadMotion, Scene,
    prepare::{STIFF_NECK, open_loop},
    render::{Camera, FrameReport, Look, Picture, PictureSettings, RenderError, memory::check_lights},
    scene::camera_motion::CameraMotion,
    sim::{StepReport, Stiffening},
    strands::tags::Tags,
};
use direction::Direction;
use draft::simplified;
use job::Done;
use kept::Kept;
use moment::Moment;

/// The note on solids beside a head whose poses are joined in another way.
const SOLIDS_STAY: &str =
    "motion.interpolation: solids go from key to key as before until the scene is loaded again";

/// A simulation, its renderer, and the commands between them.
pub(crate) struct Session<E> {
    /// The scene, fitted to its groom.
    scene: Scene,
    tags: Tags,
    executor: E,
    view: View,
    direction: Direction,
    /// Size and finish of full pictures, and the simpler pictures that are drawn in their place.
    settings: PictureSettings,
    draft: Option<Draft>,
    /// The camera as the scene has it, its keyframes, and whether the view follows them.
    camera_at_rest: Camera,
    camera_motion: Option<CameraMotion>,
    follows_camera: bool,
    /// Device on which the hair of the last result was simulated: cpu, or the adapter.
    simulated_on: String,
    stiffening: Stiffening,
    /// Strands in the hand.
    grabbed: usize,
    /// Commands that the shown moment has received.
    simulated_after: u64,
    /// Moments free for the next job, and the one that is shown.
    spare: Vec<Moment>,
    shown: Moment,
    /// Points of the shown moment, strand after strand.
    points: Vec<Vec3>,
    events: VecDeque<Event>,
    /// Pictures drawn so far.
    drawn: u32,
    kept: Kept,
}

impl<E: Executor> Session<E> {
    /// The scene, with the settings that it leaves open chosen to fit its groom.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The motion of the head, in the world.
    pub fn head(&self) -> &HeadMotion {
        &self.direction.head
    }

    /// The motion of the head, seen from the origin of the simulation.
    pub fn head_from_origin(&self) -> &HeadMotion {
        &self.direction.head_from_origin
    }

    /// The renderer, with the view, the look and the lights of its pictures.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Device on which the hair of the last result was simulated: cpu, or the adapter.
    pub fn simulated_on(&self) -> &str {
        &self.simulated_on
    }

    /// Strands that are stiffer than their material, after the last task.
    pub fn stiffening(&self) -> Stiffening {
        self.stiffening
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.grabbed
    }

    /// Commands that the shown moment has received.
    pub fn simulated_after(&self) -> u64 {
        self.simulated_after
    }

    /// Time of motion and wind at which a film begins with the shown moment \[s\].
    pub fn time_shown(&mut self) -> f64 {
        let delay = self.with(|simulation| simulation.delay());
        self.direction.time_shown(delay)
    }

    /// Acts on the simulation between two jobs; waits for the one that runs.
    pub fn with<T>(&mut self, act: impl FnOnce(&mut Simulation) -> T) -> T {
        self.executor.with(act)
    }

    /// Jobs that were started and whose results were not taken.
    pub fn started(&self) -> usize {
        self.executor.started()
    }

    /// Colours hair by the layers of a light's opacity map.
    pub fn show_layers(&mut self, light: Option<usize>) {
        self.view.painter.layers_of = light;
    }

    /// Hands a task over; the host needs the points of its moment too where `home`.
    ///
    /// # Errors
    /// The simulation's thread has ended.
    pub fn start(&mut self, task: Task, home: bool, commands: u64) -> Result<(), Error> {
        self.start_marked(task, home, commands, false)
    }

    /// Starts the next frame under the direction of a person.
    ///
    /// # Errors
    /// As [`Session::start`].
    pub fn start_frame(&mut self, commands: u64) -> Result<(), Error> {
        let task = Task::Live(Box::new(self.direction.next()));
        self.start(task, false, commands)
    }

    /// Takes the oldest result and shows its moment. Returns true where it is a frame.
    ///
    /// # Errors
    /// The error of the task; the simulation's thread has ended.
    pub fn take(&mut self) -> Result<bool, Error> {
        let done = self.executor.finish().map_err(|_| Error::WorkerGone)?;
        let Done { moment, reports, notes, time, delay, grabbed, .. } = done;
        let Done { is_frame, commands, simulated_on, stiffening, bookmark, .. } = done;
        (self.direction.time, self.kept.bookmark) = (time, bookmark);
        if is_frame {
            self.look_along(delay);
        }
        (self.simulated_on, self.grabbed, self.stiffening) = (simulated_on, grabbed, stiffening);
        self.simulated_after = self.simulated_after.max(commands);
        self.spare.push(std::mem::replace(&mut self.shown, moment));
        self.events.extend(notes.into_iter().map(Event::Note));
        self.events.extend(reports?.into_iter().map(Event::Stepped));
        Ok(is_frame)
    }

    /// Emits the reports of all steps that are still on their way from a GPU.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn report_rest(&mut self) -> Result<(), Error> {
        let reports = self.with(Simulation::reports)?;
        self.events.extend(reports.into_iter().map(Event::Stepped));
        Ok(())
    }

    /// Draws the shown moment, simpler where there is a `draft`, and emits the picture.
    ///
    /// # Errors
    /// A setting outside its range; the GPU failed, and falling back to the CPU is not allowed.
    pub fn draw(&mut self, draft: Option<Draft>) -> Result<(), Error> {
        let (picture, report) = self.picture(draft)?;
        self.events.push_back(Event::Drawn { frame: self.drawn, picture, report });
        self.drawn += 1;
        self.events.extend(std::mem::take(&mut self.view.painter.notes).into_iter().map(Event::Note));
        Ok(())
    }

    /// Draws the shown moment, simpler where there is a `draft`.
    ///
    /// # Errors
    /// As [`Session::draw`].
    pub fn picture(&mut self, draft: Option<Draft>) -> Result<(Picture, FrameReport), Error> {
        if self.draft != draft {
            let settings = draft.map_or(self.settings, |draft| draft.settings(self.settings));
            self.view.painter.set_picture(&settings)?;
            self.draft = draft;
        }
        let failure = match self.draw_from(draft, false) {
            Ok(drawn) => return Ok(drawn),
            Err(failure) => failure,
        };
        // The CPU draws the points of the same step, wherever they are found.
        self.view.painter.recover_from(failure)?;
        let Self { executor, shown, .. } = self;
        executor.with(|simulation| simulation.bring_home(shown))?;
        Ok(self.draw_from(draft, true)?)
    }

    /// Draws the shown moment from its points on their device, or on the host where `at_home`.
    fn draw_from(
        &mut self,
        draft: Option<Draft>,
        at_home: bool,
    ) -> Result<(Picture, FrameReport), RenderError> {
        let Self { view, shown, .. } = self;
        match draft {
            Some(draft) => simplified(draft, view, |view| view.draw(shown, at_home)),
            None => view.draw(shown, at_home),
        }
    }

    /// Applies a change. A change of the simulation becomes a task of its own.
    ///
    /// # Errors
    /// The change is refused, and nothing has changed; or the simulation's thread has ended.
    pub fn change(&mut self, change: Change) -> Result<(), Error> {
        let view = &mut self.view;
        match change {
            Change::Camera(camera) => {
                camera.validate().map(|()| view.camera = camera)?;
                self.follows_camera = false;
            }
            Change::CameraKeys(keys) => self.set_camera_keys(&keys)?,
            Change::Look(look) => look.validate().map(|()| view.look = *look)?,
            Change::BodyLook(look) => look.validate().map(|()| view.body_look = look)?,
            Change::Lights(lights) => {
                check_lights(&lights)?;
                view.lights = lights;
            }
            Change::LevelOfDetail(level) => level.validate().map(|()| view.level_of_detail = level)?,
            Change::Picture(settings) => self.set_picture(settings)?,
            Change::Wind(wind) => self.direction.set_wind(wind)?,
            Change::Motion(motion) => {
                self.scene.motion.check_next(&motion)?;
                let known = self.motion_notes();
                self.direction.set_motion(*motion)?;
                let new = self.motion_notes().into_iter().filter(|note| !known.contains(note));
                self.events.extend(new.map(Event::Note));
            }
            Change::Drag(ray) => {
                let hand = &mut self.direction.hand;
                *hand = hand.and_then(|hand| ray.at_depth_of(&view.camera, hand)).or(*hand);
            }
            Change::Grab(ray, radius) => self.grab(&ray, radius)?,
            Change::Release => self.release()?,
            Change::Settings(settings) => self.set_settings(settings)?,
            Change::Length(scale) => self.set_length(scale)?,
            Change::Reset => {
                self.direction.reset();
                let body = self.direction.head_from_origin.frame(0.0);
                let settle = f64::from(self.scene.film.settle);
                let air = self.direction.wind.air(0.0, self.direction.head_from_origin.origin());
                self.follow_camera();
                self.start(Task::Reset { body, settle, air }, false, 0)?;
            }
        }
        Ok(())
    }

    /// Notes on the motion: a neck that it would bend and that stays stiff, a motion that begins again and ends elsewhere than it
    /// begins, and solids that keep their ways.
    fn motion_notes(&self) -> Vec<String> {
        let body = &self.scene.body;
        let is_bust = self.view.body().is_some() && body.file.is_none() && !body.exact;
        let stiff = if is_bust {
            "the shoulders turn with the head until the scene is loaded again: it was loaded with a neck that stays stiff"
        } else {
            STIFF_NECK
        };
        let neck = self.direction.lacks_neck().then(|| stiff.to_owned());
        let is_keyed = self.scene.colliders.iter().any(|solid| !solid.keyframes().is_empty());
        let other_way = self.direction.interpolation() != self.scene.motion.interpolation;
        let solids = (is_keyed && other_way).then(|| SOLIDS_STAY.to_owned());
        let step = f64::from(self.settings_asked().time_step);
        let open = open_loop("motion", self.direction.head.gap_of_loop(step));
        neck.into_iter().chain(open).chain(solids).collect()
    }

    /// Changes the view without a check: the next picture refuses settings outside their range.
    pub fn set_camera(&mut self, camera: Camera) {
        self.view.camera = camera;
    }

    /// Changes the look of the hair without a check, likewise.
    pub fn set_look(&mut self, look: Look) {
        self.view.look = look;
    }

    /// Changes size and finish of the pictures; nothing changes where that fails.
    fn set_picture(&mut self, settings: PictureSettings) -> Result<(), Error> {
        // Refused at once, although a draft may be drawn with it only later.
        settings.validate()?;
        let drawn = self.draft.map_or(settings, |draft| draft.settings(settings));
        self.view.painter.set_picture(&drawn)?;
        self.settings = settings;
        Ok(())
    }

    /// Size and finish of full pictures.
    pub fn settings(&self) -> PictureSettings {
        self.settings
    }

    /// Notes on the devices, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        let mut notes = self.with(Simulation::take_notes);
        notes.append(&mut self.view.painter.notes);
        notes
    }

    /// Number of events that were not taken.
    pub fn event_count(&self) -> usize {
        self.events.len()
    }

    /// The step reports among these events, without the first so many events.
    pub fn reports_after(&self, event_count: usize) -> Vec<StepReport> {
        let reports = self.events.iter().skip(event_count).filter_map(|event| match event {
            Event::Stepped(report) => Some(report.clone()),
            Event::Note(_) | Event::Drawn { .. } => None,
        });
        reports.collect()
    }

    /// The next event.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }
}
