use glam::Vec3;

use crate::{
    Devices, Error, Hair, Scene,
    body::Pose,
    gpu::Gpu,
    groom::Guides,
    hair::Studio,
    prepare::Prepared,
    render::{Camera, FrameReport, Look, Picture, PictureSettings},
    sim::{Settings, SimError, State, StepReport},
    simulation::{Done, Job, Moment, Simulation},
    worker::{Gone, Worker},
};

/// What a [`Player`] tells while it plays.
#[derive(Clone, Debug)]
pub enum Event {
    /// Something happened that a person should read; the film goes on.
    Note(String),
    /// A step of the simulation ended.
    Stepped(StepReport),
    /// A picture is finished.
    Drawn {
        /// Its number, from 0.
        frame: u32,
        /// The picture.
        picture: Picture,
        /// What it cost.
        report: FrameReport,
    },
}

/// Plays a scene: an iterator of events, frame after frame, until the film is over.
///
/// Two workers share the work [Chen2011 §5]: while one frame is drawn the next one is simulated on a
/// thread of its own, on another device or on the same.
pub struct Player {
    worker: Worker<Simulation>,
    studio: Studio,
    /// Changed by [`Player::set_settings`] before the next frame is simulated.
    change: Option<Settings>,
    course: Course,
    camera: Camera,
    look: Look,
    draw: bool,
    overlap: bool,
    frames: u32,
    /// Frames whose simulation was started, and taken.
    started: u32,
    taken: u32,
    /// Moments that nobody works on.
    spare: Vec<Moment>,
    /// The moment to be drawn.
    shown: Option<Moment>,
    waiting: std::vec::IntoIter<StepReport>,
    told: std::vec::IntoIter<String>,
    /// Whether the simulation cannot go on.
    failed: bool,
    notes: Vec<String>,
}

/// Where the head and the wind are at every time.
#[derive(Clone)]
struct Course {
    pose: std::sync::Arc<dyn Fn(f64) -> Pose + Send + Sync>,
    wind: std::sync::Arc<dyn Fn(f64) -> Vec3 + Send + Sync>,
    frames_per_second: f64,
    settle_seconds: f64,
    /// Time of motion and wind at the beginning \[s\].
    start: f64,
    /// Whether the first picture shows hair as it begins.
    posed: bool,
    /// What carries the head from where the motion begins to where it is with such hair.
    aside: Pose,
}

/// Time \[s\] in which a head that a pose of hair has elsewhere than the motion comes to where that has it.
const JOINING: f64 = 1.0 / 30.0;

impl Course {
    /// Moves to the end of a frame; the first one lets the hair hang on the resting head before, in whole
    /// steps that are not reported. Hair that begins in a pose is shown in it first.
    ///
    /// Everything is asked for at times of steps, never of frames.
    fn run(&self, simulation: &mut Simulation, frame: u32) -> Result<Vec<StepReport>, SimError> {
        if frame == 0 && self.posed {
            return Ok(Vec::new());
        }
        if frame == 0 {
            simulation.settle(self.settle_seconds, (self.wind)(self.start))?;
        }
        let ended = frame + u32::from(!self.posed);
        simulation.run_to(f64::from(ended) / self.frames_per_second, &|time| {
            (self.head(time), (self.wind)(self.start + time))
        })
    }

    /// Pose of the head at a time of the film \[s\].
    fn head(&self, time: f64) -> Pose {
        let pose = (self.pose)(self.start + time);
        if self.aside == Pose::IDENTITY || time >= JOINING {
            return pose;
        }
        let aside = self.aside.toward(&Pose::IDENTITY, (time / JOINING) as f32);
        Pose { rotation: aside.rotation * pose.rotation, translation: aside.point(pose.translation) }
    }
}
/// What carries a head that is in one pose into another.
fn carrying(from: &Pose, to: &Pose) -> Pose {
    let back = from.inverse();
    Pose { rotation: to.rotation * back.rotation, translation: to.point(back.translation) }
}

impl Player {
    /// Loads a scene; `draw` false leaves the pictures out.
    ///
    /// # Errors
    /// Whatever the scene's parts refuse.
    pub fn new(scene: &Scene, devices: impl Into<Devices>, draw: bool) -> Result<Self, Error> {
        let mut prepared = Prepared::new(scene)?;
        let head = prepared.head.clone();
        let mut notes = std::mem::take(&mut prepared.notes);
        let aspect = scene.picture.width as f32 / scene.picture.height as f32;
        let camera = scene.camera.camera(prepared.bounds, aspect);
        let mut hair = Hair::from_scene(scene, prepared, devices)?;
        notes.extend(hair.take_notes());
        let (simulation, studio) = hair.into_parts();
        let wind = scene.wind;
        let (here, there) = (simulation.end(), head.pose(scene.film.start));
        let aside = if here == there { Pose::IDENTITY } else { carrying(&there, &here) };
        Ok(Self {
            worker: Worker::new(simulation).map_err(Error::Thread)?,
            studio,
            change: None,
            course: Course {
                pose: std::sync::Arc::new(move |time| head.pose(time)),
                wind: std::sync::Arc::new(move |time| wind.at(time)),
                frames_per_second: f64::from(scene.film.frames_per_second),
                settle_seconds: f64::from(scene.film.settle),
                start: scene.film.start,
                posed: scene.groom.pose.is_some(),
                aside,
            },
            camera,
            look: scene.look.clone(),
            draw,
            overlap: true,
            frames: scene.film.frames,
            started: 0,
            taken: 0,
            spare: vec![Moment::default(), Moment::default()],
            shown: None,
            waiting: Vec::new().into_iter(),
            told: Vec::new().into_iter(),
            failed: false,
            notes,
        })
    }

    /// Whether a frame is simulated while the one before is drawn; it is unless told otherwise.
    pub fn set_overlap(&mut self, overlap: bool) {
        self.overlap = overlap;
    }

    /// Changes how the hair moves, from the next frame on whose simulation starts. The hair goes on as it
    /// is; a setting outside its range ends the film with its error.
    pub fn set_settings(&mut self, settings: Settings) {
        self.change = Some(settings);
    }

    /// Changes size and finish of the pictures, from the next one on; where they are drawn stays.
    ///
    /// # Errors
    /// A setting outside its range, or more than the GPU holds; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), Error> {
        Ok(self.studio.painter.set_picture(settings)?)
    }

    /// Changes the hair's look, from the next picture on.
    pub fn set_look(&mut self, look: Look) {
        self.look = look;
    }

    /// Changes the view, from the next picture on.
    pub fn set_camera(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// The simulated strands at rest.
    pub fn guides(&self) -> &Guides {
        &self.studio.guides
    }

    /// The state of the simulation: as long as a frame is on its way, before it or after.
    pub fn state(&self) -> State {
        self.worker.work().engine.state().clone()
    }

    /// The device that the hair is simulated on; none on the CPU.
    pub fn gpu(&self) -> Option<Gpu> {
        self.worker.work().engine.gpu().cloned()
    }

    /// The device that the pictures are drawn on, likewise.
    pub fn picture_gpu(&self) -> Option<Gpu> {
        self.studio.painter.gpu().cloned()
    }

    /// Where the hair is simulated: cpu, or the adapter's number and name.
    pub fn simulated_on(&self) -> String {
        crate::hair::place(self.worker.work().engine.gpu())
    }

    /// Where pictures are drawn, likewise.
    pub fn drawn_on(&self) -> String {
        self.studio.painter.drawn_on()
    }

    /// Number of frames of the film.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Frames of which every event was told.
    pub fn frames_done(&self) -> u32 {
        self.taken - u32::from(self.shown.is_some())
    }

    /// What was mended or left out while loading.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Starts the simulation of the next frame, if there is one.
    fn start(&mut self) -> Result<(), Gone> {
        if self.started == self.frames || self.failed {
            return Ok(());
        }
        let (frame, course, change) = (self.started, self.course.clone(), self.change.take());
        let act = move |simulation: &mut Simulation| {
            change
                .map_or(Ok(()), |settings| simulation.set_settings(&settings))
                .and_then(|()| course.run(simulation, frame))
        };
        let gpu = self.studio.painter.gpu().cloned();
        let moment = self.spare.pop().unwrap_or_default();
        self.started += 1;
        self.worker.start(Job { act: Box::new(act), gpu, moment, is_frame: true, heard: 0 })
    }

    /// Takes the next frame from the worker and starts the one after it.
    fn advance(&mut self) -> Result<(), Error> {
        if self.worker.started() == 0 {
            self.start().map_err(|Gone| Error::WorkerGone)?;
        }
        let Done { moment, reports, notes, .. } = self.worker.finish().map_err(|Gone| Error::WorkerGone)?;
        self.told = notes.into_iter();
        let reports = match reports {
            Ok(reports) => reports,
            Err(error) => {
                self.spare.push(moment);
                return Err(error.into());
            }
        };
        self.waiting = reports.into_iter();
        self.taken += 1;
        if self.draw {
            self.shown = Some(moment);
        } else {
            self.spare.push(moment);
        }
        if self.overlap { self.start().map_err(|Gone| Error::WorkerGone) } else { Ok(()) }
    }

    /// Draws a moment and hands it back.
    fn picture(&mut self, moment: Moment) -> Result<Event, Error> {
        let drawn = self.studio.draw(&moment, &self.camera, &self.look);
        self.told = std::mem::take(&mut self.studio.painter.notes).into_iter();
        self.spare.push(moment);
        let (picture, report) = drawn?;
        Ok(Event::Drawn { frame: self.taken - 1, picture, report })
    }
}

impl Iterator for Player {
    type Item = Result<Event, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(note) = self.told.next() {
                return Some(Ok(Event::Note(note)));
            }
            if let Some(report) = self.waiting.next() {
                return Some(Ok(Event::Stepped(report)));
            }
            if let Some(moment) = self.shown.take() {
                let event = self.picture(moment);
                self.failed |= event.is_err();
                return Some(event);
            }
            if self.taken == self.frames || self.failed {
                return None;
            }
            if let Err(error) = self.advance() {
                self.failed = true;
                return Some(Err(error));
            }
        }
    }
}
