//! Timing of a film: body and wind at every time, and the steps that lead to each frame.

use std::sync::Arc;

use super::simulation::Simulation;

use crate::{
    HeadMotion, Scene,
    body::{BodyFrame, Pose},
    scene::Air,
    sim::{SimError, StepReport},
};

/// Body and wind of a film at every time, and the times of its frames.
#[derive(Clone)]
pub(crate) struct FilmTiming {
    body: Arc<dyn Fn(f64) -> BodyFrame + Send + Sync>,
    air: Arc<dyn Fn(f64) -> Air + Send + Sync>,
    frames_per_second: f64,
    settle_seconds: f64,
    /// Time of motion and wind at the beginning \[s\].
    start: f64,
    /// True where the first picture shows hair as it begins.
    posed: bool,
    /// Transform from the head at the beginning of the motion to the head of a pose of hair.
    aside: Pose,
}

/// Time \[s\] in which a head that a pose of hair has elsewhere than the motion comes to where that has it.
const JOINING: f64 = 1.0 / 30.0;

impl FilmTiming {
    /// The timing of a scene with a motion of the head, which is `here` at the beginning.
    pub fn new(scene: &Scene, head: HeadMotion, here: Pose) -> Self {
        let (wind, there) = (scene.wind.clone(), head.pose(scene.film.start));
        let origin = head.origin();
        Self {
            body: Arc::new(move |time| head.frame(time)),
            air: Arc::new(move |time| wind.air(time, origin)),
            frames_per_second: f64::from(scene.film.frames_per_second),
            settle_seconds: f64::from(scene.film.settle),
            start: scene.film.start,
            posed: scene.groom.pose.is_some(),
            aside: if here == there { Pose::IDENTITY } else { there.motion_to(&here) },
        }
    }

    /// Moves to the end of a frame; the first one lets the hair hang on the resting head before, in whole
    /// steps that are not reported. Hair that begins in a pose is shown in it first.
    ///
    /// Everything is asked for at times of steps, never of frames.
    pub fn run(&self, simulation: &mut Simulation, frame: u32) -> Result<Vec<StepReport>, SimError> {
        if frame == 0 && self.posed {
            return Ok(Vec::new());
        }
        if frame == 0 {
            simulation.settle(self.settle_seconds, (self.air)(self.start))?;
        }
        simulation.run_to(self.time(frame), &|time| (self.body(time), (self.air)(self.start + time)))
    }

    /// Time of the film at which a frame is shown \[s\].
    pub fn time(&self, frame: u32) -> f64 {
        f64::from(frame + u32::from(!self.posed)) / self.frames_per_second
    }

    /// Time of motion, wind and camera at a time of the film \[s\].
    pub fn motion_time(&self, time: f64) -> f64 {
        self.start + time
    }

    /// Body at a time of the film \[s\].
    pub fn body(&self, time: f64) -> BodyFrame {
        let body = (self.body)(self.start + time);
        if self.aside == Pose::IDENTITY || time >= JOINING {
            return body;
        }
        body.carried_by(&self.aside.toward(&Pose::IDENTITY, (time / JOINING) as f32))
    }
}
