//! A session: hair that moves and is drawn, changed by commands that are data. `Hair`, `Player` and `Live` are its faces.

mod change;
pub(crate) mod course;
mod direction;
mod draft;
pub(crate) mod engine;
mod event;
mod job;
pub(crate) mod moment;
mod simulation;
mod studio;

pub use change::Change;
pub(crate) use direction::FRAME;
pub use event::Event;
pub(crate) use job::{Here, Place, Task};
pub(crate) use simulation::Simulation;
pub(crate) use studio::Studio;

use std::collections::VecDeque;

use strandline_base::{Group, par::Pool};

use crate::{
    BoundStrands, Devices, Error, Prepared, Ray, Scene,
    body::{Collider, Mesh, Pose},
    devices::{Opened, Pair, place},
    groom::Guides,
    painter::Painter,
    pick::Picked,
    prepare,
    render::{
        BodyLook, Camera, FrameReport, LevelOfDetail, Look, Picture, PictureSettings, memory::check_lights,
    },
    sim::{Model, Settings, StepReport},
    worker::Worker,
};
use direction::Direction;
pub(crate) use draft::Draft;
use draft::simplified;
use engine::Engine;
use job::{Done, Job};
use moment::Moment;

/// A simulation, what draws it, and the commands between them.
pub(crate) struct Session<P> {
    pub place: P,
    pub studio: Studio,
    pub direction: Direction,
    /// Size and finish of full pictures, and which simpler ones the painter draws in their place.
    settings: PictureSettings,
    draft: Option<Draft>,
    /// Where the hair of the last result was simulated: cpu, or the adapter.
    pub simulated_on: String,
    /// Strands in the hand.
    pub grabbed: usize,
    /// Commands that the moment that is shown has received.
    pub simulated_after: u64,
    /// Moments free for the next job, and the one that is shown.
    spare: Vec<Moment>,
    shown: Moment,
    events: VecDeque<Event>,
    /// Pictures drawn so far.
    pub drawn: u32,
}

impl Session<Here> {
    /// Guides, and the strands that they carry, on a body: its drawn mesh and what hair hits.
    ///
    /// # Errors
    /// A setting outside its range; a device that refuses.
    pub fn new(
        devices: Pair,
        guides: Guides,
        bound: Option<BoundStrands>,
        mesh: Option<&Mesh>,
        colliders: Vec<Collider>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let Pair { simulation: Opened { gpu, fall_back }, pictures, notes } = devices;
        let mut engine = Engine::new(gpu.as_ref(), Model::new(&guides, settings, colliders)?, fall_back)?;
        engine.notes.extend(notes);
        let bounds = prepare::bounds(bound.as_ref().map_or(&guides, BoundStrands::strands), mesh);
        let studio = Studio {
            painter: Painter::new(pictures, &guides, bound, mesh)?,
            guides,
            bounds,
            camera: Camera::front(),
            look: Look::default(),
            lights: Look::default().lights(prepare::center(bounds)),
            body_look: BodyLook::default(),
            level_of_detail: LevelOfDetail::default(),
        };
        let simulated_on = place(engine.gpu());
        Ok(Self {
            place: Here::new(Simulation::new(engine, settings.time_step)),
            studio,
            direction: Direction::default(),
            settings: PictureSettings::default(),
            draft: None,
            simulated_on,
            grabbed: 0,
            simulated_after: 0,
            spare: Vec::new(),
            shown: Moment::default(),
            events: VecDeque::new(),
            drawn: 0,
        })
    }

    /// Everything of a scene but its film and its devices.
    ///
    /// # Errors
    /// A setting of the scene outside its range.
    pub fn of_scene(scene: &Scene, prepared: Prepared, devices: Devices) -> Result<Self, Error> {
        scene.check()?; // what only pictures need too, before the first one is drawn
        let camera = prepared.camera(scene.picture.width as f32 / scene.picture.height as f32);
        let Prepared { guides, bound, mesh, colliders, head, pose, scene: chosen, .. } = prepared;
        let mut session =
            Self::new(devices.open()?, guides, bound, mesh.as_ref(), colliders, &scene.simulation)?;
        let studio = &mut session.studio;
        (studio.camera, studio.look) = (camera, scene.look.clone());
        studio.lights = scene.look.lights(prepare::center(studio.bounds));
        // A picture of surroundings, which was loaded when the scene was prepared, lights it alone.
        if !scene.lights.is_empty() || chosen.look.surroundings.is_some() {
            studio.lights.clone_from(&scene.lights);
        }
        (studio.body_look, studio.level_of_detail) = (scene.body_look, scene.level_of_detail);
        session.set_picture(scene.picture)?;
        let simulation = &mut session.place.simulation;
        if scene.groom.length != 1.0 {
            let scales = vec![scene.groom.length; session.studio.guides.strand_count()];
            simulation.engine.set_length_scale(&scales)?;
        }
        // A head that is turned at first does not whip its hair there.
        let start = head.pose(scene.film.start);
        match &pose {
            Some(pose) => simulation.place(pose)?,
            None if start != Pose::IDENTITY => simulation.reset(start)?,
            None => {}
        }
        session.direction = Direction::new(scene, head);
        session.show()?;
        Ok(session)
    }

    /// The same with its simulation on a thread of its own [Chen2011 §5].
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn beside(self) -> Result<Session<Worker<Simulation>>, Error> {
        let mut simulation = self.place.simulation;
        simulation.threads = Some(Pool::new("simulation"));
        Ok(Session {
            place: Worker::new(simulation).map_err(Error::Thread)?,
            studio: self.studio,
            direction: self.direction,
            settings: self.settings,
            draft: self.draft,
            simulated_on: self.simulated_on,
            grabbed: self.grabbed,
            simulated_after: self.simulated_after,
            spare: self.spare,
            shown: self.shown,
            events: self.events,
            drawn: self.drawn,
        })
    }

    /// Takes the hair as it is now for the next picture.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn show(&mut self) -> Result<(), Error> {
        Ok(self.place.simulation.show(self.studio.painter.gpu(), &mut self.shown)?)
    }
}

impl<P: Place> Session<P> {
    /// Hands a task over, whose points the host needs too where `home`.
    ///
    /// # Errors
    /// The simulation's thread has ended.
    pub fn start(&mut self, task: Task, home: bool, commands: u64) -> Result<(), Error> {
        let (gpu, moment) = (self.studio.painter.gpu().cloned(), self.spare.pop().unwrap_or_default());
        self.place.start(Job { task, moment, gpu, home, commands }).map_err(|_| Error::WorkerGone)
    }

    /// Starts the next frame of what a person directs.
    ///
    /// # Errors
    /// As [`Session::start`].
    pub fn start_frame(&mut self, commands: u64) -> Result<(), Error> {
        let task = Task::Live(self.direction.next());
        self.start(task, false, commands)
    }

    /// Takes the oldest result, which is shown from now on; whether it is a frame.
    ///
    /// # Errors
    /// What the task failed with; the simulation's thread has ended.
    pub fn take(&mut self) -> Result<bool, Error> {
        let Done { moment, reports, notes, seconds, grabbed, is_frame, commands, simulated_on } =
            self.place.finish().map_err(|_| Error::WorkerGone)?;
        if is_frame {
            self.direction.pass(seconds);
        }
        (self.simulated_on, self.grabbed) = (simulated_on, grabbed);
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
        let reports = self.place.with(|simulation| simulation.engine.reports())?;
        self.events.extend(reports.into_iter().map(Event::Stepped));
        Ok(())
    }

    /// Draws what is shown, simpler where there is a `draft`, and emits the picture.
    ///
    /// # Errors
    /// A setting outside its range; the GPU failed, and falling back to the CPU is not allowed.
    pub fn draw(&mut self, draft: Option<Draft>) -> Result<(), Error> {
        let (picture, report) = self.picture(draft)?;
        self.events.push_back(Event::Drawn { frame: self.drawn, picture, report });
        self.drawn += 1;
        self.events.extend(std::mem::take(&mut self.studio.painter.notes).into_iter().map(Event::Note));
        Ok(())
    }

    /// Draws what is shown, simpler where there is a `draft`.
    ///
    /// # Errors
    /// As [`Session::draw`].
    pub fn picture(&mut self, draft: Option<Draft>) -> Result<(Picture, FrameReport), Error> {
        if self.draft != draft {
            let settings = draft.map_or(self.settings, |draft| draft.settings(self.settings));
            self.studio.painter.set_picture(&settings)?;
            self.draft = draft;
        }
        let Self { place, studio, shown, .. } = self;
        let mut draw = |studio: &mut Studio| {
            studio.draw(shown, |moment| place.with(|simulation| simulation.bring_home(moment)))
        };
        match draft {
            Some(draft) => simplified(draft, studio, draw),
            None => draw(studio),
        }
    }

    /// Does what a change says; what concerns the simulation becomes a task of its own.
    ///
    /// # Errors
    /// It cannot be done, and nothing has changed; or the simulation's thread has ended.
    pub fn change(&mut self, change: Change) -> Result<(), Error> {
        let studio = &mut self.studio;
        match change {
            Change::Camera(camera) => camera.validate().map(|()| studio.camera = camera)?,
            Change::Look(look) => look.validate().map(|()| studio.look = *look)?,
            Change::BodyLook(look) => look.validate().map(|()| studio.body_look = look)?,
            Change::Lights(lights) => {
                check_lights(&lights)?;
                studio.lights = lights;
            }
            Change::LevelOfDetail(level) => level.validate().map(|()| studio.level_of_detail = level)?,
            Change::Picture(settings) => self.set_picture(settings)?,
            Change::Wind(wind) => wind.check_as("wind").map(|()| self.direction.wind = wind)?,
            Change::Motion(motion) => self.direction.set_motion(*motion)?,
            Change::Drag(ray) => {
                let hand = &mut self.direction.hand;
                *hand = hand.and_then(|hand| ray.at_depth_of(&studio.camera, hand)).or(*hand);
            }
            Change::Grab(ray, radius) => self.grab(&ray, radius)?,
            Change::Release => self.release()?,
            Change::Settings(settings) => self.start(Task::Settings(settings), false, 0)?,
            Change::Length(scale) => {
                let scales = vec![scale; self.studio.guides.strand_count()];
                self.start(Task::Lengths(scales), false, 0)?;
            }
            Change::Reset => {
                self.direction.reset();
                let pose = self.direction.head.pose(0.0);
                self.start(Task::Reset(pose), false, 0)?;
            }
        }
        Ok(())
    }

    /// Changes size and finish of the pictures; nothing changes where that fails.
    fn set_picture(&mut self, settings: PictureSettings) -> Result<(), Error> {
        // What is refused is refused at once, though it may be drawn only later.
        settings.validate()?;
        let drawn = self.draft.map_or(settings, |draft| draft.settings(settings));
        self.studio.painter.set_picture(&drawn)?;
        self.settings = settings;
        Ok(())
    }

    /// Size and finish of full pictures.
    pub fn settings(&self) -> PictureSettings {
        self.settings
    }

    /// Takes the hair that a line of sight meets in what is shown into the hand.
    fn grab(&mut self, ray: &Ray, radius: f32) -> Result<(), Error> {
        let Some(Picked { point, index, lane }) = self.pick(ray, radius)? else { return self.release() };
        self.direction.hand = Some(point);
        self.start(Task::Grab { index, lane, radius }, false, 0)
    }

    fn release(&mut self) -> Result<(), Error> {
        match self.direction.hand.take() {
            Some(_) => self.start(Task::Release, false, 0),
            None => Ok(()),
        }
    }

    /// The hair that a line of sight meets first in what is shown, before the body, within a radius \[m\] of it.
    ///
    /// # Errors
    /// The GPU that had its points failed, and falling back to the CPU is not allowed.
    pub fn pick(&mut self, ray: &Ray, radius: f32) -> Result<Option<Picked>, Error> {
        let Self { place, shown, studio, .. } = self;
        place.with(|simulation| simulation.bring_home(shown))?;
        let Studio { guides, painter, .. } = studio;
        let body = painter.mesh().map(|mesh| (mesh, &shown.world_from_head));
        let shape = [guides.strand_count(), guides.points_per_strand()];
        Ok(ray.hair(shown.positions(), shape, radius, body))
    }

    /// What happened to the devices, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        let mut notes = self.place.with(|simulation| simulation.engine.take_notes());
        notes.append(&mut self.studio.painter.notes);
        notes
    }

    /// Events that were not taken yet.
    pub fn event_count(&self) -> usize {
        self.events.len()
    }

    /// The reports among these events, but for the first so many of them.
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

    /// What is shown.
    pub fn shown(&self) -> &Moment {
        &self.shown
    }
}
