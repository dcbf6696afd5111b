//! A scene on stage: what is simulated on one thread and drawn on another.

use std::io::Write;
use std::path::{Path, PathBuf};

use glam::Vec3;
use strandline_base::{Group, WholeFile};

use super::messages::{Command, FRAME, MOST_STEPS};
use crate::{
    Error, Hair, HeadMotion, Ray, Scene,
    body::Aabb,
    devices::place,
    hair::Studio,
    prepare::Prepared,
    render::{
        Camera, FrameReport, LevelOfDetail, Light, Look, Picture, PictureSettings, memory::check_lights,
    },
    scene::{MotionSection, WindSection},
    sim::{SimError, StepReport},
    simulation::{Act, Done, Job, Moment, Simulation},
    worker::{Gone, Worker},
};

/// What a job led to: its reports, what a person should read, and whether it was a frame.
pub(super) type Taken = (Result<Vec<StepReport>, SimError>, Vec<String>, bool);

/// A scene on stage.
pub(super) struct Stage {
    pub worker: Worker<Simulation>,
    pub studio: Studio,
    pub camera: Camera,
    look: Look,
    level_of_detail: LevelOfDetail,
    picture: PictureSettings,
    /// Whether pictures are simpler than these three say.
    draft: bool,
    wind: WindSection,
    motion: MotionSection,
    head: HeadMotion,
    /// Time of motion and wind \[s\], at their beginning and at the end of the last frame that was taken.
    begun: f64,
    time: f64,
    /// Whether the frame on its way moves that time on: not after it went back to its beginning.
    counts: bool,
    /// Where the hand is that holds hair \[m\], world space.
    hand: Option<Vec3>,
    pub grabbed: usize,
    /// Commands that what is shown has heard.
    pub felt: u64,
    spare: Vec<Moment>,
    shown: Option<Moment>,
    pub simulated_on: String,
    pub bounds: Aabb,
    /// The scene as it was loaded, with what it left open.
    pub scene: Box<Scene>,
    pub notes: Vec<String>,
}

/// A simpler picture has at most so many follow strands of a guide and segments of a span, shadow maps of so many
/// texels a side, one place on each light, and light that is scattered so often; it is half as wide and high, with
/// the samples that keep its edges smooth.
const FEW_STRANDS: u32 = 8;
const FEW_SEGMENTS: u32 = 2;
const SMALL_MAP: u32 = 256;
const FEW_SCATTERINGS: u32 = 3;

impl Stage {
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let mut prepared = Prepared::new(scene)?;
        let (head, bounds) = (prepared.head.clone(), prepared.bounds);
        let mut notes = std::mem::take(&mut prepared.notes);
        let fitted = prepared.scene.clone();
        let scene = &fitted;
        let aspect = scene.picture.width as f32 / scene.picture.height as f32;
        let camera = prepared.camera(aspect);
        let mut hair = Hair::from_scene(scene, prepared, scene.devices)?;
        notes.extend(hair.take_notes());
        let (mut simulation, studio) = hair.into_parts();
        let mut shown = Moment::default();
        simulation.show(&mut shown)?;
        let simulated_on = place(simulation.engine.gpu());
        Ok(Self {
            worker: Worker::new(simulation).map_err(Error::Thread)?,
            studio,
            camera,
            look: scene.look.clone(),
            level_of_detail: scene.level_of_detail,
            picture: scene.picture,
            draft: false,
            wind: scene.wind,
            motion: scene.motion.clone(),
            head,
            begun: scene.film.start,
            time: scene.film.start,
            counts: true,
            hand: None,
            grabbed: 0,
            felt: 0,
            spare: vec![Moment::default()],
            shown: Some(shown),
            simulated_on,
            bounds,
            scene: fitted.clone().into(),
            notes,
        })
    }

    /// Starts one frame.
    ///
    /// # Errors
    /// The simulation's thread is no more.
    pub fn start(&mut self, heard: u64) -> Result<(), Gone> {
        let (begin, hand, wind, head) = (self.time, self.hand, self.wind, self.head.clone());
        self.counts = true;
        let act: Act = Box::new(move |simulation| {
            let start = simulation.end();
            hand.into_iter().for_each(|hand| simulation.move_hand(hand));
            let seconds = FRAME.min(MOST_STEPS * simulation.time_step());
            // The head may have been turned since.
            let end = head.pose(begin + seconds);
            simulation.step_along(seconds, &|share| {
                (start.toward(&end, share), wind.at(begin + seconds * f64::from(share)))
            })
        });
        self.hand_over(act, true, heard)
    }

    fn act(&mut self, act: Act) -> Result<(), Gone> {
        self.hand_over(act, false, 0)
    }

    fn hand_over(&mut self, act: Act, is_frame: bool, heard: u64) -> Result<(), Gone> {
        let (gpu, moment) = (self.studio.painter.gpu().cloned(), self.spare.pop().unwrap_or_default());
        self.worker.start(Job { act, gpu, moment, is_frame, heard })
    }

    /// Takes the next result; the moment shown before is free.
    ///
    /// # Errors
    /// The simulation's thread is no more.
    pub fn take(&mut self) -> Result<Taken, Gone> {
        let Done { moment, reports, notes, seconds, grabbed, is_frame, heard, place } =
            self.worker.finish()?;
        if is_frame && self.counts {
            self.time += seconds;
        }
        (self.simulated_on, self.grabbed, self.felt) = (place, grabbed, self.felt.max(heard));
        self.spare.extend(self.shown.replace(moment));
        Ok((reports, notes, is_frame))
    }

    /// Saves a scene that begins with the hair as it is, and with the motion at the time that it is at; all
    /// results of the simulation have been taken.
    ///
    /// # Errors
    /// A file cannot be written; then what was there before stays, unless only the last renaming fails.
    pub fn save(&self, mut scene: Scene, path: &Path) -> Result<(), Error> {
        let pose_path = pose_path(path);
        let mut simulation = self.worker.work();
        let pose = simulation.hair_pose()?.write(&pose_path)?;
        // What is shown lies a step behind the end of a frame.
        let step = f64::from(simulation.engine.model().settings().time_step);
        drop(simulation);
        scene.film.start = (self.time - step).max(self.begun);
        scene.groom.pose = pose_path.file_name().map(PathBuf::from);
        let text = scene.to_toml();
        let scene = WholeFile::write(path, |file| file.write_all(text.as_bytes()));
        let failed = |path| Error::save("the scene", path);
        let scene = scene.map_err(failed(path))?;
        pose.keep().map_err(Error::save("the hair", &pose_path))?;
        scene.keep().map_err(failed(path))
    }

    /// Draws what is to be shown, simpler where `draft`.
    pub fn draw(&mut self, draft: bool) -> Result<(Picture, FrameReport), Error> {
        if self.draft != draft {
            self.studio.painter.set_picture(&self.picture_settings(draft))?;
            self.draft = draft;
        }
        let Some(moment) = &self.shown else { return Ok(Default::default()) };
        if !draft {
            self.studio.level_of_detail = self.level_of_detail;
            return self.studio.draw(moment, &self.camera, &self.look);
        }
        let segments_per_span = self.level_of_detail.segments_per_span.min(FEW_SEGMENTS);
        self.studio.level_of_detail = LevelOfDetail { segments_per_span, ..self.level_of_detail };
        let mut look = self.look.clone();
        look.follow_strands = look.follow_strands.min(FEW_STRANDS);
        look.shadow.map_size = look.shadow.map_size.min(SMALL_MAP);
        let scatterings = &mut look.fibre.chiang.scatterings;
        *scatterings = (*scatterings).min(FEW_SCATTERINGS);
        let one_place = |light: &Light| Light { samples: 1, ..*light };
        let simpler = self.studio.lights.iter().map(one_place).collect();
        let lights = std::mem::replace(&mut self.studio.lights, simpler);
        let drawn = self.studio.draw(moment, &self.camera, &look);
        self.studio.lights = lights;
        drawn
    }

    fn picture_settings(&self, draft: bool) -> PictureSettings {
        let PictureSettings { width, height, .. } = self.picture;
        let half = |side: u32| side.div_ceil(2);
        let small =
            PictureSettings { width: half(width), height: half(height), supersampling: 2, ..self.picture };
        if draft { small } else { self.picture }
    }

    /// Size and finish of the pictures.
    pub fn picture(&self) -> PictureSettings {
        self.picture
    }

    fn set_picture(&mut self, settings: PictureSettings) -> Result<(), Error> {
        let before = std::mem::replace(&mut self.picture, settings);
        // What is refused is refused at once, though it may be drawn only later.
        let tried = self.picture.validate().map_err(Error::from);
        let set = tried.and_then(|()| {
            let drawn = self.picture_settings(self.draft);
            Ok(self.studio.painter.set_picture(&drawn)?)
        });
        if set.is_err() {
            self.picture = before;
        }
        set
    }

    /// Takes the hair that a line of sight meets into the hand.
    fn grab(&mut self, ray: Ray, radius: f32) -> Result<(), Gone> {
        let Some(moment) = &self.shown else { return Ok(()) };
        let guides = &self.studio.guides;
        let body = self.studio.painter.mesh().map(|mesh| (mesh, &moment.world_from_head));
        let shape = [guides.strand_count(), guides.points_per_strand()];
        let Some(picked) = ray.hair(&moment.positions, shape, radius, body) else { return self.release() };
        self.hand = Some(picked.point);
        self.act(Box::new(move |simulation| {
            // The hair has moved on since it was seen.
            let now = simulation.engine.state()?.positions[picked.index].get(picked.lane);
            simulation.grab(now, radius).map(|_| Vec::new())
        }))
    }

    fn release(&mut self) -> Result<(), Gone> {
        match self.hand.take() {
            Some(_) => self.act(Box::new(|simulation| simulation.release().map(|()| Vec::new()))),
            None => Ok(()),
        }
    }

    /// Another motion of the head begins at its beginning; another turn does not disturb it.
    fn set_motion(&mut self, motion: MotionSection) -> Result<(), Error> {
        motion.check_as("motion")?;
        self.head = HeadMotion::new(&motion, self.head.pivot())?;
        if (motion.name, &motion.keyframes) != (self.motion.name, &self.motion.keyframes) {
            (self.begun, self.time, self.counts) = (0.0, 0.0, false);
        }
        self.motion = motion;
        Ok(())
    }

    /// Does what a command says.
    ///
    /// # Errors
    /// It cannot be done, and nothing has changed; or the simulation's thread is no more.
    pub fn change(&mut self, command: Command) -> Result<(), Error> {
        let gone = |Gone| Error::WorkerGone;
        match command {
            Command::Camera(camera) => camera.validate().map(|()| self.camera = camera)?,
            Command::Look(look) => look.validate().map(|()| self.look = *look)?,
            Command::BodyLook(look) => look.validate().map(|()| self.studio.body_look = look)?,
            Command::Lights(lights) => {
                check_lights(&lights)?;
                self.studio.lights = lights;
            }
            Command::LevelOfDetail(level) => level.validate().map(|()| self.level_of_detail = level)?,
            Command::Picture(settings) => self.set_picture(settings)?,
            Command::Wind(wind) => wind.check_as("wind").map(|()| self.wind = wind)?,
            Command::Motion(motion) => self.set_motion(*motion)?,
            Command::Drag(ray) => {
                let hand = self.hand.and_then(|hand| ray.at_depth_of(&self.camera, hand));
                self.hand = hand.or(self.hand);
            }
            Command::Grab(ray, radius) => self.grab(ray, radius).map_err(gone)?,
            Command::Release => self.release().map_err(gone)?,
            Command::Settings(settings) => self
                .act(Box::new(move |simulation| simulation.set_settings(&settings).map(|()| Vec::new())))
                .map_err(gone)?,
            Command::Length(scale) => self.set_length(scale).map_err(gone)?,
            Command::Reset => self.reset().map_err(gone)?,
            // What the desk does itself.
            Command::Load(_)
            | Command::Play(_)
            | Command::Step
            | Command::Save(..)
            | Command::Adapt(_)
            | Command::Record(_)
            | Command::StopRecording => {}
        }
        Ok(())
    }

    fn set_length(&mut self, scale: f32) -> Result<(), Gone> {
        let scales = vec![scale; self.studio.guides.strand_count()];
        self.act(Box::new(move |simulation| simulation.engine.set_length_scale(&scales).map(|()| Vec::new())))
    }

    fn reset(&mut self) -> Result<(), Gone> {
        (self.hand, self.begun, self.time, self.counts) = (None, 0.0, 0.0, false);
        let pose = self.head.pose(0.0);
        self.act(Box::new(move |simulation| simulation.reset(pose).map(|()| Vec::new())))
    }
}

/// Where the pose of a scene's hair is saved: beside it, and not over a file that is not its own.
fn pose_path(scene: &Path) -> PathBuf {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let before = Scene::load(scene).ok().and_then(|before| before.groom.pose).map(|pose| folder.join(pose));
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let name = |number: u32| match number {
        0 => format!("{stem}.safetensors"),
        number => format!("{stem}_{number}.safetensors"),
    };
    let mut paths = (0..).map(|number| folder.join(name(number)));
    paths.find(|path| !path.exists() || Some(path) == before.as_ref()).unwrap_or_default()
}
