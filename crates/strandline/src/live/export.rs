//! Kept frames as a file of moving hair.

use std::sync::Arc;
use std::thread::JoinHandle;

use glam::Vec3;
use strandline_base::{SettingError, counted};

use super::loaded::Loaded;
use super::timeline::Points;
use crate::{Error, Out, OutSettings, Scene, Written, body::BodyFrame, sim::StepReport};

/// A frame that leaves.
struct Leaving {
    number: u32,
    time: f64,
    points: Arc<Points>,
    body: BodyFrame,
    origin: Vec3,
    reports: Vec<StepReport>,
}

impl Loaded {
    /// Writes kept frames of a scene, the first to the last, on a thread of its own. The file has them under the numbers of
    /// a film, which begins with the first frame after rest.
    ///
    /// # Errors
    /// Frames that are not kept or stale; a file that cannot be written; the system gives no thread.
    pub fn export(
        &self,
        mut scene: Scene,
        settings: &OutSettings,
        [first, last]: [u32; 2],
        done: impl FnOnce(Result<Written, Error>) + Send + 'static,
    ) -> Result<JoinHandle<()>, Error> {
        let before = u32::from(self.session.scene().groom.pose.is_none());
        let (first, last) = (first.max(before), last.max(before));
        let lacking = (first..=last).filter(|number| self.timeline.good_frame(*number).is_none()).count();
        if lacking > 0 || first > last {
            let found = format!("{first} to {last}, of which {} lacking", counted(lacking, "is", "are"));
            let expected = "frames that are kept and up to date: play them first";
            return Err(SettingError::new("the frames of the export", found, expected).into());
        }
        let rate = self.rate();
        let leaving = (first..=last).filter_map(|number| {
            let frame = self.timeline.good_frame(number)?;
            let (points, body, reports) = (frame.points.clone()?, frame.body.clone(), frame.reports.clone());
            let time = f64::from(number) / rate;
            Some(Leaving { number: number - before, time, points, body, origin: frame.origin, reports })
        });
        let leaving: Vec<Leaving> = leaving.collect();
        scene.film.frames = last - before + 1;
        let settings = OutSettings { first: first - before, ..settings.clone() };
        let body = self.timeline.frame(first).map_or(BodyFrame::REST, |frame| frame.body.moved(frame.origin));
        let out = self.session.begin_file_of(&scene, &settings, &body)?;
        let write = move || done(write(out, &leaving));
        std::thread::Builder::new().name("exporting".to_owned()).spawn(write).map_err(Error::Thread)
    }
}

fn write(mut out: Out, frames: &[Leaving]) -> Result<Written, Error> {
    for frame in frames {
        let positions = frame.points.read().map_err(Error::KeptFrames)?;
        let held = (&*positions, &frame.body, frame.origin);
        out.add(frame.number, frame.time, held, &frame.reports, None)?;
    }
    out.close(true, None)
}
