use crate::mesh::Placement;
use crate::{
    Cache, Devices, Error, Out, OutSettings, Prepared, Scene, Sources, What, Written,
    cache::drawn,
    gpu::Gpu,
    groom::Guides,
    render::{Camera, Look, PictureSettings},
    scene::{camera_motion::CameraMotion, devices::device_name},
    session::worker::Worker,
    session::{Change, Event, Session, Simulation, Task, film_timing::FilmTiming},
    sim::{Drift, Measures, Settings, State, Stiffening},
};

/// Plays a scene: an iterator of events, frame after frame, until the film is over.
///
/// Two workers share the work [Chen2011 §5]: while one frame is drawn the next one is simulated on a
/// thread of its own, on another device or on the same.
pub struct Player {
    session: Session<Worker<Simulation>>,
    /// Changed by [`Player::set_settings`] before the next frame is simulated.
    change: Option<Settings>,
    timing: FilmTiming,
    /// Motion of the camera, where the scene has one and nobody has set another view.
    camera: Option<CameraMotion>,
    draw: bool,
    overlap: bool,
    frames: u32,
    /// Frames whose simulation was started, and taken.
    started: u32,
    taken: u32,
    /// True where a frame was taken that is to be drawn.
    undrawn: bool,
    /// True after the simulation failed.
    failed: bool,
    placement: Placement,
    notes: Vec<String>,
    /// File that frames are written to as they are made.
    out: Option<Out>,
    /// Cache that frames come from in place of the simulation.
    cache: Option<Cache>,
    /// True where no frame is begun any more.
    closing: bool,
}

impl Player {
    /// Loads a scene; `draw` false leaves the pictures out.
    ///
    /// # Errors
    /// Whatever the scene's parts refuse.
    pub fn new(scene: &Scene, devices: impl Into<Devices>, draw: bool) -> Result<Self, Error> {
        Self::from_prepared(Prepared::new(scene)?, devices, draw)
    }

    /// As [`Player::new`], with grooms, meshes and maps from memory.
    ///
    /// # Errors
    /// As [`Player::new`]; a source that the scene does not name, or that is unusable.
    pub fn from_sources(
        scene: &Scene,
        sources: &Sources,
        devices: impl Into<Devices>,
        draw: bool,
    ) -> Result<Self, Error> {
        Self::from_prepared(Prepared::from_sources(scene, sources)?, devices, draw)
    }

    /// Draws the frames of a cache in place of a simulation, as many as the film of the scene that it was made with
    /// has: its guides with the strands that hang on them, or its strands as they are.
    ///
    /// # Errors
    /// Whatever the scene's parts refuse; a cache of other hair.
    pub fn showing(scene: &Scene, devices: impl Into<Devices>, mut cache: Cache) -> Result<Self, Error> {
        let mut player = Self::from_prepared(drawn::prepared(scene, &mut cache)?, devices, true)?;
        if cache.what() == What::Guides {
            let guides = player.guides();
            cache.check_guides(guides.strand_count(), guides.points_per_strand())?;
        }
        player.frames = player.frames.min(u32::try_from(cache.len()).unwrap_or(u32::MAX));
        player.cache = Some(cache);
        Ok(player)
    }

    /// Plays a loaded scene; `draw` false leaves the pictures out.
    ///
    /// # Errors
    /// A setting of the scene outside its range; a device that is named and not there.
    pub fn from_prepared(
        mut prepared: Prepared,
        devices: impl Into<Devices>,
        draw: bool,
    ) -> Result<Self, Error> {
        let (mut notes, placement) = (std::mem::take(&mut prepared.notes), prepared.placement);
        let mut session = Session::open(prepared, devices.into())?;
        notes.extend(session.take_notes());
        let here = session.simulation().end().world_from_head();
        let timing = FilmTiming::new(session.scene(), session.head_from_origin().clone(), here);
        let frames = session.scene().film.frames;
        let camera = CameraMotion::new(&session.scene().camera.keyframes, *session.view().camera())?;
        Ok(Self {
            camera,
            session: session.beside()?,
            change: None,
            timing,
            draw,
            overlap: true,
            frames,
            started: 0,
            taken: 0,
            undrawn: false,
            failed: false,
            placement,
            notes,
            out: None,
            cache: None,
            closing: false,
        })
    }

    /// Writes every frame as it moves, from the next one on: see [`Player::close_out`]. The file has the strands that the
    /// scene draws, also those that guides carry, with the attributes of the groom.
    ///
    /// # Errors
    /// A name that no format has; a file or folder that cannot be written; more points than a file may have.
    pub fn set_out(&mut self, settings: &OutSettings) -> Result<(), Error> {
        if settings.first >= self.frames {
            let found = format!("frame {} is not in a film of {} frames", settings.first, self.frames);
            return Err(Error::cache(&settings.path, found));
        }
        self.out = Some({
            let body = self.timing.body(0.0).moved(self.session.head_from_origin().origin());
            self.session.begin_file(settings, &body)?
        });
        Ok(())
    }

    /// Resumes the run of a cache. Earlier frames emit no events; files that are written get them too.
    ///
    /// # Errors
    /// A cache of other hair or of another film, without a state, or of a film that was over; a file that cannot be
    /// written.
    pub fn resume(&mut self, cache: &mut Cache) -> Result<(), Error> {
        let made = self.session.resume(cache, self.frames, self.out.as_mut())?;
        self.notes.extend(self.session.take_notes());
        (self.started, self.taken) = (made, made);
        Ok(())
    }

    /// Ends what [`Player::set_out`] began; none without. A frame on its way is waited for and written, and a
    /// film that is not over leaves a file that it can be resumed from.
    ///
    /// # Errors
    /// The file cannot be written; what was written before stays.
    pub fn close_out(&mut self) -> Result<Option<Written>, Error> {
        self.closing = true;
        while self.out.is_some() && self.session.started() > 0 && !self.failed {
            self.take()?;
        }
        let Some(out) = self.out.take() else { return Ok(None) };
        self.session.end_file(out, self.taken, self.frames).map(Some)
    }

    /// Simulates each frame while the one before is drawn; on by default.
    pub fn set_overlap(&mut self, overlap: bool) {
        self.overlap = overlap;
    }

    /// Changes how the hair moves, from the next frame on whose simulation starts. The hair continues as it
    /// is; a setting outside its range ends the film with its error.
    pub fn set_settings(&mut self, settings: Settings) {
        self.change = Some(settings);
    }

    /// Changes size and finish of the pictures, from the next one on; where they are drawn stays.
    ///
    /// # Errors
    /// A setting outside its range, or more than the GPU holds; the settings then stay as they were.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), Error> {
        self.session.change(Change::Picture(*settings))
    }

    /// Changes the hair's look, from the next picture on.
    pub fn set_look(&mut self, look: Look) {
        self.session.set_look(look);
    }

    /// Changes the view, from the next picture on; keyframes of the camera no longer count.
    pub fn set_camera(&mut self, camera: Camera) {
        self.camera = None;
        self.session.set_camera(camera);
    }

    /// The simulated strands at rest.
    pub fn guides(&self) -> &Guides {
        self.session.view().guides()
    }

    /// The state of the simulation: as long as a frame is on its way, before it or after.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn state(&self) -> Result<State, Error> {
        Ok(self.session.peek(|simulation| {
            let origin = simulation.origin;
            simulation.state().map(|state| state.moved(origin))
        })?)
    }

    /// Distance of the hair from the groom as loaded, which the head carries.
    ///
    /// # Errors
    /// As [`Player::state`].
    pub fn drift(&self) -> Result<Drift, Error> {
        Ok(self.session.peek(Simulation::drift)?)
    }

    /// Force of the air on the hair and its density, at the end of the last step.
    ///
    /// # Errors
    /// As [`Player::state`].
    pub fn measures(&self) -> Result<Measures, Error> {
        Ok(self.session.peek(Simulation::measures)?)
    }

    /// Strands of rods that had to be stiffer for their shape to be stable.
    pub fn stiffening(&self) -> Stiffening {
        self.session.peek(|simulation| simulation.stiffening())
    }

    /// The device that the hair is simulated on; none on the CPU.
    pub fn gpu(&self) -> Option<Gpu> {
        self.session.peek(|simulation| simulation.gpu().cloned())
    }

    /// The device that the pictures are drawn on, the same way.
    pub fn picture_gpu(&self) -> Option<Gpu> {
        self.session.view().gpu().cloned()
    }

    /// Device of the simulation: cpu, or the adapter's number and name.
    pub fn simulated_on(&self) -> String {
        device_name(self.gpu().as_ref())
    }

    /// Device of the pictures, likewise.
    pub fn drawn_on(&self) -> String {
        self.session.view().drawn_on()
    }

    /// Number of frames of the film.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Frames whose events were all emitted.
    pub fn frames_done(&self) -> u32 {
        self.taken - u32::from(self.undrawn)
    }

    /// Placement of groom and body in head space, and the confidence in it.
    pub fn placement(&self) -> Placement {
        self.placement
    }

    /// Mends, guesses and omissions of the loading.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Starts the simulation of the next frame, if there is one.
    fn start(&mut self) -> Result<(), Error> {
        if self.started == self.frames || self.failed || self.closing {
            return Ok(());
        }
        let frame = self.started;
        let task = match &mut self.cache {
            None => {
                let settings = self.change.take().map(Box::new);
                Task::Film { timing: self.timing.clone(), frame, settings }
            }
            Some(cache) => {
                let guides = self.session.view().guides();
                let mut positions = guides.positions().to_vec();
                let points = guides.points_per_strand();
                let body = cache.read_lanes(frame as usize, points, &mut positions)?;
                Task::Cached { body, positions }
            }
        };
        self.started += 1;
        let home = self.out.as_ref().is_some_and(|out| out.takes(frame));
        self.session.start(task, home, 0)
    }

    /// Takes the next frame from the worker and writes it, where frames are written.
    fn take(&mut self) -> Result<(), Error> {
        let earlier = self.session.event_count();
        self.session.take()?;
        let frame = self.taken;
        self.taken += 1;
        let wanted = self.out.as_ref().is_some_and(|out| out.wants_state(frame));
        // Before the next frame begins.
        let state = if wanted { Some(self.session.snapshot(frame)?) } else { None };
        // A file has the reports of its frames.
        if self.taken == self.frames || self.out.is_some() {
            self.session.report_rest()?;
        }
        if self.overlap {
            self.start()?;
        }
        let time = self.timing.time(frame);
        if let Some(mut out) = self.out.take() {
            let reports = self.session.reports_after(earlier);
            // A file that cannot be written ends with the frame before.
            self.session.add_to(&mut out, frame, time, &reports, state.as_ref())?;
            self.out = Some(out);
        }
        Ok(())
    }

    /// Draws the frame that was taken.
    fn draw_taken(&mut self) -> Result<(), Error> {
        if let Some(motion) = &self.camera {
            let frame = self.taken.saturating_sub(1);
            let of_cache = self.cache.as_ref().and_then(|cache| cache.times().get(frame as usize).copied());
            let time = of_cache.unwrap_or_else(|| self.timing.time(frame));
            self.session.set_camera(motion.at(self.timing.motion_time(time)));
        }
        self.session.draw(None)
    }

    /// Takes the next frame and starts the one after it.
    fn advance(&mut self) -> Result<(), Error> {
        if self.session.started() == 0 {
            self.start()?;
        }
        self.take()?;
        self.undrawn = self.draw;
        Ok(())
    }
}

impl Iterator for Player {
    type Item = Result<Event, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(event) = self.session.next_event() {
                return Some(Ok(event));
            }
            let done = if std::mem::take(&mut self.undrawn) {
                self.draw_taken()
            } else if self.taken == self.frames || self.failed || self.closing {
                return None;
            } else {
                self.advance()
            };
            if let Err(error) = done {
                self.failed = true;
                return Some(Err(error));
            }
        }
    }
}
