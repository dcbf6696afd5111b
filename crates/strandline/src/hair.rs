use std::path::Path;

use glam::Vec3;

use crate::{
    BoundStrands, Devices, Error, Ray, Scene,
    body::{Aabb, Collider, Mesh, Pose},
    devices::{Opened, Pair, place},
    engine::Engine,
    gpu::Gpu,
    groom::{Groom, Guides},
    painter::Painter,
    prepare::{self, Prepared},
    render::{
        BodyLook, Camera, FrameInput, FrameReport, LevelOfDetail, Light, Look, Picture, PictureSettings,
        gpu::DevicePoints,
    },
    sim::{Model, Settings, State, StepReport},
    simulation::{Moment, Simulation},
};

/// Points of a guide when nothing else is said.
const POINTS_PER_STRAND: usize = 16;

/// A head of hair that moves and can be drawn: simulator and renderer in one.
pub struct Hair {
    simulation: Simulation,
    studio: Studio,
    moment: Moment,
    /// Velocity of the air \[m/s\], world space.
    pub wind: Vec3,
    /// The lights; two to begin with.
    pub lights: Vec<Light>,
    /// Colour of the body.
    pub body_look: BodyLook,
    /// How detail falls with distance.
    pub level_of_detail: LevelOfDetail,
}

/// What draws, and everything that is drawn but the hair itself.
pub(crate) struct Studio {
    pub guides: Guides,
    pub bounds: Aabb,
    pub painter: Painter,
    pub lights: Vec<Light>,
    pub body_look: BodyLook,
    pub level_of_detail: LevelOfDetail,
}

impl Studio {
    /// Draws a moment, on the CPU when the GPU fails and that is wanted.
    pub fn draw(
        &mut self,
        moment: &Moment,
        camera: &Camera,
        look: &Look,
    ) -> Result<(Picture, FrameReport), Error> {
        self.draw_points(moment, moment.device_points(), camera, look)
    }

    fn draw_points(
        &mut self,
        moment: &Moment,
        points: Option<DevicePoints>,
        camera: &Camera,
        look: &Look,
    ) -> Result<(Picture, FrameReport), Error> {
        let input = FrameInput {
            positions: &moment.positions,
            world_from_head: moment.world_from_head,
            camera,
            look,
            body_look: &self.body_look,
            lights: &self.lights,
            level_of_detail: &self.level_of_detail,
        };
        let failure = match self.painter.draw(&input, points) {
            Ok(drawn) => return Ok(drawn),
            Err(failure) => failure,
        };
        self.painter.recover_from(failure)?;
        Ok(self.painter.draw(&input, None)?)
    }
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
        Self::placed(pair, guides, None, mesh, colliders, settings)
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
        Self::placed(pair, guides, None, mesh, colliders, settings)
    }

    fn placed(
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
            lights: Vec::new(),
            body_look: BodyLook::default(),
            level_of_detail: LevelOfDetail::default(),
        };
        Ok(Self {
            simulation: Simulation::new(engine, settings.time_step),
            studio,
            moment: Moment::default(),
            lights: Look::default().lights(prepare::center(bounds)),
            wind: Vec3::ZERO,
            body_look: BodyLook::default(),
            level_of_detail: LevelOfDetail::default(),
        })
    }

    /// The two that a [`Player`](crate::Player) lets work side by side.
    pub(crate) fn into_parts(mut self) -> (Simulation, Studio) {
        self.set_stage();
        (self.simulation.with_threads(), self.studio)
    }

    /// Hands what a user may have changed to the studio.
    fn set_stage(&mut self) {
        self.studio.lights.clone_from(&self.lights);
        self.studio.body_look = self.body_look;
        self.studio.level_of_detail = self.level_of_detail;
    }

    /// Everything of a scene but its film and its devices: these are given, `scene.devices` for those of the file.
    ///
    /// # Errors
    /// A setting of the scene outside its range.
    pub fn from_scene(scene: &Scene, prepared: Prepared, devices: impl Into<Devices>) -> Result<Self, Error> {
        scene.check()?; // what only pictures need too, before the first one is drawn
        let Prepared { guides, bound, mesh, colliders, head, pose, scene: chosen, .. } = prepared;
        let pair = devices.into().open()?;
        let mut hair = Self::placed(pair, guides, bound, mesh.as_ref(), colliders, &scene.simulation)?;
        hair.lights = scene.look.lights(prepare::center(hair.studio.bounds));
        // A picture of surroundings, which was loaded when the scene was prepared, lights it alone.
        if !scene.lights.is_empty() || chosen.look.surroundings.is_some() {
            hair.lights.clone_from(&scene.lights);
        }
        hair.body_look = scene.body_look;
        hair.level_of_detail = scene.level_of_detail;
        hair.set_picture(&scene.picture)?;
        if scene.groom.length != 1.0 {
            hair.set_length_scale(&vec![scene.groom.length; hair.guides().strand_count()])?;
        }
        // A head that is turned at first does not whip its hair there.
        let start = head.pose(scene.film.start);
        match &pose {
            Some(pose) => hair.simulation.place(pose)?,
            None if start != Pose::IDENTITY => hair.simulation.reset(start)?,
            None => {}
        }
        Ok(hair)
    }

    /// Lets `seconds` pass while the head moves evenly to `world_from_head`. Steps have a fixed
    /// length, so zero or more of them happen; what is left over counts the next time.
    /// Returns one report a step.
    ///
    /// # Errors
    /// More than a million steps at once; or the GPU failed and [`Hair::set_fall_back`] was not asked for. The
    /// hair keeps its last state.
    pub fn step(&mut self, seconds: f64, world_from_head: &Pose) -> Result<Vec<StepReport>, Error> {
        let (start, end) = (self.simulation.end(), *world_from_head);
        self.step_along(seconds, |share| start.toward(&end, share))
    }

    /// As [`Hair::step`], with the head's pose for each share (0 to 1) of the time that passes.
    ///
    /// # Errors
    /// As [`Hair::step`].
    pub fn step_along(&mut self, seconds: f64, pose: impl Fn(f32) -> Pose) -> Result<Vec<StepReport>, Error> {
        let wind = self.wind;
        Ok(self.simulation.step_along(seconds, &|share| (pose(share), wind))?)
    }

    /// Takes hair into a hand, and lets go of what it held: the strands that come within `radius` \[m\]
    /// of `hand` \[m\], world space, each at its nearest point. Returns how many there are.
    ///
    /// # Errors
    /// The GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, Error> {
        Ok(self.simulation.grab(hand, radius)?)
    }

    /// The hair that a line of sight meets first before the body \[m\], world space: where a hand takes
    /// what lies within `radius` \[m\] of it. The picture of [`Ray::new`] is the one of now.
    ///
    /// # Errors
    /// As [`Hair::grab`].
    pub fn pick(&mut self, ray: &Ray, radius: f32) -> Result<Option<Vec3>, Error> {
        self.simulation.show(&mut self.moment)?;
        let guides = &self.studio.guides;
        let body = self.studio.painter.mesh().map(|mesh| (mesh, &self.moment.world_from_head));
        let shape = [guides.strand_count(), guides.points_per_strand()];
        Ok(ray.hair(&self.moment.positions, shape, radius, body).map(|picked| picked.point))
    }

    /// Moves the hand to a place \[m\], world space, evenly over the next [`Hair::step`].
    pub fn move_hand(&mut self, hand: Vec3) {
        self.simulation.move_hand(hand);
    }

    /// Lets go of the hair in the hand.
    ///
    /// # Errors
    /// As [`Hair::grab`].
    pub fn release(&mut self) -> Result<(), Error> {
        Ok(self.simulation.release()?)
    }

    /// Whether the hair goes on on the CPU, from its last state, when the GPU fails; it does for
    /// [`Backend::Auto`](crate::Backend::Auto).
    pub fn set_fall_back(&mut self, fall_back: bool) {
        self.simulation.engine.fall_back = fall_back;
        self.studio.painter.fall_back = fall_back;
    }

    /// The device that the hair is simulated on; none on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.simulation.engine.gpu()
    }

    /// Where the hair is simulated: cpu, or the adapter's number and name.
    pub fn simulated_on(&self) -> String {
        place(self.gpu())
    }

    /// Where pictures are drawn, likewise.
    pub fn drawn_on(&self) -> String {
        self.studio.painter.drawn_on()
    }

    /// What happened to the backend since the last call, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        let mut notes = self.simulation.engine.take_notes();
        notes.append(&mut self.studio.painter.notes);
        notes
    }

    /// Changes how the hair moves; it goes on as it is.
    ///
    /// # Errors
    /// A setting outside its range, then nothing changes; or the GPU failed.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), Error> {
        Ok(self.simulation.set_settings(settings)?)
    }

    /// Draws the hair as it is now.
    ///
    /// # Errors
    /// A setting outside its range; the GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn picture(&mut self, camera: &Camera, look: &Look) -> Result<Picture, Error> {
        Ok(self.picture_with_report(camera, look)?.0)
    }

    /// Draws the hair as it is now, and says what it cost.
    ///
    /// # Errors
    /// As [`Hair::picture`].
    pub fn picture_with_report(
        &mut self,
        camera: &Camera,
        look: &Look,
    ) -> Result<(Picture, FrameReport), Error> {
        self.simulation.show(&mut self.moment)?;
        self.set_stage();
        let points = self.simulation.device_points(self.studio.painter.gpu());
        self.studio.draw_points(&self.moment, points, camera, look)
    }

    /// Colours hair by the layer of a light's opacity map in which it lies instead of lighting it, from the
    /// next picture on [Chen2011 fig. 8]: red, green and blue from the first layer to the third, grey behind
    /// it. `None`, the default, lights it, and so does a light without shadow.
    pub fn show_layers(&mut self, light: Option<usize>) {
        self.studio.painter.layers_of = light;
    }

    /// The opacity map of a light as it was for the last picture [Chen2011 fig. 9]: the share of light that
    /// its first layer takes away as red, its first two as green, all three as blue, so that the first is
    /// white, the second cyan and the third blue. `None` for a light without shadow, for a number that no
    /// light has, and before the first picture.
    ///
    /// # Errors
    /// The GPU that drew it was lost.
    pub fn opacity_map(&self, light: usize) -> Result<Option<Picture>, Error> {
        Ok(self.studio.painter.maps(light)?.map(|[opacity, _]| opacity))
    }

    /// The depth of the first hair in that map as grey, white the nearest; `None` as there.
    ///
    /// # Errors
    /// As there.
    pub fn depth_map(&self, light: usize) -> Result<Option<Picture>, Error> {
        Ok(self.studio.painter.maps(light)?.map(|[_, depth]| depth))
    }

    /// Changes size and finish of the pictures; where they are drawn stays.
    ///
    /// # Errors
    /// A setting outside its range, or more than the GPU holds; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), Error> {
        Ok(self.studio.painter.set_picture(settings)?)
    }

    /// Scales the length of every strand at run time, near its tip only, shape `[strand]`: shorter or longer
    /// than it was made [Chen2011 fig. 45]. Its mass follows.
    ///
    /// # Errors
    /// Another number of scales than strands, or a scale outside 0.05 to 2.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), Error> {
        Ok(self.simulation.engine.set_length_scale(scales)?)
    }

    /// The simulated strands at rest.
    pub fn guides(&self) -> &Guides {
        &self.studio.guides
    }

    /// The state of the simulation; a GPU is waited for where it has gone on since it was last asked.
    ///
    /// # Errors
    /// The GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn state(&mut self) -> Result<&State, Error> {
        Ok(self.simulation.engine.state()?)
    }

    /// Saves where the hair is and how it moves: what `groom.pose` of a scene names. Four tensors of the
    /// safetensors format, 32-bit floats: `positions` \[m\], `velocities` \[m/s\] and `corrections`, what the
    /// next step's prediction adds to them \[m/s\], world space, shape `[strand][point][3]`; `world_from_head`, shape `[7]`, a unit quaternion x, y, z, w and a translation
    /// \[m\]. A hand that holds hair is not in it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save_pose(&mut self, path: &Path) -> Result<(), Error> {
        let file = self.simulation.hair_pose()?.write(path)?;
        file.keep().map_err(Error::save("the hair", path))
    }

    /// The settings of the simulation.
    pub fn settings(&self) -> &Settings {
        self.simulation.engine.model().settings()
    }

    /// The box around hair and body at rest \[m\], head space.
    pub fn bounds(&self) -> Aabb {
        self.studio.bounds
    }
}
