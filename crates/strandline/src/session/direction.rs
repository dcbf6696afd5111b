//! Direction of playing hair by the user: head, wind and hand.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::Group;

use super::job::{Live, Weather};
use crate::{
    Error, HeadMotion, Scene,
    scene::{Interpolation, MotionName, MotionSection, WindSection},
};

/// Frames of a second in a loop of the host.
const RATE: f64 = 60.0;
/// Steps of a frame of such a loop at most, so that it stays awake: with steps shorter than that time slows down.
const MOST_STEPS: f64 = 16.0;
/// A time that is this part of a frame away from one is that frame.
const SLACK: f64 = 1e-6;

/// Direction of playing hair by the user.
pub(crate) struct Direction {
    pub wind: WindSection,
    motion: MotionSection,
    /// The motion of the head, in the world and seen from the origin of the simulation.
    pub head: HeadMotion,
    pub head_from_origin: HeadMotion,
    /// Head and wind of the next frames; `None` after a change of either.
    weather: Option<Arc<Weather>>,
    /// Frames of a second, and the most steps of one.
    rate: f64,
    most_steps: f64,
    /// Time of motion and wind at their beginning \[s\].
    begun: f64,
    /// Time of the clock at the end of the last frame that was taken \[s\], and the time of the motion when it is 0.
    pub time: f64,
    offset: f64,
    /// True where the motion begins with the next frame.
    begins: bool,
    /// Position of the hand that holds hair \[m\], world space.
    pub hand: Option<Vec3>,
}

impl Direction {
    /// Direction of a scene whose head moves so, seen from the origin of the simulation.
    pub fn new(scene: &Scene, head_from_origin: HeadMotion) -> Self {
        let start = scene.film.start;
        let (wind, motion) = (scene.wind.clone(), scene.motion.clone());
        let head = head_from_origin.seen_from(Vec3::ZERO);
        Self { wind, motion, head, head_from_origin, begun: start, offset: start, ..Self::default() }
    }

    /// Makes frames those of a film.
    pub fn film(&mut self, frames_per_second: f64) {
        (self.rate, self.most_steps) = (frames_per_second, f64::INFINITY);
    }

    /// Drive of the next frame.
    pub fn next(&mut self) -> Live {
        if std::mem::take(&mut self.begins) {
            self.offset = -self.time;
        }
        let weather = self.weather();
        let (frames, offset) = (self.time * self.rate, self.offset);
        let on_time = (frames - frames.round()).abs() < SLACK;
        // Times of frames are those of a film, to the bit.
        let until = if on_time { (frames.round() + 1.0) / self.rate } else { self.time + 1.0 / self.rate };
        Live { until, offset, most_steps: self.most_steps, weather, hand: self.hand }
    }

    /// Head and wind of the next frame.
    pub fn weather(&mut self) -> Arc<Weather> {
        let Self { head_from_origin, wind, motion, weather, .. } = self;
        let now = || {
            let (head, wind, motion) = (head_from_origin.clone(), wind.clone(), motion.clone());
            Arc::new(Weather { head, wind, motion })
        };
        weather.get_or_insert_with(now).clone()
    }

    /// Times of motion and wind \[s\] at their beginning and when that of the clock is 0, and true where the motion begins
    /// with the next frame.
    pub fn times(&self) -> ([f64; 2], bool) {
        ([self.begun, self.offset], self.begins)
    }

    /// Sets what [`Direction::times`] has.
    pub fn set_times(&mut self, ([begun, offset], begins): ([f64; 2], bool)) {
        (self.begun, self.offset, self.begins) = (begun, offset, begins);
    }

    /// Goes back to the beginning.
    pub fn reset(&mut self) {
        (self.hand, self.begun, self.offset, self.begins) = (None, 0.0, 0.0, false);
        self.time = 0.0;
    }

    /// Goes to a time of the clock \[s\]; a motion that began later begins there.
    pub fn go_to(&mut self, time: f64) {
        (self.hand, self.time) = (None, time);
        self.begins |= time + self.offset < self.begun - SLACK;
    }

    /// Time at which a film begins with what is shown \[s\], which lies `delay` \[s\] behind the end of a frame.
    pub fn time_shown(&self, delay: f64) -> f64 {
        if self.begins { self.begun } else { self.motion_time(self.time - delay) }
    }

    /// Time of the motion \[s\] at one of the clock.
    pub fn motion_time(&self, time: f64) -> f64 {
        (time + self.offset).max(self.begun)
    }

    /// Time of the motion \[s\] at the time 0 of the clock, unless that is before its beginning.
    pub fn offset(&self) -> f64 {
        if self.begins { -self.time } else { self.offset }
    }

    /// A motion of another name begins at its beginning; other keyframes and another turn do not disturb its time.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn set_motion(&mut self, motion: MotionSection) -> Result<(), Error> {
        self.head = self.head_of(&motion)?;
        self.head_from_origin = self.head.seen_from(self.head_from_origin.origin());
        if motion.name != self.motion.name {
            (self.begun, self.begins) = (0.0, true);
        }
        (self.motion, self.weather) = (motion, None);
        Ok(())
    }

    /// The way from pose to pose.
    pub fn interpolation(&self) -> Interpolation {
        self.motion.interpolation
    }

    /// True where the motion would bend a neck that the head does not have.
    pub fn lacks_neck(&self) -> bool {
        self.motion.neck && self.head.neck().is_none()
    }

    /// The head that follows another section, in the world.
    ///
    /// # Errors
    /// A setting outside its range.
    fn head_of(&self, motion: &MotionSection) -> Result<HeadMotion, Error> {
        motion.check_as("motion")?;
        let (body, recorded) = (self.head.body().cloned(), self.head.recorded().cloned());
        let head = HeadMotion::new(motion, self.head.pivot())?;
        let (solids, neck) = (self.head.solids().clone(), self.head.neck());
        Ok(head.with_body(body).with_recorded(recorded).with_solids(solids).with_neck(neck))
    }

    /// Weather of a former time: a head that follows a section, and a wind.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn weather_of(&mut self, motion: MotionSection, wind: WindSection) -> Result<Arc<Weather>, Error> {
        if (&motion, &wind) == (&self.motion, &self.wind) {
            return Ok(self.weather());
        }
        wind.check_as("wind")?;
        let head = self.head_of(&motion)?.seen_from(self.head_from_origin.origin());
        Ok(Arc::new(Weather { head, wind, motion }))
    }

    /// Another wind.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn set_wind(&mut self, wind: WindSection) -> Result<(), Error> {
        wind.check_as("wind")?;
        (self.wind, self.weather) = (wind, None);
        Ok(())
    }
}

impl Default for Direction {
    /// A head and air that rest.
    fn default() -> Self {
        Self {
            wind: WindSection::default(),
            motion: MotionSection { name: MotionName::Still, ..MotionSection::default() },
            head: HeadMotion::still(),
            head_from_origin: HeadMotion::still(),
            weather: None,
            rate: RATE,
            most_steps: MOST_STEPS,
            begun: 0.0,
            time: 0.0,
            offset: 0.0,
            begins: false,
            hand: None,
        }
    }
}
