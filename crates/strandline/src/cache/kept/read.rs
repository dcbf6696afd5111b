//! Reading of kept frames: nothing is taken that the file has no bytes for.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use strandline_base::{
    npz::{Kind, Npz, Rows, f32s, f64s},
    open_plain,
};

use super::{
    Meta,
    meta::{LAYOUT, Version},
    prefix,
};
use crate::{
    Error, Scene,
    body::BodyFrame,
    groom::{LANES, Vec3Lanes},
    snapshot::{
        self, MAX_FRAMES, Snapshot,
        arrays::{check_memory, expect, missing, text},
    },
    strands::bodies::{self, LISTS, OF_FRAMES, WIDTHS},
};

/// Most bytes of `meta` for a frame beside its scenes, and for all scenes.
const OF_FRAME: u64 = 64 << 10;
const OF_SCENES: u64 = 64 << 20;
/// Farther than this \[m\] is no hair.
const MOST: f32 = 1e4;

/// A file of kept frames.
pub(crate) struct KeptFile<R = File> {
    npz: Npz<R>,
    pub meta: Meta,
    times: Rows,
    heads: Rows,
    lists: [Option<(Rows, usize)>; LISTS],
    points: Rows,
    /// Frames with points.
    pub count: usize,
}

impl KeptFile {
    /// Opens a file for guides of a shape.
    ///
    /// # Errors
    /// A file that cannot be read, or is none of this layout or this hair.
    pub fn open(path: &Path, shape: [usize; 2]) -> Result<Self, Error> {
        let file = open_plain(path, u64::MAX - 1).map_err(|error| Error::cache(path, error))?.into_inner();
        Self::new(file, shape).map_err(|found| Error::cache(path, found))
    }
}

impl<R: Read + Seek> KeptFile<R> {
    /// As [`KeptFile::open`], from bytes.
    ///
    /// # Errors
    /// A file that is none of this layout or this hair.
    pub fn new(source: R, [strands, points]: [usize; 2]) -> Result<Self, String> {
        let mut npz = Npz::new(source).map_err(text)?;
        let meta = read_meta(&mut npz)?;
        if [meta.strands as usize, meta.points as usize] != [strands, points] {
            return Err(format!(
                "{} strands of {} points, but the scene's hair has {strands} of {points}",
                meta.strands, meta.points
            ));
        }
        let (all, before) = (meta.frames.len() as u64, u64::from(meta.kept) - u64::from(meta.first));
        let count = all - before;
        let each = (strands.div_ceil(LANES) * points) as u64;
        let mut open = |name: &str, kind, shape: &[Option<u64>]| {
            let Some(rows) = npz.open(name).map_err(text)? else { return Err(missing(&npz, name)) };
            expect(&rows, name, kind, shape)?;
            Ok(rows)
        };
        let times = open("times", Kind::F64, &[Some(count)])?;
        let heads = open("world_from_head", Kind::F32, &[Some(count), Some(7)])?;
        let wanted = [Some(count), Some(each), Some(3), Some(LANES as u64)];
        let points = open("points", Kind::F32, &wanted)?;
        check_memory("points", 12 * LANES as u64 * each, 4)?;
        let mut lists = [None, None, None];
        for ((name, width), list) in OF_FRAMES.into_iter().zip(WIDTHS).zip(&mut lists) {
            let Some(rows) = npz.open(name).map_err(text)? else { continue };
            expect(&rows, name, Kind::F32, &[Some(count), None, Some(width as u64)])?;
            let length = rows.shape()[1];
            check_memory(name, length.saturating_mul(4 * width as u64), 4)?;
            *list = Some((rows, length as usize * width));
        }
        Ok(Self { npz, meta, times, heads, lists, points, count: count as usize })
    }

    /// Time, body and points of the frame in a row.
    ///
    /// # Errors
    /// Damage; numbers that are none of hair.
    pub fn frame(&mut self, row: usize) -> Result<(f64, BodyFrame, Vec<Vec3Lanes>), String> {
        let Self { npz, meta, times, heads, lists, points, count } = self;
        let mut sum = crc32fast::Hasher::new();
        let mut take = |rows: &mut Rows, bytes: usize| {
            let mut taken = vec![0; bytes];
            npz.go_to(rows, (row * bytes) as u64).map_err(text)?;
            npz.read(rows, &mut taken).map_err(text)?;
            sum.update(&taken);
            Ok::<_, String>(taken)
        };
        let time = f64s(&take(times, 8)?).next().unwrap_or(f64::NAN);
        let head: Vec<f32> = f32s(&take(heads, 28)?).collect();
        let mut found: [Vec<f32>; LISTS] = Default::default();
        for (list, found) in lists.iter_mut().zip(&mut found) {
            let Some((rows, numbers)) = list else { continue };
            *found = f32s(&take(rows, 4 * *numbers)?).collect();
        }
        let each = (meta.strands as usize).div_ceil(LANES) * meta.points as usize;
        let numbers: Vec<f32> = f32s(&take(points, 12 * LANES * each)?).collect();
        let wanted = meta.frames.get(meta.frames.len() - *count + row).map(|frame| frame.sum);
        if Some(sum.finalize()) != wanted {
            return Err(format!("frame {row} with another checksum, expected its own: it is damaged"));
        }
        if !time.is_finite() || numbers.iter().any(|number| !(number.abs() <= MOST)) {
            return Err(format!("frame {row} with numbers that are not finite or beyond {MOST} m"));
        }
        let body = bodies::body(bodies::pose(&head)?, &found)?;
        let lanes = numbers.chunks_exact(3 * LANES).map(|numbers| {
            let part = |axis: usize| std::array::from_fn(|lane| numbers[axis * LANES + lane]);
            Vec3Lanes { x: part(0), y: part(1), z: part(2) }
        });
        Ok((time, body, lanes.collect()))
    }

    /// State of a mark.
    ///
    /// # Errors
    /// Damage; numbers that are none of a state.
    pub fn mark(&mut self, mark: usize) -> Result<Snapshot, String> {
        let points = (self.meta.strands as usize).next_multiple_of(LANES) * self.meta.points as usize;
        let before = prefix(mark);
        let found = snapshot::read::read(&mut self.npz, &before, points as u64)?;
        found.ok_or_else(|| format!("no {before}state_clock, expected one"))
    }
}

fn read_meta<R: Read + Seek>(npz: &mut Npz<R>) -> Result<Meta, String> {
    let Some(mut rows) = npz.open("meta").map_err(text)? else {
        let names: Vec<&str> = npz.names().take(20).collect();
        return Err(format!("holds {names:?}, expected the kept frames of a project"));
    };
    expect(&rows, "meta", Kind::U8, &[Some(rows.bytes())])?;
    let frames = npz.open("times").map_err(text)?.and_then(|times| times.shape().first().copied());
    let most = OF_SCENES.saturating_add(OF_FRAME.saturating_mul(frames.unwrap_or(0).min(MAX_FRAMES)));
    if rows.bytes() > most {
        return Err(format!("meta of {} bytes, expected {most} at most", rows.bytes()));
    }
    check_memory("meta", rows.bytes(), 8)?;
    let bytes = npz.all(&mut rows).map_err(text)?;
    let version: Version = serde_json::from_slice(&bytes).map_err(|error| format!("meta: {error}"))?;
    if version.layout != LAYOUT {
        let Version { layout, written_by } = version;
        let by: String = written_by.chars().filter(|letter| !letter.is_control()).take(60).collect();
        return Err(format!(
            "layout {layout} of `{by}`, expected {LAYOUT}: it is of another version of the program"
        ));
    }
    let meta: Meta = serde_json::from_slice(&bytes).map_err(|error| format!("meta: {error}"))?;
    let end = u64::from(meta.first) + meta.frames.len() as u64;
    let is_sound = meta.first <= meta.kept && u64::from(meta.kept) < end && end <= MAX_FRAMES;
    if !is_sound
        || meta.marks.iter().any(|mark| !(u64::from(meta.first)..end).contains(&u64::from(mark.frame)))
    {
        return Err("meta with frames out of order, expected kept ones after the first".to_owned());
    }
    let scenes = meta.scenes.len();
    // Tasks and states have one of their own at most.
    let tasks = meta.frames.iter().filter_map(|frame| frame.tasks.as_ref()).map(Vec::len).sum::<usize>();
    let most = tasks + meta.marks.len();
    if scenes > most {
        return Err(format!("{scenes} scenes, expected {most} at most"));
    }
    check_memory("scenes", (scenes * size_of::<Scene>()) as u64, 1)?;
    let mut marked: Vec<u32> = meta.marks.iter().map(|mark| mark.frame).collect();
    marked.sort_unstable();
    marked.dedup();
    if marked.len() < meta.marks.len() {
        return Err("two states of a frame, expected one".to_owned());
    }
    if meta.marks.iter().any(|mark| mark.scene >= scenes) {
        return Err(format!("a mark with a scene that is not there, expected one of {scenes}"));
    }
    Ok(meta)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use strandline_base::npz::{Array, pack};

    use super::*;
    use crate::cache::kept::{FrameNote, MarkNote};

    fn refused(meta: &str) -> String {
        let bytes = pack(&[Array::of("meta", Kind::U8, &[meta.len()], meta.as_bytes().to_vec())]);
        KeptFile::new(Cursor::new(bytes), [8, 4]).err().unwrap()
    }

    #[test]
    fn files_of_other_versions_and_without_order_are_refused() {
        let newer = refused("{\"layout\": 2, \"written_by\": \"strandline 9\", \"new\": []}");
        assert!(
            newer.contains("layout 2 of `strandline 9`, expected 1: it is of another version"),
            "{newer}"
        );
        assert!(refused("{}").contains("layout"));
        assert!(refused("{\"layout\": 1}").contains("meta: missing field"));
        let meta = Meta { layout: LAYOUT, strands: 8, points: 4, kept: 3, ..Meta::default() };
        let of = |meta: &Meta| refused(&serde_json::to_string(meta).unwrap());
        assert!(of(&meta).contains("frames out of order"));
        let whole = Meta { kept: 0, frames: vec![FrameNote::default()], ..meta };
        assert!(of(&whole).contains("expected times"), "{}", of(&whole));
        assert!(of(&Meta { strands: 9, ..whole.clone() }).contains("9 strands of 4 points"));
        let marks = vec![MarkNote { frame: 7, ..MarkNote::default() }];
        assert!(of(&Meta { marks, ..whole.clone() }).contains("out of order"));
        let marks = vec![MarkNote::default(); 2];
        let scenes = vec![String::new(); 7];
        assert!(of(&Meta { marks: marks.clone(), scenes, ..whole.clone() }).contains("7 scenes, expected 2"));
        assert!(of(&Meta { marks, scenes: vec![String::new()], ..whole }).contains("two states"));
    }
}
