//! Hair in a loop of the host: frame after frame on the thread of the caller, as a browser page and an engine have it.

use std::collections::VecDeque;

use glam::Vec3;

use crate::{
    Change, Devices, Error, Event, Prepared, Scene,
    body::Aabb,
    gpu::{Gpu, GpuError},
    prepare::center,
    render::{Camera, FrameReport, Light, Look, Picture},
    session::{AskedPoints, Draft, Inline, Session},
};

/// Hair that a person directs, driven by the host's own loop: a call for each frame of a sixtieth of a second, one for each
/// picture, and [`Change`]s between them. It has no thread of its own.
///
/// On the CPU every change takes place at once. On a GPU a change that reads hair (a grab, a reset, another strand solver) is
/// a request: the hair stands still until it has arrived, a frame or two, while pictures go on, and the changes of the motion
/// that come after it follow it. [`FrameLoop::points`] and [`FrameLoop::picture`] alone wait for a GPU, and a frame in which
/// the body jumps; where the host has called [`Gpu::never_wait`] the first two are errors, in place of which
/// [`FrameLoop::arrived_points`] and `FrameLoop::draw_to` stand, and hair stands still before a jump until it has been read.
///
/// ```
/// use strandline::{Backend, Change, FrameLoop, Prepared, Ray, Scene};
///
/// # fn main() -> Result<(), strandline::Error> {
/// # let mut scene = Scene::demo();
/// # scene.style.strand_count = 24;
/// # (scene.picture.width, scene.picture.height) = (32, 40);
/// # let scene = scene;
/// let mut hair = FrameLoop::open(Prepared::new(&scene)?, Backend::Cpu)?;
/// let ray = Ray::new(hair.camera(), glam::Vec2::new(0.2, 0.0));
/// hair.change(Change::Grab(ray, 0.02))?;
/// hair.frame()?;
/// let (picture, _) = hair.picture(Some(3))?;
/// # assert!(picture.width > 0);
/// # Ok(())
/// # }
/// ```
pub struct FrameLoop {
    session: Session<Inline>,
    /// Changes that wait for what they read, in their order.
    asked: VecDeque<Change>,
    asked_points: Option<AskedPoints>,
    /// True where the next frame waits for the state of the hair: the body jumps in it.
    needs_state: bool,
}

impl FrameLoop {
    /// A loaded scene on any devices, at the beginning of its motion.
    ///
    /// # Errors
    /// A setting of the scene outside its range; a device that is named and not there.
    pub fn open(prepared: Prepared, devices: impl Into<Devices>) -> Result<Self, Error> {
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
        Self { session, asked: VecDeque::new(), asked_points: None, needs_state: false }
    }

    /// Lets a sixtieth of a second pass, or less where the steps are so short that it would take many. Returns false where
    /// no time has passed: a change waits for what it reads, hair for being carried over a jump of the body, or the GPU is some
    /// frames behind.
    ///
    /// # Errors
    /// A change that has waited is refused; the GPU failed, and falling back to the CPU is not allowed.
    pub fn frame(&mut self) -> Result<bool, Error> {
        if !self.make_changes()? || self.session.is_behind()? {
            return Ok(false);
        }
        if self.needs_state && !self.session.has_state()? {
            return Ok(false);
        }
        let has_asked = std::mem::take(&mut self.needs_state);
        self.session.start_frame(0)?;
        let passed = self.take();
        let would_wait =
            passed.as_ref().is_err_and(|error| matches!(error.gpu(), Some(GpuError::WouldWait { .. })));
        if would_wait && !has_asked {
            self.needs_state = true;
            self.session.has_state()?;
            return Ok(false);
        }
        passed.map(|()| true)
    }

    /// Makes a change at once, or as soon as what it reads has arrived from a GPU.
    ///
    /// # Errors
    /// The change is refused, and nothing has changed.
    pub fn change(&mut self, change: Change) -> Result<(), Error> {
        if change.is_of_picture() {
            return self.session.change(change);
        }
        if let Change::Settings(settings) = &change {
            settings.check()?;
        }
        match (self.asked.back_mut(), change) {
            (Some(Change::Drag(last)), Change::Drag(ray)) => *last = ray,
            (_, change) => self.asked.push_back(change),
        }
        self.make_changes().map(drop)
    }

    /// Makes the changes that can be made without a wait, while no time passes; true where none is left. A loop that calls
    /// [`FrameLoop::frame`] needs no call of it.
    ///
    /// # Errors
    /// A change that has waited is refused; the GPU failed.
    pub fn make_changes(&mut self) -> Result<bool, Error> {
        while let Some(change) = self.asked.front() {
            if !self.session.is_ready_for(change)? {
                return Ok(false);
            }
            let Some(change) = self.asked.pop_front() else { break };
            self.session.change(change)?;
            self.take()?;
        }
        Ok(true)
    }

    /// Changes that wait for what they read.
    pub fn waiting(&self) -> usize {
        self.asked.len()
    }

    /// Takes the results of what was started.
    fn take(&mut self) -> Result<(), Error> {
        while self.session.started() > 0 {
            self.session.take()?;
        }
        Ok(())
    }

    /// Draws the present state into a texture of the host, on whose device the hair is ([`FrameLoop::with_device`]); its size
    /// is that of the pictures ([`Change::Picture`]), and it is seen in `format`. Submits the work and waits for nothing:
    /// the report has no times.
    ///
    /// # Errors
    /// A texture of another size; pictures that the CPU draws; a setting outside its range; whatever the device refuses.
    #[cfg(feature = "gpu")]
    pub fn draw_to(
        &mut self,
        target: &crate::gpu::wgpu::TextureView,
        format: crate::gpu::wgpu::TextureFormat,
    ) -> Result<FrameReport, Error> {
        self.session.draw_to(target, format)
    }

    /// Draws the present state, simpler and smaller with a coarseness of 0 to 3.
    ///
    /// # Errors
    /// A setting outside its range; the GPU failed, and falling back to the CPU is not allowed.
    pub fn picture(&mut self, coarseness: Option<usize>) -> Result<(Picture, FrameReport), Error> {
        self.session.picture(coarseness.map(Draft::of))
    }

    /// The device that draws; none on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.session.view().gpu()
    }

    /// Falls back to the CPU after a failure of the host's device, such as its loss: the hair goes on from the state that was
    /// last read, through the steps since, which are computed again. Changes that waited for the device follow.
    ///
    /// # Errors
    /// The pictures take more memory than there is.
    pub fn fall_back_after(&mut self, failure: &str) -> Result<(), Error> {
        (self.asked_points, self.needs_state) = (None, false);
        self.session.fall_back_after(failure)
    }

    /// The next event: reports of steps, and notes.
    pub fn next_event(&mut self) -> Option<Event> {
        self.session.next_event()
    }

    /// Notes on the devices since the last call, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        self.session.take_notes()
    }

    /// The scene as it was opened, with the settings that it left open chosen to fit its groom.
    pub fn scene(&self) -> &Scene {
        self.session.scene()
    }

    /// The view of the next picture.
    pub fn camera(&self) -> &Camera {
        self.session.view().camera()
    }

    /// The look of the next picture.
    pub fn look(&self) -> &Look {
        self.session.view().look()
    }

    /// The lights.
    pub fn lights(&self) -> &[Light] {
        self.session.view().lights()
    }

    /// The box around hair and body at rest \[m\], head space.
    pub fn bounds(&self) -> Aabb {
        self.session.view().bounds()
    }

    /// The lights of a look on this hair, where a scene names none.
    pub fn lights_of(&self, look: &Look) -> Vec<Light> {
        look.lights(center(self.bounds()))
    }

    /// Simulated strands.
    pub fn strand_count(&self) -> usize {
        self.session.view().guides().strand_count()
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.session.grabbed()
    }

    /// Points of the guides as they are now \[m\], world space, shape `[strand][point]`. A GPU is waited for.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn points(&mut self) -> Result<&[Vec3], Error> {
        self.session.points()
    }

    /// Points of the guides \[m\], world space, shape `[strand][point]`, without a wait: on a GPU the first call asks for those
    /// of that moment, and a later one finds them. `None` while they are on their way.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn arrived_points(&mut self) -> Result<Option<&[Vec3]>, Error> {
        let asked = match self.asked_points.take() {
            Some(asked) => asked,
            None => match self.session.ask_points()? {
                Some(asked) => asked,
                None => return self.session.points().map(Some),
            },
        };
        if asked.have_arrived()? {
            return self.session.take_points(asked).map(Some);
        }
        self.asked_points = Some(asked);
        Ok(None)
    }
}
