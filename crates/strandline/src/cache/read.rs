//! The moving cache as it is read: frame by frame, nothing taken that the file has no bytes for.

use std::fs::File;
use std::io::{Cursor, Read, Seek};
use std::path::{Path, PathBuf};

use glam::Vec3;
use strandline_base::{
    FileProblem, fill_lanes,
    memory::{self, Need},
    npz::{Kind, Npz, Rows, f32s, f64s},
    open_plain, refuse_busy,
};

use super::{
    What,
    meta::{self, read_meta},
    relative,
};
use crate::{
    Error, Scene,
    body::{BodyFrame, Pose},
    groom::{LANES, Vec3Lanes, block_count},
    snapshot::{
        self, Snapshot,
        arrays::{check_memory, expect, missing, numbers, starts, text},
    },
    strands::bodies::{self, LISTS, OF_FRAMES, WIDTHS},
};

/// Farther than this \[m\] is no hair.
const MOST: f32 = 1e4;

/// A moving cache: hair at every frame, as docs/cache.md describes it.
pub struct Cache {
    path: PathBuf,
    frames: Frames<File>,
}

/// The arrays of a cache.
struct Frames<R> {
    npz: Npz<R>,
    points: Rows,
    starts: Vec<u32>,
    times: Vec<f64>,
    heads: Vec<Pose>,
    /// Lists of the bodies that the file has, each with the length of a frame's.
    lists: [Option<(Rows, usize)>; LISTS],
    meta: meta::Meta,
    /// One frame as it is in the file.
    bytes: Vec<u8>,
}

impl Cache {
    /// Opens a cache.
    ///
    /// # Errors
    /// A file that cannot be read, or is no cache of this layout.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = open_plain(path, u64::MAX - 1).map_err(|error| Error::cache(path, error))?.into_inner();
        let frames = Frames::new(file).map_err(|found| Error::cache(path, found))?;
        Ok(Self { path: path.to_owned(), frames })
    }

    /// Opens a cache whose run is to be resumed.
    ///
    /// # Errors
    /// As [`Cache::open`]; another run is writing it.
    pub fn open_to_resume(path: &Path) -> Result<Self, Error> {
        if refuse_busy(path).is_err() {
            return Err(Error::BusyFile { path: path.to_owned() });
        }
        Self::open(path)
    }

    fn refuse(&self, found: impl Into<FileProblem>) -> Error {
        Error::cache(&self.path, found)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of frames in the file.
    pub fn len(&self) -> usize {
        self.frames.times.len()
    }

    /// True without frames.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// First point of each strand, then the number of points.
    pub fn starts(&self) -> &[u32] {
        &self.frames.starts
    }

    /// Time of each frame since the beginning of the film \[s\], rising.
    pub fn times(&self) -> &[f64] {
        &self.frames.times
    }

    /// Strands that it holds.
    pub fn what(&self) -> What {
        self.frames.meta.what
    }

    /// Every how many of the film's frames is in it.
    pub fn every(&self) -> u32 {
        self.frames.meta.every
    }

    /// The first frame of the film that it holds.
    pub fn first(&self) -> u32 {
        self.frames.meta.first
    }

    /// The scene that it was made with.
    ///
    /// # Errors
    /// It names none, or one that this version does not read.
    pub fn scene(&self) -> Result<Scene, Error> {
        let meta = &self.frames.meta;
        if meta.scene.is_empty() {
            return Err(self.refuse("it names no scene, expected one in `meta`: name it with --scene"));
        }
        let mut scene = Scene::parse(&meta.scene, &format!("{} (in the cache)", self.path.display()))?;
        // Older caches have an absolute folder.
        scene.folder = relative::folder_of(&self.path).join(&meta.scene_folder);
        Ok(scene)
    }

    /// Reads the points \[m\] of a frame, world space, strand after strand, and its body.
    ///
    /// # Errors
    /// The file cannot be read, or holds points that are not finite.
    pub fn read(&mut self, frame: usize, points: &mut Vec<Vec3>) -> Result<BodyFrame, Error> {
        let body = self.frames.read(frame, points);
        body.map_err(|found| Error::cache(&self.path, found))
    }

    /// Reads a frame into blocks of lanes, `points_per_strand` points of each strand: its own, or as many evenly along
    /// them; lanes without a strand take the last one.
    pub(crate) fn read_lanes(
        &mut self,
        frame: usize,
        points_per_strand: usize,
        lanes: &mut [Vec3Lanes],
    ) -> Result<BodyFrame, Error> {
        let mut points = Vec::new();
        let body = self.read(frame, &mut points)?;
        let strands = self.starts().len() - 1;
        let own = points.len() / strands;
        let step = (own - 1) as f32 / (points_per_strand - 1).max(1) as f32;
        fill_lanes(lanes, strands, points_per_strand, |strand, point| {
            let first = own * strand;
            if own == points_per_strand {
                points[first + point]
            } else {
                let low = ((step * point as f32) as usize).min(own - 2);
                points[first + low].lerp(points[first + low + 1], step * point as f32 - low as f32)
            }
        });
        Ok(body)
    }

    /// Number of points of every strand.
    ///
    /// # Errors
    /// Strands of different numbers of points, or of less than four.
    pub(crate) fn points_per_strand(&self) -> Result<usize, Error> {
        let starts = self.starts();
        let points = starts[1] as usize;
        if points < 4 || starts.iter().enumerate().any(|(strand, start)| *start as usize != strand * points) {
            let found = "it holds strands of less than four or of different numbers of points";
            return Err(self.refuse(format!("{found}, expected strands as `sim --out` writes them")));
        }
        Ok(points)
    }

    /// Numbers that it has for each point, rows of `columns`; none where it has none of a name.
    pub(crate) fn per_point(&mut self, name: &str, columns: u64) -> Result<Option<Vec<f32>>, Error> {
        let found = self.frames.per_point(name, columns);
        found.map_err(|found| Error::cache(&self.path, found))
    }

    /// Refuses other hair than guides of this shape.
    pub(crate) fn check_guides(&self, strands: usize, points: usize) -> Result<(), Error> {
        if self.what() != What::Guides {
            return Err(self.refuse(
                "it holds drawn strands, expected guides, which a run resumes from: write it with --what guides",
            ));
        }
        let starts = self.starts();
        let even = starts.len() == strands + 1
            && starts.iter().enumerate().all(|(strand, start)| *start as usize == strand * points);
        if even {
            return Ok(());
        }
        let found = format!("{} strands, {} points", starts.len() - 1, starts.last().unwrap_or(&0));
        Err(self.refuse(format!(
            "it holds {found}, but the scene's hair has {strands} strands of {points} points: name the scene that it \
             was made with"
        )))
    }

    /// State of the run, for guides of this shape; none in a cache without it.
    pub(crate) fn snapshot(&mut self, strands: usize, points: usize) -> Result<Option<Snapshot>, Error> {
        let snapshot =
            snapshot::read::read(&mut self.frames.npz, "", (block_count(strands) * LANES * points) as u64);
        snapshot.map_err(|found| Error::cache(&self.path, found))
    }

    /// Steps of the run so far, without settling.
    pub(crate) fn steps(&self) -> u64 {
        self.frames.meta.steps
    }

    /// Steps so far, and the quality of those that led to each frame.
    pub(super) fn report(&self) -> (u64, meta::Report) {
        (self.frames.meta.steps, self.frames.meta.report.clone())
    }
}

/// Checks that bytes are a moving cache of which every frame can be read.
///
/// # Errors
/// The reason why they are not.
pub fn check_cache(bytes: &[u8]) -> Result<(), String> {
    let mut frames = Frames::new(Cursor::new(bytes))?;
    let mut points = Vec::new();
    for frame in 0..frames.times.len() {
        frames.read(frame, &mut points)?;
    }
    snapshot::read::read(&mut frames.npz, "", bytes.len() as u64).map(|_| ())
}

impl<R: Read + Seek> Frames<R> {
    fn new(source: R) -> Result<Self, String> {
        let mut npz = Npz::new(source).map_err(text)?;
        let starts = starts(&mut npz)?;
        let count = u64::from(*starts.last().unwrap_or(&0));
        let Some(points) = npz.open("points").map_err(text)? else {
            return Err(missing(&npz, "points"));
        };
        let rows = expect(&points, "points", Kind::F32, &[None, Some(count), Some(3)])?;
        let times: Vec<f64> = numbers(&mut npz, "times", Kind::F64, &[None], |bytes| f64s(bytes).collect())?;
        let head: Vec<f32> =
            numbers(&mut npz, "world_from_head", Kind::F32, &[None, Some(7)], |bytes| f32s(bytes).collect())?;
        // A run that was ended while it added a frame may have it in some of them alone.
        let frames = (rows as usize).min(times.len()).min(head.len() / 7);
        let times = times[..frames].to_vec();
        if let Some(pair) = times.windows(2).find(|pair| !(pair[0] < pair[1])) {
            return Err(format!("times hold {} after {} s, expected times that rise", pair[1], pair[0]));
        }
        if times.iter().any(|time| !time.is_finite()) {
            return Err("times hold a number that is not finite".to_owned());
        }
        let heads = head.chunks_exact(7).take(frames).map(bodies::pose).collect::<Result<_, String>>()?;
        let lists = lists(&mut npz, frames as u64)?;
        let meta = read_meta(&mut npz, frames as u64)?;
        let need = Need::new(format!("a frame of {count} points"), count, 12 + 12);
        memory::check(&[need]).map_err(|error| error.to_string())?;
        Ok(Self { npz, points, starts, times, heads, lists, meta, bytes: Vec::new() })
    }

    fn read(&mut self, frame: usize, points: &mut Vec<Vec3>) -> Result<BodyFrame, String> {
        let Some(pose) = self.heads.get(frame).copied() else {
            return Err(format!("it holds {} frames, but frame {frame} is asked for", self.heads.len()));
        };
        let count = *self.starts.last().unwrap_or(&0) as usize;
        self.bytes.resize(12 * count, 0);
        self.npz.go_to(&mut self.points, frame as u64 * self.bytes.len() as u64).map_err(text)?;
        self.npz.read(&mut self.points, &mut self.bytes).map_err(text)?;
        points.clear();
        points.extend(self.bytes.chunks_exact(12).map(|bytes| {
            let number =
                |at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
            Vec3::new(number(0), number(4), number(8))
        }));
        match points.iter().position(|point| !(point.abs().max_element() <= MOST)) {
            Some(at) => Err(format!(
                "point {at} of frame {frame} lies at {}, expected no more than {MOST} m",
                points[at]
            )),
            None => self.body(frame, pose),
        }
    }

    /// The body of a frame with a pose of its head.
    fn body(&mut self, frame: usize, head: Pose) -> Result<BodyFrame, String> {
        let mut found: [Vec<f32>; LISTS] = Default::default();
        for (list, found) in self.lists.iter_mut().zip(&mut found) {
            let Some((rows, numbers)) = list else { continue };
            let mut bytes = vec![0; 4 * *numbers];
            self.npz.go_to(rows, frame as u64 * bytes.len() as u64).map_err(text)?;
            self.npz.read(rows, &mut bytes).map_err(text)?;
            *found = f32s(&bytes).collect();
        }
        bodies::body(head, &found)
    }

    fn per_point(&mut self, name: &str, columns: u64) -> Result<Option<Vec<f32>>, String> {
        if self.npz.open(name).map_err(text)?.is_none() {
            return Ok(None);
        }
        let count = Some(u64::from(*self.starts.last().unwrap_or(&0)));
        let shape = [count, Some(columns)];
        let shape = &shape[..if columns == 1 { 1 } else { 2 }];
        let found: Vec<f32> = numbers(&mut self.npz, name, Kind::F32, shape, |bytes| f32s(bytes).collect())?;
        match found.iter().find(|number| !(**number >= 0.0 && **number <= MOST)) {
            Some(number) => Err(format!("{name} hold {number}, expected numbers of 0 to {MOST}")),
            None => Ok(Some(found)),
        }
    }
}

/// Lists of the bodies of all frames, with the numbers of one frame.
fn lists<R: Read + Seek>(npz: &mut Npz<R>, frames: u64) -> Result<[Option<(Rows, usize)>; LISTS], String> {
    let mut lists = [None, None, None];
    for ((name, width), list) in OF_FRAMES.into_iter().zip(WIDTHS).zip(&mut lists) {
        let Some(rows) = npz.open(name).map_err(text)? else { continue };
        let found = expect(&rows, name, Kind::F32, &[None, None, Some(width as u64)])?;
        let length = rows.shape()[1];
        if found < frames {
            return Err(format!("{name} of {found} frames, expected {frames}"));
        }
        check_memory(name, length.saturating_mul(4 * width as u64), 2)?;
        *list = Some((rows, length as usize * width));
    }
    Ok(lists)
}
