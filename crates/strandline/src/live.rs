//! Hair that plays until it is told otherwise, for windows: nothing here makes its caller wait.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use glam::Vec3;

use crate::{
    Error, Hair, Scene,
    body::{Aabb, Motion, Pose},
    hair::{Studio, place},
    prepare::Prepared,
    render::{BodyLook, Camera, FrameReport, LevelOfDetail, Light, Look, Picture, PictureSettings},
    scene::WindSection,
    sim::{Settings, SimError, StepReport},
    simulation::{Act, Done, Job, Moment, Simulation},
    worker::{Gone, Worker},
};

/// Time that passes in a frame \[s\].
const FRAME: f64 = 1.0 / 60.0;

/// What a [`Live`] may be told. Everything shows within two frames.
pub enum Command {
    /// Loads a scene; what plays goes on until it is there, and stays when it cannot be loaded.
    Load(Box<Scene>),
    /// Goes on, or stands still.
    Play(bool),
    /// One frame, while it stands still.
    Step,
    /// Back to rest.
    Reset,
    /// Another view.
    Camera(Camera),
    /// Another look of the hair.
    Look(Box<Look>),
    /// Another look of the body.
    BodyLook(BodyLook),
    /// Other lights.
    Lights(Vec<Light>),
    /// Another level of detail.
    LevelOfDetail(LevelOfDetail),
    /// Another size or finish of the pictures.
    Picture(PictureSettings),
    /// Other settings of the simulation.
    Settings(Box<Settings>),
    /// Another length of all strands, 0.05 to 1 of their own.
    Length(f32),
    /// Another wind.
    Wind(WindSection),
    /// Another motion of the head, from its beginning.
    Motion(Motion),
    /// Turns the head by hand, besides its motion: angles about y and x \[radians\].
    Turn(f32, f32),
}

/// What a [`Live`] shows.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The picture.
    pub picture: Picture,
    /// Frames drawn so far.
    pub frame: u64,
    /// What the picture cost.
    pub drawing: FrameReport,
    /// The last step, if one was made for this picture.
    pub step: Option<StepReport>,
    /// Where the hair is simulated and drawn.
    pub places: [String; 2],
}

/// What a [`Live`] has to tell, in its order.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// A scene is there: its camera, the box around hair and body \[m\], and what a person should read.
    Loaded(Camera, Aabb, Vec<String>),
    /// Something that a person should read.
    Note(String),
    /// Something went wrong; what was there stays.
    Error(String),
}

/// A scene that plays on threads of its own: one simulates, one draws [Chen2011 §5].
pub struct Live {
    commands: Option<Sender<Message>>,
    out: Arc<Mutex<Out>>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Out {
    shown: Option<Shown>,
    news: VecDeque<News>,
}

enum Message {
    Command(Command),
    Loaded(Result<Box<Stage>, Error>),
    /// Nobody looks any more.
    End,
}

impl Live {
    /// Starts the threads and loads a scene. `wake` is called when there is something new.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn new(scene: Scene, wake: impl Fn() + Send + 'static) -> Result<Self, Error> {
        let (commands, messages) = channel();
        let out = Arc::new(Mutex::new(Out::default()));
        let desk = Desk { messages, own: commands.clone(), out: out.clone(), wake: Box::new(wake) };
        let thread = std::thread::Builder::new()
            .name("drawing".to_owned())
            .spawn(move || desk.run())
            .map_err(Error::Thread)?;
        let live = Self { commands: Some(commands), out, thread: Some(thread) };
        live.tell(Command::Load(Box::new(scene)));
        Ok(live)
    }

    /// Tells it something; never waits.
    pub fn tell(&self, command: Command) {
        // Without a thread there is nobody to tell: its last words are in the news.
        let _ = self.commands.as_ref().map(|commands| commands.send(Message::Command(command)));
    }

    /// The newest picture, if there is one that was not taken yet.
    pub fn take_shown(&self) -> Option<Shown> {
        self.out().shown.take()
    }

    /// What happened since the last call.
    pub fn take_news(&self) -> Vec<News> {
        self.out().news.drain(..).collect()
    }

    fn out(&self) -> std::sync::MutexGuard<'_, Out> {
        self.out.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        // The thread holds a sender too, so that it does not end by itself.
        if let Some(commands) = self.commands.take() {
            let _ = commands.send(Message::End);
        }
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// The reports of a job, and what a person should read.
type Taken = (Result<Vec<StepReport>, SimError>, Vec<String>);

/// A scene on stage.
struct Stage {
    worker: Worker<Simulation>,
    studio: Studio,
    camera: Camera,
    look: Look,
    wind: WindSection,
    motion: Motion,
    pivot: Vec3,
    /// Turn of the head by hand about y and x \[radians\].
    turn: [f32; 2],
    /// Time of motion and wind \[s\], at the end of the last frame that was started.
    time: f64,
    spare: Vec<Moment>,
    shown: Option<Moment>,
    simulated_on: String,
    bounds: Aabb,
    notes: Vec<String>,
}

impl Stage {
    fn new(scene: &Scene) -> Result<Self, Error> {
        let mut prepared = Prepared::new(scene)?;
        let (motion, pivot, bounds) = (prepared.motion.clone(), prepared.pivot, prepared.bounds);
        let mut notes = std::mem::take(&mut prepared.notes);
        let aspect = scene.picture.width as f32 / scene.picture.height as f32;
        let camera = scene.camera.camera(bounds, aspect);
        let mut hair = Hair::from_scene(scene, prepared, scene.devices())?;
        notes.extend(hair.take_notes());
        let (simulation, studio) = hair.into_parts();
        let mut shown = Moment::default();
        simulation.show(&mut shown);
        let simulated_on = place(simulation.engine.gpu());
        Ok(Self {
            worker: Worker::new(simulation).map_err(Error::Thread)?,
            studio,
            camera,
            look: scene.look.clone(),
            wind: scene.wind,
            motion,
            pivot,
            turn: [0.0; 2],
            time: 0.0,
            spare: vec![Moment::default()],
            shown: Some(shown),
            simulated_on,
            bounds,
            notes,
        })
    }

    /// Starts one frame.
    fn start(&mut self) -> Result<(), Gone> {
        let (motion, pivot, begin, turn) = (self.motion.clone(), self.pivot, self.time, self.turn);
        let wind = self.wind.at(begin);
        self.time += FRAME;
        self.act(Box::new(move |simulation| {
            let end = turned(motion.pose(begin + FRAME, pivot), turn, pivot);
            let start = simulation.end();
            simulation.step_along(FRAME, wind, &|share| start.toward(&end, share))
        }))
    }

    fn act(&mut self, act: Act) -> Result<(), Gone> {
        let (gpu, moment) = (self.studio.painter.gpu().cloned(), self.spare.pop().unwrap_or_default());
        self.worker.start(Job { act, gpu, moment })
    }

    /// Takes the next result; the moment shown before is free.
    fn take(&mut self) -> Result<Taken, Gone> {
        let Done { moment, reports, notes, place } = self.worker.finish()?;
        self.simulated_on = place;
        self.spare.extend(self.shown.replace(moment));
        Ok((reports, notes))
    }

    fn draw(&mut self) -> Result<(Picture, FrameReport), Error> {
        let Some(moment) = &self.shown else { return Ok(Default::default()) };
        self.studio.draw(moment, &self.camera, &self.look)
    }
}

/// A pose turned by hand about the pivot.
fn turned(pose: Pose, [yaw, pitch]: [f32; 2], pivot: Vec3) -> Pose {
    let turn = glam::Quat::from_rotation_y(yaw) * glam::Quat::from_rotation_x(pitch);
    let rotation = pose.rotation * turn;
    Pose { rotation, translation: pose.point(pivot) - rotation * pivot }
}

/// The drawing thread.
struct Desk {
    messages: Receiver<Message>,
    own: Sender<Message>,
    out: Arc<Mutex<Out>>,
    wake: Box<dyn Fn() + Send>,
}

/// What the thread goes on with.
#[derive(Default)]
struct Course {
    stage: Option<Box<Stage>>,
    playing: bool,
    /// Frames to be made while it stands still.
    steps: u32,
    /// Whether the picture is older than what it shows.
    stale: bool,
    frame: u64,
}

impl Desk {
    fn run(self) {
        let mut course = Course { playing: true, ..Course::default() };
        loop {
            let busy = course.stage.is_some() && (course.playing || course.steps > 0 || course.stale);
            // With nothing to do it sleeps; every message wakes it.
            let patience = if busy { Duration::ZERO } else { Duration::from_secs(3600) };
            let mut next = self.messages.recv_timeout(patience);
            loop {
                match next {
                    Ok(Message::End) | Err(RecvTimeoutError::Disconnected) => return,
                    Ok(message) => self.hear(&mut course, message),
                    Err(RecvTimeoutError::Timeout) => break,
                }
                next = self.messages.recv_timeout(Duration::ZERO);
            }
            if let Err(error) = self.frame(&mut course) {
                self.say(News::Error(error.to_string()));
                // What fails now fails again: it waits to be told something else.
                (course.playing, course.steps, course.stale) = (false, 0, false);
            }
        }
    }

    fn hear(&self, course: &mut Course, message: Message) {
        let command = match message {
            Message::Command(command) => command,
            Message::Loaded(Ok(stage)) => {
                self.say(News::Loaded(stage.camera, stage.bounds, stage.notes.clone()));
                course.stage = Some(stage);
                course.stale = true;
                return;
            }
            Message::Loaded(Err(error)) => return self.say(News::Error(error.to_string())),
            Message::End => return,
        };
        match command {
            Command::Load(scene) => self.load(scene),
            Command::Play(playing) => course.playing = playing,
            Command::Step => course.steps += 1,
            other => {
                course.stale = true;
                let Some(stage) = &mut course.stage else { return };
                if let Err(error) = change(stage, other) {
                    self.say(News::Error(error.to_string()));
                }
            }
        }
    }

    /// Loads on a thread of its own, so that what plays goes on.
    fn load(&self, scene: Box<Scene>) {
        let own = self.own.clone();
        let job = move || {
            let loaded = Stage::new(&scene).map(Box::new);
            // Nobody waits for it any more when the window is closed.
            let _ = own.send(Message::Loaded(loaded));
        };
        if let Err(error) = std::thread::Builder::new().name("loading".to_owned()).spawn(job) {
            self.say(News::Error(Error::Thread(error).to_string()));
        }
    }

    /// Simulates and draws one frame, as far as there is anything to do.
    fn frame(&self, course: &mut Course) -> Result<(), Error> {
        let Some(stage) = &mut course.stage else { return Ok(()) };
        let gone = |Gone| Error::WorkerGone;
        let mut step = None;
        if (course.playing || course.steps > 0) && stage.worker.started() == 0 {
            stage.start().map_err(gone)?;
        }
        while stage.worker.started() > 0 {
            let (reports, notes) = stage.take().map_err(gone)?;
            notes.into_iter().for_each(|note| self.say(News::Note(note)));
            step = reports?.pop().or(step);
            course.steps = course.steps.saturating_sub(1);
            course.stale = true;
        }
        if !course.stale {
            return Ok(());
        }
        if course.playing {
            stage.start().map_err(gone)?;
        }
        let (picture, drawing) = stage.draw()?;
        std::mem::take(&mut stage.studio.painter.notes)
            .into_iter()
            .for_each(|note| self.say(News::Note(note)));
        course.stale = false;
        course.frame += 1;
        let places = [stage.simulated_on.clone(), place(stage.studio.painter.gpu())];
        self.show(Shown { picture, frame: course.frame, drawing, step, places });
        Ok(())
    }

    fn say(&self, news: News) {
        self.out.lock().unwrap_or_else(PoisonError::into_inner).news.push_back(news);
        (self.wake)();
    }

    fn show(&self, shown: Shown) {
        let mut out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        // A step that nobody saw is still told.
        let unseen = out.shown.take().and_then(|old| old.step);
        out.shown = Some(Shown { step: shown.step.clone().or(unseen), ..shown });
        drop(out);
        (self.wake)();
    }
}

/// Does what a command says to what is on stage.
fn change(stage: &mut Stage, command: Command) -> Result<(), Error> {
    let gone = |Gone| Error::WorkerGone;
    match command {
        Command::Camera(camera) => camera.validate().map(|()| stage.camera = camera)?,
        Command::Look(look) => look.validate().map(|()| stage.look = *look)?,
        Command::BodyLook(look) => look.validate().map(|()| stage.studio.body_look = look)?,
        Command::Lights(lights) => {
            lights.iter().try_for_each(Light::validate)?;
            stage.studio.lights = lights;
        }
        Command::LevelOfDetail(level) => level.validate().map(|()| stage.studio.level_of_detail = level)?,
        Command::Picture(settings) => stage.studio.painter.set_picture(&settings)?,
        Command::Wind(wind) => stage.wind = wind,
        Command::Motion(motion) => {
            stage.motion = motion;
            stage.time = 0.0;
        }
        Command::Turn(yaw, pitch) => stage.turn = [yaw, pitch],
        Command::Settings(settings) => stage
            .act(Box::new(move |simulation| simulation.engine.set_settings(&settings).map(|()| Vec::new())))
            .map_err(gone)?,
        Command::Length(scale) => {
            let scales = vec![scale; stage.studio.guides.strand_count()];
            let act = move |simulation: &mut Simulation| {
                simulation.engine.set_length_scale(&scales).map(|()| Vec::new())
            };
            stage.act(Box::new(act)).map_err(gone)?;
        }
        Command::Reset => {
            let pose = turned(stage.motion.pose(stage.time, stage.pivot), stage.turn, stage.pivot);
            let act = move |simulation: &mut Simulation| simulation.reset(pose).map(|()| Vec::new());
            stage.act(Box::new(act)).map_err(gone)?;
        }
        Command::Load(_) | Command::Play(_) | Command::Step => {}
    }
    Ok(())
}
