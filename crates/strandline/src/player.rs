use crate::{
    Cache, Devices, Error, Hair, OutSettings, Scene, What, Written,
    cache::{Leaving, Out, Snapshot, drawn},
    course::Course,
    gpu::Gpu,
    groom::Guides,
    hair::Studio,
    prepare::Prepared,
    render::{Camera, FrameReport, Look, Picture, PictureSettings},
    sim::{Drift, Settings, State, StepReport},
    simulation::{Act, Done, Job, Moment, Simulation},
    tags::Tags,
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
    /// With what it leaves open chosen to fit its groom.
    scene: Scene,
    tags: Tags,
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
    /// Where frames are written as they are made.
    out: Option<Out>,
    /// Where frames come from in place of the simulation.
    cache: Option<Cache>,
    /// Whether no frame is begun any more.
    closing: bool,
}

impl Player {
    /// Loads a scene; `draw` false leaves the pictures out.
    ///
    /// # Errors
    /// Whatever the scene's parts refuse.
    pub fn new(scene: &Scene, devices: impl Into<Devices>, draw: bool) -> Result<Self, Error> {
        Self::of(Prepared::new(scene)?, devices, draw)
    }

    /// Draws the frames of a cache in place of a simulation, as many as the film of the scene that it was made with
    /// has: its guides with the strands that hang on them, or its strands as they are.
    ///
    /// # Errors
    /// Whatever the scene's parts refuse; a cache of other hair.
    pub fn showing(scene: &Scene, devices: impl Into<Devices>, mut cache: Cache) -> Result<Self, Error> {
        let mut player = Self::of(drawn::prepared(scene, &mut cache)?, devices, true)?;
        if cache.what() == What::Guides {
            let guides = player.guides();
            cache.check_guides(guides.strand_count(), guides.points_per_strand())?;
        }
        player.frames = player.frames.min(u32::try_from(cache.len()).unwrap_or(u32::MAX));
        player.cache = Some(cache);
        Ok(player)
    }

    fn of(mut prepared: Prepared, devices: impl Into<Devices>, draw: bool) -> Result<Self, Error> {
        let head = prepared.head.clone();
        let mut notes = std::mem::take(&mut prepared.notes);
        let tags = std::mem::take(&mut prepared.tags);
        let fitted = prepared.scene.clone();
        let scene = &fitted;
        let aspect = scene.picture.width as f32 / scene.picture.height as f32;
        let camera = prepared.camera(aspect);
        let mut hair = Hair::from_scene(scene, prepared, devices)?;
        notes.extend(hair.take_notes());
        let (simulation, studio) = hair.into_parts();
        let here = simulation.end();
        Ok(Self {
            worker: Worker::new(simulation).map_err(Error::Thread)?,
            studio,
            scene: scene.clone(),
            tags,
            change: None,
            course: Course::new(scene, head, here),
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
            out: None,
            cache: None,
            closing: false,
        })
    }

    /// Writes every frame as it moves, from the next one on: see [`Player::close_out`]. What leaves is what the
    /// scene draws: strands that guides carry too, with what the groom says of them.
    ///
    /// # Errors
    /// A name that no format has; a file or folder that cannot be written; more points than a file may have.
    pub fn set_out(&mut self, settings: &OutSettings) -> Result<(), Error> {
        if settings.first >= self.frames {
            let message = format!("frame {} is not in a film of {} frames", settings.first, self.frames);
            return Err(Error::Cache { path: settings.path.clone(), message });
        }
        let Studio { guides, painter, .. } = &self.studio;
        let leaving = Leaving { guides, bound: painter.bound(), tags: &self.tags };
        self.out = Some(Out::new(settings, &self.scene, leaving)?);
        Ok(())
    }

    /// Goes on where the run of a cache stood; frames before that are not told. What is written has them too.
    ///
    /// # Errors
    /// A cache of other hair, without a state, or of a film that was over; a file that cannot be written.
    pub fn resume(&mut self, cache: &mut Cache) -> Result<(), Error> {
        let guides = self.guides();
        let (strands, points) = (guides.strand_count(), guides.points_per_strand());
        if cache.what() == What::Guides {
            cache.check_guides(strands, points)?;
        }
        let path = cache.path().to_owned();
        let refuse = |message: String| Error::Cache { path, message };
        let Some(state) = cache.snapshot(strands, points)? else {
            return Err(refuse(
                "it holds no state, expected the state_* arrays that `sim --out` writes".to_owned(),
            ));
        };
        if state.frame + 1 >= self.frames {
            return Err(refuse(format!(
                "its run made {} frames, and the film has {}: ask for more with --frames",
                state.frame + 1,
                self.frames
            )));
        }
        self.worker.work().restore(&state)?;
        (self.started, self.taken) = (state.frame + 1, state.frame + 1);
        if let Some(out) = &mut self.out {
            out.copy(cache, &state)?;
        }
        Ok(())
    }

    /// Ends what [`Player::set_out`] began; none without. A frame on its way is waited for and written, and a
    /// film that is not over leaves a file that it can be gone on from.
    ///
    /// # Errors
    /// The file cannot be written; what was written before stays.
    pub fn close_out(&mut self) -> Result<Option<Written>, Error> {
        self.closing = true;
        while self.out.is_some() && self.worker.started() > 0 && !self.failed {
            self.take()?;
        }
        let Some(out) = self.out.take() else { return Ok(None) };
        let state = self.taken.checked_sub(1).map(|frame| self.worker.work().snapshot(frame)).transpose()?;
        out.close(self.taken == self.frames, state.as_ref()).map(Some)
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
    ///
    /// # Errors
    /// The GPU failed, and it was not to go on on the CPU.
    pub fn state(&self) -> Result<State, Error> {
        Ok(self.worker.work().engine.state()?.clone())
    }

    /// How far the hair lies from the groom as loaded, which the head carries.
    ///
    /// # Errors
    /// As [`Player::state`].
    pub fn drift(&self) -> Result<Drift, Error> {
        Ok(self.worker.work().engine.drift()?)
    }

    /// Strands of rods that had to be stiffer for their shape to be stable, and how many times stiffer the stiffest
    /// of them is; 0 without rods.
    pub fn stiffened(&self) -> (usize, f32) {
        let work = self.worker.work();
        work.engine.model().rods().map_or((0, 1.0), |rods| (rods.stiffened, rods.stiffest))
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
        crate::devices::place(self.worker.work().engine.gpu())
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
    fn start(&mut self) -> Result<(), Error> {
        if self.started == self.frames || self.failed || self.closing {
            return Ok(());
        }
        let (frame, course, change) = (self.started, self.course.clone(), self.change.take());
        let simulate = move |simulation: &mut Simulation| {
            change
                .map_or(Ok(()), |settings| simulation.set_settings(&settings))
                .and_then(|()| course.run(simulation, frame))
        };
        let act: Act = match &mut self.cache {
            None => Box::new(simulate),
            Some(cache) => {
                let points = self.studio.guides.points_per_strand();
                let mut lanes = self.studio.guides.positions().to_vec();
                let pose = cache.read_lanes(frame as usize, points, &mut lanes)?;
                Box::new(move |simulation: &mut Simulation| {
                    simulation.show_cached(pose, |positions| positions.copy_from_slice(&lanes))?;
                    Ok(Vec::new())
                })
            }
        };
        let gpu = self.studio.painter.gpu().cloned();
        let moment = self.spare.pop().unwrap_or_default();
        self.started += 1;
        let job = Job { act, gpu, moment, is_frame: true, heard: 0 };
        self.worker.start(job).map_err(|Gone| Error::WorkerGone)
    }

    /// Takes the next frame from the worker and writes it, where frames are written.
    fn take(&mut self) -> Result<Moment, Error> {
        let Done { moment, reports, notes, .. } = self.worker.finish().map_err(|Gone| Error::WorkerGone)?;
        self.told = notes.into_iter();
        let reports = match reports {
            Ok(reports) => reports,
            Err(error) => {
                self.spare.push(moment);
                return Err(error.into());
            }
        };
        let frame = self.taken;
        self.taken += 1;
        let wanted = self.out.as_ref().is_some_and(|out| out.wants_state(frame));
        // Before the next frame begins.
        let state: Option<Snapshot> = wanted.then(|| self.worker.work().snapshot(frame)).transpose()?;
        if self.overlap {
            self.start()?;
        }
        let time = self.course.time(frame);
        if let Some(mut out) = self.out.take() {
            // What cannot go on is left as it is: it ends with the frame before.
            out.add(frame, time, &moment, &reports, state.as_ref())?;
            self.out = Some(out);
        }
        self.waiting = reports.into_iter();
        Ok(moment)
    }

    /// Takes the next frame and starts the one after it.
    fn advance(&mut self) -> Result<(), Error> {
        if self.worker.started() == 0 {
            self.start()?;
        }
        let moment = self.take()?;
        if self.draw {
            self.shown = Some(moment);
        } else {
            self.spare.push(moment);
        }
        Ok(())
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
            if self.taken == self.frames || self.failed || self.closing {
                return None;
            }
            if let Err(error) = self.advance() {
                self.failed = true;
                return Some(Err(error));
            }
        }
    }
}
