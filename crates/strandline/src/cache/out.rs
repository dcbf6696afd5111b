//! Writer of the frames of a run.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use glam::Vec3;
use strandline_base::{SettingError, Stopwatch};

use super::{
    Cache, CacheFrame, Target, What,
    files::{Files, size},
    shape::{Leaving, Shape},
    store::Store,
    usd::Usd,
};
use crate::{Error, Scene, body::BodyFrame, groom::Vec3Lanes, sim::StepReport, snapshot::Snapshot};

/// Frames, strands and file of a writer.
#[derive(Clone, Debug)]
pub struct OutSettings {
    /// The file: `.npz` is a moving cache, `.usda` text USD; a name with `%04d` in it a file for every frame.
    pub path: PathBuf,
    /// Strands that are written.
    pub what: What,
    /// Every n-th frame, from the first.
    pub every: u32,
    /// The first frame that is written.
    pub first: u32,
    /// Program whose units and axes the file has.
    pub target: Target,
}

/// Summary of a finished file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its path: beside the name that was asked for where a run was stopped early and an earlier file is there.
    pub place: PathBuf,
    /// Frames in it, strands of each and points of all of them.
    pub frames: usize,
    /// Strands.
    pub strands: usize,
    /// Points of all strands.
    pub points: usize,
    /// Size of the file, or of all of them \[byte\].
    pub bytes: u64,
    /// Time that writing took by the clock, without the simulation.
    pub time: Duration,
    /// Parts of the hair that the format cannot hold.
    pub left_out: Vec<String>,
    /// Changes that made the hair fit the format, human-readable.
    pub notes: Vec<String>,
}

/// A file of moving hair that is being written.
pub struct Out {
    shape: Shape,
    first: u32,
    every: u32,
    writer: Writer,
    points: Vec<Vec3>,
    frames: usize,
    /// Frames of the film so far, whether written or passed over.
    offered: u32,
    /// Time of the last of them \[s\].
    last_time: f64,
    time: Duration,
}

enum Writer {
    Store(Box<Store>),
    Usd(Box<Usd>),
    Files(Box<Files>),
}

/// A format, by the name of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Npz,
    Usda,
    Sequence,
}

fn format(path: &Path) -> Result<Format, Error> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    match ending.as_str() {
        _ if super::files::is_sequence(path) => Ok(Format::Sequence),
        "npz" => Ok(Format::Npz),
        "usda" => Ok(Format::Usda),
        _ => Err(Error::OutName { found: ending, path: path.to_owned() }),
    }
}

impl OutSettings {
    /// Default settings for a file.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), what: What::default(), first: 0, every: 1, target: Target::default() }
    }

    /// Refuses a name that no format has, and units that its format does not, before anything is loaded.
    ///
    /// # Errors
    /// See [`Error::OutName`]; an [`OutSettings::target`] for a file other than `.usda`.
    pub fn check(&self) -> Result<(), Error> {
        self.format().map(|_| ())
    }

    fn format(&self) -> Result<Format, Error> {
        let format = format(&self.path)?;
        if format != Format::Usda && self.target != Target::Any {
            let expected = "any: only a .usda has others, all else stays in metres with y up";
            return Err(SettingError::new("for", self.target.name(), expected).into());
        }
        Ok(format)
    }
}

impl Out {
    /// Begins to write the film of a scene.
    ///
    /// # Errors
    /// A name that no format has; a file or folder that cannot be written.
    pub(crate) fn new(settings: &OutSettings, scene: &Scene, leaving: Leaving) -> Result<Self, Error> {
        let format = settings.format()?;
        let body = leaving.body;
        let shape = Shape::new(settings.what, scene, leaving)?;
        let (path, first, every) = (settings.path.as_path(), settings.first, settings.every.max(1));
        let writer = match format {
            Format::Npz => Writer::Store(Store::new(path, scene, &shape, body, [first, every])?.into()),
            Format::Usda => Writer::Usd(Usd::new(path, scene, &shape, settings.target)?.into()),
            Format::Sequence => Writer::Files(Files::new(path, &shape)?.into()),
        };
        Ok(Self {
            shape,
            first,
            every,
            writer,
            points: Vec::new(),
            frames: 0,
            offered: 0,
            last_time: f64::NEG_INFINITY,
            time: Duration::ZERO,
        })
    }

    /// Frames of the film so far, whether written or passed over.
    pub fn offered(&self) -> u32 {
        self.offered
    }

    /// Refuses a frame more than the film has, and one at the time \[s\] of the last or before it.
    pub(crate) fn check_next(&self, frames: u32, time: f64) -> Result<(), Error> {
        let last = self.last_time;
        let refused = if self.offered >= frames {
            SettingError::new(
                "film.frames",
                frames,
                "the number of all calls of `write`: a file has room for so many",
            )
        } else if !(last < time) {
            SettingError::new(
                "the time of a frame",
                format!("{time} s"),
                format!("more than {last} s, that of the last"),
            )
        } else {
            return Ok(());
        };
        Err(refused.into())
    }

    /// True for frames that are written.
    pub(crate) fn takes(&self, frame: u32) -> bool {
        frame.checked_sub(self.first).is_some_and(|frame| frame.is_multiple_of(self.every))
    }

    /// True where the state of the simulation has to come with a frame.
    pub(crate) fn wants_state(&self, frame: u32) -> bool {
        match &self.writer {
            Writer::Store(store) => self.takes(frame) && store.wants_state(),
            Writer::Usd(_) | Writer::Files(_) => false,
        }
    }

    /// Adds a frame of the film, where it is one of those that are written: guide points \[m\], shape `[block][point]` of
    /// lanes, and the body, both seen from an origin \[m\] of the world. The file has them in the world.
    pub(crate) fn add(
        &mut self,
        number: u32,
        time: f64,
        (positions, body, origin): (&[Vec3Lanes], &BodyFrame, Vec3),
        steps: &[StepReport],
        state: Option<&Snapshot>,
    ) -> Result<(), Error> {
        if let Writer::Store(store) = &mut self.writer {
            store.step(steps);
        }
        (self.offered, self.last_time) = (number + 1, time);
        if !self.takes(number) {
            return Ok(());
        }
        let watch = Stopwatch::start();
        self.shape.place(positions, body, &mut self.points);
        let mut points = std::mem::take(&mut self.points);
        if origin != Vec3::ZERO {
            points.iter_mut().for_each(|point| *point += origin);
        }
        let frame = CacheFrame { number, time, points: &points, body: &body.moved(origin) };
        let added = self.write(&frame, state);
        self.points = points;
        self.time += watch.elapsed();
        added
    }

    fn write(&mut self, frame: &CacheFrame, state: Option<&Snapshot>) -> Result<(), Error> {
        match &mut self.writer {
            Writer::Store(store) => store.add(frame, state)?,
            Writer::Usd(usd) => usd.add(frame)?,
            Writer::Files(files) => files.add(frame)?,
        }
        self.frames += 1;
        Ok(())
    }

    /// Takes over the frames of a cache up to where its run stood.
    pub(crate) fn copy(&mut self, cache: &mut Cache, state: &Snapshot) -> Result<(), Error> {
        let (steps, report) = cache.report();
        if (cache.what(), cache.first(), cache.every()) != (self.shape.what, self.first, self.every) {
            let (what, first, every) = (cache.what().name(), cache.first(), cache.every());
            let frames = match every {
                1 => format!("every frame from {first} on"),
                _ => format!("frames {first}, {} and so on", first.saturating_add(every)),
            };
            let found = format!(
                "it holds {what}, {frames}, and the run would write something else: resume it with --what {what} \
                 --every {every} --from {first}"
            );
            return Err(Error::cache(cache.path(), found));
        }
        let after = state.frame.checked_sub(self.first);
        let count = after.map_or(0, |frames| (frames / self.every + 1) as usize);
        if cache.starts() != self.shape.starts || cache.len() < count {
            let found = format!("it holds {} frames of other hair or too few", cache.len());
            return Err(Error::cache(cache.path(), found));
        }
        let mut points = Vec::new();
        for index in 0..count {
            let body = &cache.read(index, &mut points)?;
            let (number, time) = (self.first + index as u32 * self.every, cache.times()[index]);
            self.write(&CacheFrame { number, time, points: &points, body }, None)?;
        }
        (self.offered, self.last_time) = (state.frame + 1, state.time);
        if let Writer::Store(store) = &mut self.writer {
            store.inherit(steps, report);
            store.set_state(Some(state))?;
        }
        Ok(())
    }

    /// Ends the file of a whole film, or of one that was stopped early.
    pub(crate) fn close(self, whole: bool, state: Option<&Snapshot>) -> Result<Written, Error> {
        let (strands, points) = (self.shape.strand_count(), self.shape.point_count());
        let watch = Stopwatch::start();
        let one = |path: PathBuf| (size(&path), path, Vec::new(), Vec::new());
        let (bytes, place, left_out, notes) = match self.writer {
            Writer::Store(store) if whole => one(store.finish(state)?),
            Writer::Store(store) => one(store.leave(state)?),
            Writer::Usd(usd) => one(usd.finish(whole)?),
            Writer::Files(files) => files.finish(),
        };
        let time = self.time + watch.elapsed();
        Ok(Written { place, frames: self.frames, strands, points, bytes, time, left_out, notes })
    }
}
