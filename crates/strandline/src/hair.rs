use glam::Vec3;

use crate::{
    Devices, Error, Scene,
    body::{Aabb, Collider, Mesh, Pose},
    devices::{Opened, Pair},
    engine::Engine,
    gpu::Gpu,
    groom::{Groom, Guides, Vec3Lanes},
    painter::Painter,
    prepare::{self, Prepared},
    render::{
        BodyLook, Camera, FrameInput, FrameReport, LevelOfDetail, Light, Look, Picture, PictureSettings,
        gpu::DevicePoints,
    },
    sim::{Clock, Drive, Settings, Solver, State, StepReport},
};

/// Points of a guide when nothing else is said.
const POINTS_PER_STRAND: usize = 16;

/// A head of hair that moves and can be drawn: solver, state and renderer in one.
pub struct Hair {
    guides: Guides,
    bounds: Aabb,
    engine: Engine,
    clock: Clock,
    /// Where the picture lies between the last two states.
    share: f32,
    /// Poses of the head at the last two states, and where the last call of `step` ended.
    poses: [Pose; 2],
    end: Pose,
    shown: Vec<Vec3Lanes>,
    painter: Painter,
    /// Velocity of the air \[m/s\], world space.
    pub wind: Vec3,
    /// The lights; three to begin with.
    pub lights: Vec<Light>,
    /// Colour of the body.
    pub body_look: BodyLook,
    /// How detail falls with distance.
    pub level_of_detail: LevelOfDetail,
}

impl Hair {
    /// Hair of a groom, without a body.
    ///
    /// # Errors
    /// A setting outside its range, or a groom without strands.
    pub fn new(devices: impl Into<Devices>, groom: &Groom, settings: &Settings) -> Result<Self, Error> {
        let guides = Guides::resample(groom, POINTS_PER_STRAND)?;
        Self::with_body(devices, guides, None, Vec::new(), settings)
    }

    /// Guides on a body: its drawn mesh, and the solids that hair hits.
    ///
    /// # Errors
    /// A setting outside its range, or a GPU that is asked for by name and not there.
    pub fn with_body(
        devices: impl Into<Devices>,
        guides: Guides,
        mesh: Option<&Mesh>,
        colliders: Vec<Collider>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let pair = devices.into().open()?;
        Self::placed(pair, guides, mesh, colliders, settings)
    }

    /// As [`Hair::with_body`], simulated and drawn on a device that the host owns.
    ///
    /// # Errors
    /// A setting outside its range, or whatever the device refuses.
    pub fn with_device(
        gpu: &Gpu,
        guides: Guides,
        mesh: Option<&Mesh>,
        colliders: Vec<Collider>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let opened = || Opened { gpu: Some(gpu.clone()), fall_back: false };
        let pair = Pair { simulation: opened(), pictures: opened(), notes: Vec::new() };
        Self::placed(pair, guides, mesh, colliders, settings)
    }

    fn placed(
        devices: Pair,
        guides: Guides,
        mesh: Option<&Mesh>,
        colliders: Vec<Collider>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let Pair { simulation: Opened { gpu, fall_back }, pictures, notes } = devices;
        let mut engine = Engine::new(gpu.as_ref(), Solver::new(&guides, settings, colliders)?, fall_back)?;
        engine.notes.extend(notes);
        let bounds = prepare::bounds(&guides, mesh);
        Ok(Self {
            shown: guides.positions().to_vec(),
            lights: Light::three_point(prepare::center(bounds)).to_vec(),
            painter: Painter::new(pictures, &guides, mesh)?,
            clock: Clock::new(settings.time_step),
            share: 1.0,
            poses: [Pose::IDENTITY; 2],
            end: Pose::IDENTITY,
            wind: Vec3::ZERO,
            body_look: BodyLook::default(),
            level_of_detail: LevelOfDetail::default(),
            guides,
            bounds,
            engine,
        })
    }

    /// All that a scene names.
    ///
    /// # Errors
    /// A setting of the scene outside its range.
    pub fn from_scene(scene: &Scene, prepared: Prepared, devices: impl Into<Devices>) -> Result<Self, Error> {
        let Prepared { guides, mesh, colliders, .. } = prepared;
        let mut hair = Self::with_body(devices, guides, mesh.as_ref(), colliders, &scene.simulation)?;
        if !scene.lights.is_empty() {
            hair.lights.clone_from(&scene.lights);
        }
        hair.body_look = scene.body_look;
        hair.level_of_detail = scene.level_of_detail;
        hair.set_picture(&scene.picture)?;
        Ok(hair)
    }

    /// Lets `seconds` pass while the head moves evenly to `world_from_head`. Steps have a fixed
    /// length, so zero or more of them happen; a frame longer than 16 steps slows time down.
    /// Returns one report a step.
    ///
    /// # Errors
    /// The GPU failed and [`Hair::set_fall_back`] was not asked for; the hair keeps its last state.
    pub fn step(&mut self, seconds: f64, world_from_head: &Pose) -> Result<Vec<StepReport>, Error> {
        let (start, end) = (self.end, *world_from_head);
        self.step_along(seconds, |share| start.toward(&end, share))
    }

    /// As [`Hair::step`], with the head's pose for each share (0 to 1) of the time that passes.
    ///
    /// # Errors
    /// As [`Hair::step`].
    pub fn step_along(&mut self, seconds: f64, pose: impl Fn(f32) -> Pose) -> Result<Vec<StepReport>, Error> {
        let before = self.clock;
        let ticks = self.clock.advance(seconds);
        let waited = f64::from(ticks.share) * self.clock.step_time(1);
        let drive = |step| {
            // The last step ends `waited` before the end of the frame.
            let left = self.clock.step_time(u64::from(ticks.count - 1 - step)) + waited;
            let share = (1.0 - left / seconds).clamp(0.0, 1.0);
            Drive { world_from_head: pose(share as f32), wind: self.wind }
        };
        let drives: Vec<Drive> = (0..ticks.count).map(drive).collect();
        let reports = match self.engine.run(&drives) {
            Ok(reports) => reports,
            Err(error) => {
                self.clock = before;
                return Err(error.into());
            }
        };
        for drive in &drives {
            self.poses = [self.poses[1], drive.world_from_head];
        }
        self.share = ticks.share;
        self.end = pose(1.0);
        Ok(reports)
    }

    /// Whether the hair goes on on the CPU, from its last state, when the GPU fails; it does for
    /// [`Backend::Auto`](crate::Backend::Auto).
    pub fn set_fall_back(&mut self, fall_back: bool) {
        self.engine.fall_back = fall_back;
        self.painter.fall_back = fall_back;
    }

    /// The device that the hair is simulated on; none on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.engine.gpu()
    }

    /// Where the hair is simulated: cpu, or the adapter's number and name.
    pub fn simulated_on(&self) -> String {
        place(self.gpu())
    }

    /// Where pictures are drawn, likewise.
    pub fn drawn_on(&self) -> String {
        place(self.painter.gpu())
    }

    /// What happened to the backend since the last call, for a person to read.
    pub fn take_notes(&mut self) -> Vec<String> {
        let mut notes = self.engine.take_notes();
        notes.append(&mut self.painter.notes);
        notes
    }

    /// Changes how the hair moves; it goes on as it is.
    ///
    /// # Errors
    /// A setting outside its range, then nothing changes; or the GPU failed.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), Error> {
        Ok(self.engine.set_settings(settings)?)
    }

    /// Draws the hair as it is now.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn picture(&mut self, camera: &Camera, look: &Look) -> Result<Picture, Error> {
        Ok(self.picture_with_report(camera, look)?.0)
    }

    /// Draws the hair as it is now, and says what it cost.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn picture_with_report(
        &mut self,
        camera: &Camera,
        look: &Look,
    ) -> Result<(Picture, FrameReport), Error> {
        let points = device_points(&self.engine, &self.painter, self.share);
        if points.is_none() {
            self.engine.state().interpolated(self.share, &mut self.shown);
        }
        let input = FrameInput {
            positions: &self.shown,
            world_from_head: self.poses[0].toward(&self.poses[1], self.share),
            camera,
            look,
            body_look: &self.body_look,
            lights: &self.lights,
            level_of_detail: &self.level_of_detail,
        };
        match self.painter.draw(&input, points) {
            Ok(drawn) => Ok(drawn),
            Err(failure) => {
                self.painter.recover_from(failure)?;
                self.picture_with_report(camera, look)
            }
        }
    }

    /// The opacity map of a light as it was for the last picture: the share of light that each of its
    /// three layers takes away, as red, green and blue [Chen2011 fig. 8, 9]. `None` for a light
    /// without shadow, for a number that no light has, and before the first picture.
    pub fn opacity_map(&self, light: usize) -> Option<Picture> {
        let [opacity, _] = self.painter.maps(light).ok()??;
        Some(opacity)
    }

    /// The depth of the first hair in that map as grey, white the nearest; `None` as there.
    pub fn depth_map(&self, light: usize) -> Option<Picture> {
        let [_, depth] = self.painter.maps(light).ok()??;
        Some(depth)
    }

    /// Changes size and finish of the pictures.
    ///
    /// # Errors
    /// A setting outside its range; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), Error> {
        Ok(self.painter.set_picture(settings)?)
    }

    /// Scales the length of every strand at run time, near its tip only, shape `[strand]`
    /// [Chen2011 fig. 45].
    ///
    /// # Errors
    /// Another number of scales than strands, or a scale outside 0.05 to 1.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), Error> {
        Ok(self.engine.set_length_scale(scales)?)
    }

    /// The simulated strands at rest.
    pub fn guides(&self) -> &Guides {
        &self.guides
    }

    /// The state of the simulation.
    pub fn state(&self) -> &State {
        self.engine.state()
    }

    /// The settings of the simulation.
    pub fn settings(&self) -> &Settings {
        self.engine.solver().settings()
    }

    /// The box around hair and body at rest \[m\], head space.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
}

fn place(gpu: Option<&Gpu>) -> String {
    gpu.map_or_else(|| "cpu".to_owned(), |gpu| gpu.adapter().to_string())
}

/// The points of the simulation, where the pictures are drawn on the device that they lie on.
fn device_points<'a>(engine: &'a Engine, painter: &Painter, share: f32) -> Option<DevicePoints<'a>> {
    let [after, before] = engine.device_points()?;
    let is_same = painter.gpu()?.device() == engine.gpu()?.device();
    is_same.then_some(DevicePoints { before, after, share })
}
