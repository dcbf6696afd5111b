//! Direction of playing hair by the user: head, wind and hand.

use glam::Vec3;
use strandline_base::Group;

use super::job::Live;
use crate::{
    Error, HeadMotion, Scene,
    scene::{MotionName, MotionSection, WindSection},
};

/// Time that passes in a frame \[s\].
pub(crate) const FRAME: f64 = 1.0 / 60.0;
/// Steps of a frame at most, so that a window stays awake: with steps shorter than that time slows down.
pub(crate) const MOST_STEPS: f64 = 16.0;

/// Direction of playing hair by the user.
pub(crate) struct Direction {
    pub wind: WindSection,
    motion: MotionSection,
    /// The motion of the head, in the world and seen from the origin of the simulation.
    pub head: HeadMotion,
    pub head_from_origin: HeadMotion,
    /// Time of motion and wind \[s\], at their beginning and at the end of the last frame that was taken.
    begun: f64,
    time: f64,
    /// True if the frame on its way advances that time: not after a return to the beginning.
    counts: bool,
    /// Position of the hand that holds hair \[m\], world space.
    pub hand: Option<Vec3>,
}

impl Direction {
    /// That of a scene whose head moves so, seen from the origin of the simulation.
    pub fn new(scene: &Scene, head_from_origin: HeadMotion) -> Self {
        let start = scene.film.start;
        let (wind, motion) = (scene.wind.clone(), scene.motion.clone());
        let head = head_from_origin.seen_from(Vec3::ZERO);
        Self { wind, motion, head, head_from_origin, begun: start, time: start, counts: true, hand: None }
    }

    /// Drive of the next frame.
    pub fn next(&mut self) -> Live {
        self.counts = true;
        let (head, wind) = (self.head_from_origin.clone(), self.wind.clone());
        Live { begin: self.time, seconds: FRAME, most_steps: MOST_STEPS, head, wind, hand: self.hand }
    }

    /// Moves on by the time of a frame \[s\].
    pub fn pass(&mut self, seconds: f64) {
        if self.counts {
            self.time += seconds;
        }
    }

    /// Goes back to the beginning.
    pub fn reset(&mut self) {
        (self.hand, self.begun, self.time, self.counts) = (None, 0.0, 0.0, false);
    }

    /// Time at which a film begins with what is shown \[s\], which lies `delay` \[s\] behind the end of a frame.
    pub fn time_shown(&self, delay: f64) -> f64 {
        (self.time - delay).max(self.begun)
    }

    /// Another motion of the head begins at its beginning; another turn does not disturb it.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn set_motion(&mut self, motion: MotionSection) -> Result<(), Error> {
        motion.check_as("motion")?;
        let (body, recorded) = (self.head.body().cloned(), self.head.recorded().cloned());
        let head = HeadMotion::new(&motion, self.head.pivot())?;
        let (solids, neck) = (self.head.solids().clone(), self.head.neck());
        self.head = head.with_body(body).with_recorded(recorded).with_solids(solids).with_neck(neck);
        self.head_from_origin = self.head.seen_from(self.head_from_origin.origin());
        if (motion.name, &motion.keyframes) != (self.motion.name, &self.motion.keyframes) {
            (self.begun, self.time, self.counts) = (0.0, 0.0, false);
        }
        self.motion = motion;
        Ok(())
    }
}

impl Default for Direction {
    /// A head and air that rest.
    fn default() -> Self {
        let motion = MotionSection { name: MotionName::Still, ..MotionSection::default() };
        let wind = WindSection::default();
        let [head, head_from_origin] = [HeadMotion::still(), HeadMotion::still()];
        Self { wind, motion, head, head_from_origin, begun: 0.0, time: 0.0, counts: true, hand: None }
    }
}
