mod files;
mod film;
mod hand;

use std::path::Path;

use glam::Vec3;

use crate::{
    Devices, Error, HeadMotion, Prepared, Scene, Sources,
    body::{Aabb, BodyFrame},
    gpu::Gpu,
    groom::Guides,
    prepare::center,
    render::{BodyLook, Camera, FrameReport, LevelOfDetail, Light, Look, Picture, PictureSettings},
    scene::devices::device_name,
    session::{Change, Inline, Session, film_timing::FilmTiming},
    sim::{Settings, State, StepReport},
    snapshot::files::write_pose,
};

/// A head of hair that moves and can be drawn: simulator and renderer in one.
pub struct Hair {
    session: Session<Inline>,
    /// Velocity of the air \[m/s\], world space.
    pub wind: Vec3,
    /// The state as it was last read, in the world, of hair that is simulated from another origin.
    moved_state: Option<State>,
    /// Reports of steps since the last frame that was written, from the first file on.
    unwritten: Option<Vec<StepReport>>,
    /// Timing of the scene's film, from its first frame on.
    timing: Option<FilmTiming>,
    /// Time of the frame of the film that is shown \[s\]; none after a step beside the film.
    played: Option<f64>,
}

impl Hair {
    /// Everything of a scene but its film, from files, on the devices that it names.
    ///
    /// # Errors
    /// A file that cannot be read, a setting outside its range, a device that is named and not there.
    pub fn open(scene: &Scene) -> Result<Self, Error> {
        Self::from_sources(scene, &Sources::default())
    }

    /// As [`Hair::open`], with grooms, meshes and maps from memory. Strands alone, without a body, are a scene whose
    /// `groom.file` names a groom of the sources.
    ///
    /// # Errors
    /// As [`Hair::open`]; a source that the scene does not name, or that is unusable.
    pub fn from_sources(scene: &Scene, sources: &Sources) -> Result<Self, Error> {
        Self::from_prepared(Prepared::from_sources(scene, sources)?, scene.devices)
    }

    /// A loaded scene on any devices. [`Prepared::scene`] holds the settings, chosen to fit the groom where the scene
    /// left them open.
    ///
    /// # Errors
    /// A setting of the scene outside its range; a device that is named and not there.
    pub fn from_prepared(prepared: Prepared, devices: impl Into<Devices>) -> Result<Self, Error> {
        Ok(Self::of(Session::open(prepared, devices.into())?))
    }

    /// A loaded scene on a device that the host owns ([`Gpu`]`::from_parts`), which draws and simulates it.
    ///
    /// # Errors
    /// A setting of the scene outside its range; whatever the device refuses.
    pub fn with_device(prepared: Prepared, gpu: &Gpu) -> Result<Self, Error> {
        Ok(Self::of(Session::open_with(prepared, gpu)?))
    }

    fn of(session: Session<Inline>) -> Self {
        Self { session, wind: Vec3::ZERO, moved_state: None, unwritten: None, timing: None, played: None }
    }

    /// Lets `seconds` pass while the body moves evenly to `body`: a [`BodyFrame`], or the pose of a rigid head. Steps
    /// have a fixed length, so zero or more of them happen; the rest of the time counts with the next call. Where calls are
    /// whole steps pictures show the last state, else the moment one step earlier, so that they are smooth.
    /// Returns one report a step; those of steps on a GPU when they have arrived, with a later call or from
    /// [`Hair::reports`].
    ///
    /// # Errors
    /// More than a million steps at once; or the GPU failed and [`Hair::set_fall_back`] was not asked for. The
    /// hair keeps its last state.
    pub fn step(&mut self, seconds: f64, body: impl Into<BodyFrame>) -> Result<Vec<StepReport>, Error> {
        let simulation = self.session.simulation();
        let (start, end): (BodyFrame, BodyFrame) = (simulation.end().clone(), body.into());
        let end = self.seen(end, seconds);
        self.run_along(seconds, &|share| start.toward(&end, share))
    }

    /// As [`Hair::step`], with the body for each share (0 to 1) of the time that passes.
    ///
    /// # Errors
    /// As [`Hair::step`].
    pub fn step_along<B: Into<BodyFrame>>(
        &mut self,
        seconds: f64,
        body: impl Fn(f32) -> B,
    ) -> Result<Vec<StepReport>, Error> {
        let (head, begin) = (self.session.head_from_origin().clone(), self.time());
        let seen = |share: f32, body: BodyFrame| {
            head.beside_solids(body.moved(-head.origin()), begin + seconds * f64::from(share))
        };
        self.run_along(seconds, &|share| seen(share, body(share).into()))
    }

    /// Time of the motion \[s\] at the end of the last step.
    fn time(&self) -> f64 {
        self.session.scene().film.start + self.session.simulation().passed
    }

    /// A body after `seconds` from now, seen from the origin of the simulation, with the solids beside it that have
    /// keyframes.
    fn seen(&self, body: BodyFrame, seconds: f64) -> BodyFrame {
        let head = self.session.head_from_origin();
        head.beside_solids(body.moved(-head.origin()), self.time() + seconds)
    }

    /// Lets time pass under a body that is seen from the origin of the simulation.
    fn run_along(&mut self, seconds: f64, body: &dyn Fn(f32) -> BodyFrame) -> Result<Vec<StepReport>, Error> {
        let wind = self.wind;
        self.played = None;
        let simulation = self.session.simulation_mut();
        let reports = simulation.step_along(seconds, &|share| (body(share), wind.into()))?;
        self.note_reports(&reports);
        Ok(reports)
    }

    /// Allows or forbids falling back to the CPU from the last state when the GPU fails; it is allowed for
    /// [`Backend::Auto`](crate::Backend::Auto).
    pub fn set_fall_back(&mut self, fall_back: bool) {
        self.session.set_fall_back(fall_back);
    }

    /// The device of the simulation; `None` on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.session.simulation().gpu()
    }

    /// Device of the simulation: cpu, or the adapter's number and name.
    pub fn simulated_on(&self) -> String {
        device_name(self.gpu())
    }

    /// Device of the pictures, likewise.
    pub fn drawn_on(&self) -> String {
        self.session.view().drawn_on()
    }

    /// Notes on the devices since the last call, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        self.session.take_notes()
    }

    /// The reports of all steps that were not returned yet; a GPU is waited for.
    ///
    /// # Errors
    /// As [`Hair::step`].
    pub fn reports(&mut self) -> Result<Vec<StepReport>, Error> {
        let reports = self.session.simulation_mut().reports()?;
        self.note_reports(&reports);
        Ok(reports)
    }

    /// Changes how the hair moves; its state stays.
    ///
    /// # Errors
    /// A setting outside its range, then nothing changes; or the GPU failed.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), Error> {
        Ok(self.session.simulation_mut().set_settings(settings)?)
    }

    /// Points of the guides as they are now \[m\], world space, shape `[strand][point]`: between the last two states, as
    /// pictures show them. A GPU is waited for.
    ///
    /// # Errors
    /// The GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn points(&mut self) -> Result<&[Vec3], Error> {
        self.session.show()?;
        self.session.points()
    }

    /// The scene, with the settings that it leaves open chosen to fit its groom.
    pub fn scene(&self) -> &Scene {
        self.session.scene()
    }

    /// The motion of the head in the scene.
    pub fn head(&self) -> &HeadMotion {
        self.session.head()
    }

    /// The view of the last picture; before the first that of the scene.
    pub fn camera(&self) -> &Camera {
        self.session.view().camera()
    }

    /// The look of the last picture; before the first that of the scene.
    pub fn look(&self) -> &Look {
        self.session.view().look()
    }

    /// The lights.
    pub fn lights(&self) -> &[Light] {
        self.session.view().lights()
    }

    /// The lights of a look on this hair, where a scene names none.
    pub fn lights_of(&self, look: &Look) -> Vec<Light> {
        look.lights(center(self.session.view().bounds()))
    }

    /// Changes the lights, from the next picture on.
    ///
    /// # Errors
    /// More lights than a picture may have, or a setting outside its range; the lights then stay.
    pub fn set_lights(&mut self, lights: Vec<Light>) -> Result<(), Error> {
        self.session.change(Change::Lights(lights))
    }

    /// The look of the body.
    pub fn body_look(&self) -> &BodyLook {
        self.session.view().body_look()
    }

    /// Changes the look of the body, from the next picture on.
    ///
    /// # Errors
    /// A setting outside its range; the look then stays.
    pub fn set_body_look(&mut self, look: BodyLook) -> Result<(), Error> {
        self.session.change(Change::BodyLook(look))
    }

    /// The rule by which detail follows distance and the size of a pixel.
    pub fn level_of_detail(&self) -> LevelOfDetail {
        self.session.view().level_of_detail()
    }

    /// Changes how detail follows distance and the size of a pixel, from the next picture on.
    ///
    /// # Errors
    /// A setting outside its range; the rule then stays.
    pub fn set_level_of_detail(&mut self, level: LevelOfDetail) -> Result<(), Error> {
        self.session.change(Change::LevelOfDetail(level))
    }

    /// Draws the current state.
    ///
    /// # Errors
    /// A setting outside its range; the GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn picture(&mut self, camera: &Camera, look: &Look) -> Result<Picture, Error> {
        Ok(self.picture_with_report(camera, look)?.0)
    }

    /// Draws the current state and reports the work of the picture.
    ///
    /// # Errors
    /// As [`Hair::picture`].
    pub fn picture_with_report(
        &mut self,
        camera: &Camera,
        look: &Look,
    ) -> Result<(Picture, FrameReport), Error> {
        self.session.show()?;
        self.session.set_camera(*camera);
        self.session.set_look(look.clone());
        self.session.picture(None)
    }

    /// Colours hair by the layer of a light's opacity map in which it lies instead of lighting it, from the
    /// next picture on [Chen2011 fig. 8]: red, green and blue from the first layer to the third, grey behind
    /// it. `None`, the default, lights it, and so does a light without shadow.
    pub fn show_layers(&mut self, light: Option<usize>) {
        self.session.show_layers(light);
    }

    /// The opacity map of a light as it was for the last picture [Chen2011 fig. 9]: the share of light that
    /// its first layer takes away as red, its first two as green, all three as blue, so that the first is
    /// white, the second cyan and the third blue. `None` for a light without shadow, for a number that no
    /// light has, and before the first picture.
    ///
    /// # Errors
    /// The GPU that drew it was lost.
    pub fn opacity_map(&self, light: usize) -> Result<Option<Picture>, Error> {
        Ok(self.session.view().maps(light)?.map(|[opacity, _]| opacity))
    }

    /// The depth of the first hair in that map as grey, white the nearest; `None` as there.
    ///
    /// # Errors
    /// As there.
    pub fn depth_map(&self, light: usize) -> Result<Option<Picture>, Error> {
        Ok(self.session.view().maps(light)?.map(|[_, depth]| depth))
    }

    /// Changes size and finish of the pictures; where they are drawn stays.
    ///
    /// # Errors
    /// A setting outside its range, or more than the GPU holds; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), Error> {
        self.session.change(Change::Picture(*settings))
    }

    /// Scales the length of every strand at run time, near its tip only, shape `[strand]`: shorter or longer
    /// than it was made [Chen2011 fig. 45]. Its mass follows.
    ///
    /// # Errors
    /// Another number of scales than strands, or a scale outside 0.05 to 2.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), Error> {
        Ok(self.session.simulation_mut().set_length_scale(scales)?)
    }

    /// The simulated strands at rest.
    pub fn guides(&self) -> &Guides {
        self.session.view().guides()
    }

    /// The state of the simulation. On a GPU this waits, unless nothing has moved since the last call.
    ///
    /// # Errors
    /// The GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn state(&mut self) -> Result<&State, Error> {
        let origin = self.session.simulation().origin;
        let state = self.session.simulation_mut().state()?;
        if origin == Vec3::ZERO {
            return Ok(state);
        }
        Ok(self.moved_state.insert(state.moved(origin)))
    }

    /// Saves positions and motion of hair and body, for `groom.pose` of a scene: a snapshot in a .npz, whose arrays
    /// docs/cache.md lists. A hand that holds hair is not in it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save_pose(&mut self, path: &Path) -> Result<(), Error> {
        let file = write_pose(&self.session.simulation_mut().hair_pose()?, path)?;
        file.keep().map_err(Error::save("the hair", path))
    }

    /// The settings of the simulation.
    pub fn settings(&self) -> &Settings {
        self.session.simulation().settings()
    }

    /// The box around hair and body at rest \[m\], head space.
    pub fn bounds(&self) -> Aabb {
        self.session.view().bounds()
    }
}
