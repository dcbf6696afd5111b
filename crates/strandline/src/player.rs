use crate::{
    Devices, Error, Hair, Scene,
    body::{Motion, Pose},
    prepare::Prepared,
    render::{Camera, FrameReport, Picture},
    scene::WindSection,
    sim::StepReport,
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
pub struct Player {
    hair: Hair,
    motion: Motion,
    pivot: glam::Vec3,
    wind: WindSection,
    camera: Camera,
    look: crate::render::Look,
    draw: bool,
    frame_seconds: f64,
    settle_seconds: f64,
    frames: u32,
    frame: u32,
    waiting: std::vec::IntoIter<StepReport>,
    told: std::vec::IntoIter<String>,
    /// Whether the simulation cannot go on.
    failed: bool,
    drawn: bool,
    notes: Vec<String>,
}

impl Player {
    /// Loads a scene; `draw` false leaves the pictures out.
    ///
    /// # Errors
    /// Whatever the scene's parts refuse.
    pub fn new(scene: &Scene, devices: impl Into<Devices>, draw: bool) -> Result<Self, Error> {
        let mut prepared = Prepared::new(scene)?;
        let motion = prepared.motion.clone();
        let (pivot, bounds) = (prepared.pivot, prepared.bounds);
        let mut notes = std::mem::take(&mut prepared.notes);
        let aspect = scene.picture.width as f32 / scene.picture.height as f32;
        let mut hair = Hair::from_scene(scene, prepared, devices)?;
        notes.extend(hair.take_notes());
        Ok(Self {
            hair,
            motion,
            pivot,
            wind: scene.wind,
            camera: scene.camera.camera(bounds, aspect),
            look: scene.look.clone(),
            draw,
            frame_seconds: 1.0 / f64::from(scene.film.frames_per_second),
            settle_seconds: f64::from(scene.film.settle),
            frames: scene.film.frames,
            frame: 0,
            waiting: Vec::new().into_iter(),
            told: Vec::new().into_iter(),
            failed: false,
            drawn: true,
            notes,
        })
    }

    /// The hair that is played.
    pub fn hair(&self) -> &Hair {
        &self.hair
    }

    /// The hair that is played, to change while it moves.
    pub fn hair_mut(&mut self) -> &mut Hair {
        &mut self.hair
    }

    /// Number of frames of the film.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Frames of which every event was told.
    pub fn frames_done(&self) -> u32 {
        self.frame - u32::from(!self.drawn)
    }

    /// What was mended or left out while loading.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Lets the hair hang on the resting head; the steps are not told.
    fn settle(&mut self) -> Result<(), Error> {
        let rest = self.motion.pose(0.0, self.pivot);
        self.hair.wind = self.wind.at(0.0);
        let frames = (self.settle_seconds / self.frame_seconds).ceil();
        for _ in 0..frames as u64 {
            self.hair.step(self.settle_seconds / frames, &rest)?;
        }
        Ok(())
    }

    /// Moves the hair to the next frame.
    fn advance(&mut self) -> Result<(), Error> {
        if self.frame == 0 {
            self.settle()?;
        }
        let begin = f64::from(self.frame) * self.frame_seconds;
        self.hair.wind = self.wind.at(begin);
        let (motion, pivot, length) = (&self.motion, self.pivot, self.frame_seconds);
        let pose = |share: f32| -> Pose { motion.pose(begin + length * f64::from(share), pivot) };
        self.waiting = self.hair.step_along(length, pose)?.into_iter();
        self.told = self.hair.take_notes().into_iter();
        self.drawn = !self.draw;
        self.frame += 1;
        Ok(())
    }

    fn picture(&mut self) -> Result<Event, Error> {
        self.drawn = true;
        let (picture, report) = self.hair.picture_with_report(&self.camera, &self.look)?;
        Ok(Event::Drawn { frame: self.frame - 1, picture, report })
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
            if !self.drawn {
                return Some(self.picture());
            }
            if self.frame == self.frames || self.failed {
                return None;
            }
            if let Err(error) = self.advance() {
                self.failed = true;
                return Some(Err(error));
            }
        }
    }
}
