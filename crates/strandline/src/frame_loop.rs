//! Hair in a loop of the host: frame after frame on the thread of the caller, as a browser page and an engine have it.

use glam::Vec3;

use crate::{
    Change, Devices, Error, Event, Prepared, Scene,
    body::Aabb,
    prepare::center,
    render::{Camera, FrameReport, Light, Look, Picture},
    session::{Draft, Inline, Session},
};

/// Hair that a person directs, driven by the host's own loop: a call for each frame of a sixtieth of a second, one for each
/// picture, and [`Change`]s between them. It has no thread of its own. On the CPU no call waits; on a GPU those that read
/// points do.
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
}

impl FrameLoop {
    /// A loaded scene on any devices, at the beginning of its motion.
    ///
    /// # Errors
    /// A setting of the scene outside its range; a device that is named and not there.
    pub fn open(prepared: Prepared, devices: impl Into<Devices>) -> Result<Self, Error> {
        Ok(Self { session: Session::open(prepared, devices.into())? })
    }

    /// Lets a sixtieth of a second pass, or less where the steps are so short that it would take many.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn frame(&mut self) -> Result<(), Error> {
        self.session.start_frame(0)?;
        self.take()
    }

    /// Applies a change at once.
    ///
    /// # Errors
    /// The change is refused, and nothing has changed.
    pub fn change(&mut self, change: Change) -> Result<(), Error> {
        self.session.change(change)?;
        self.take()
    }

    /// Takes the results of what was started.
    fn take(&mut self) -> Result<(), Error> {
        while self.session.started() > 0 {
            self.session.take()?;
        }
        Ok(())
    }

    /// Draws the present state, simpler and smaller with a coarseness of 0 to 3.
    ///
    /// # Errors
    /// A setting outside its range; the GPU failed, and falling back to the CPU is not allowed.
    pub fn picture(&mut self, coarseness: Option<usize>) -> Result<(Picture, FrameReport), Error> {
        self.session.picture(coarseness.map(Draft::of))
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
}
