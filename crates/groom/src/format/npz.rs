//! `.npz`, NumPy arrays by name in a zip archive: ours, those of research code, and frames of a moving cache.

use std::collections::BTreeMap;
use std::io::Cursor;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};
use strandline_base::npz::{self, Kind, Npz};

use super::bytes::Source;
use super::chosen::Chosen;
use super::npy::{self as array, Array, refused};
use super::{Attribute, MAX_POINTS, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError, Influences, Widths};

/// Names of arrays of points; the first that is present counts.
const PLACES: [&str; 3] = ["points", "positions", "strands"];
/// Largest text with names \[byte\].
const MAX_META: usize = 16 << 20;
/// Arrays may be larger than the archive by this factor and so many bytes: real strands shrink to a third at
/// best, constant attributes a thousandfold.
const INFLATION: u64 = 64;
const SPARE: u64 = 16 << 20;

/// The keys of `meta` that a groom reads and writes.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Meta {
    version: u32,
    units: String,
    up: String,
    what: String,
    groups: BTreeMap<u32, String>,
    /// Names of a moving cache by number, empty where a group has none.
    #[serde(skip_serializing)]
    group_names: Vec<String>,
}

/// The arrays of a file by their names.
struct Arrays<'a> {
    source: Source<'a>,
    npz: Npz<Cursor<&'a [u8]>>,
    /// Frame of a moving cache.
    frame: u64,
}

impl<'a> Arrays<'a> {
    /// Reads the directory. The size of all arrays is bounded by that of the archive.
    fn new(bytes: &'a [u8]) -> Result<Self, GroomError> {
        let source = Source { bytes, format: ".npz" };
        let npz = Npz::new(Cursor::new(bytes)).map_err(|error| refused(&source, error))?;
        let (total, most) = (npz.unpacked_bytes(), INFLATION * bytes.len() as u64 + SPARE);
        if total > most {
            let found = format!("arrays of {total} bytes in an archive of {}", bytes.len());
            return Err(source.error(found, format!("{most} bytes at most; store them with `numpy.savez`")));
        }
        Ok(Self { source, npz, frame: 0 })
    }

    /// True if an array of this name is present.
    fn has(&self, name: &str) -> bool {
        self.npz.names().any(|found| found == name)
    }

    /// The array of a name, `None` where the file has none.
    fn get(&mut self, name: &str) -> Result<Option<Array<'static>>, GroomError> {
        let source = self.source;
        let refused = |error| refused(&source, error);
        let Some(mut rows) = self.npz.open(name).map_err(refused)? else { return Ok(None) };
        let bytes = self.npz.all(&mut rows).map_err(refused)?.into();
        Ok(Some(Array { shape: rows.shape().to_vec(), kind: rows.kind(), bytes }))
    }

    /// The result of `make` on the array of a name, `None` where the file has none.
    fn with<T>(
        &mut self,
        name: &str,
        make: impl Fn(&Source, &Array) -> Result<T, GroomError>,
    ) -> Result<Option<T>, GroomError> {
        self.get(name)?.map(|array| make(&self.source, &array)).transpose()
    }

    /// The numbers of an array of rows of `columns` numbers.
    fn floats(&mut self, name: &str, rows: usize, columns: usize) -> Result<Option<Vec<f32>>, GroomError> {
        let frame = self.frame;
        self.with(name, |source, array| {
            let fits = |found: u64, each: u64| found == rows as u64 && each == columns as u64;
            let first = match array.shape[..] {
                [found] if fits(found, 1) => Some(0),
                [found, each] if fits(found, each) => Some(0),
                // Frames of a moving cache.
                [frames, found, each] if frame < frames && fits(found, each) => Some(frame as usize),
                _ => None,
            };
            let Some(first) = first else {
                let found = format!("`{name}` of shape {:?}", array.shape);
                return Err(source.error(found, format!("[{rows}, {columns}]")));
            };
            Ok(array.floats_from(first * rows * columns, rows * columns))
        })
    }

    /// True if an array has a row for each strand in place of each point.
    fn is_of(&mut self, name: &str, strands: usize, points: usize) -> Result<bool, GroomError> {
        let source = self.source;
        let rows = self.npz.open(name).map_err(|error| refused(&source, error))?;
        Ok(strands != points && rows.is_some_and(|rows| rows.shape().first() == Some(&(strands as u64))))
    }

    fn whole(&mut self, name: &str, rows: usize) -> Result<Option<Vec<u32>>, GroomError> {
        self.with(name, |source, array| {
            if array.shape != [rows as u64] {
                let found = format!("`{name}` of shape {:?}", array.shape);
                return Err(source.error(found, format!("[{rows}]")));
            }
            array.whole(source, name)
        })
    }

    fn triples(&mut self, name: &str, rows: usize) -> Result<Option<Vec<[f32; 3]>>, GroomError> {
        Ok(self.floats(name, rows, 3)?.map(|all| all.as_chunks().0.to_vec()))
    }

    fn vectors(&mut self, name: &str, rows: usize) -> Result<Option<Vec<Vec3>>, GroomError> {
        Ok(self.triples(name, rows)?.map(|all| all.into_iter().map(Vec3::from_array).collect()))
    }
}

/// Reads a `.npz` file. A moving cache gives the strands of its first frame.
///
/// # Errors
/// [`GroomError::Malformed`] with the error; arrays that do not fit each other.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    read_frame(bytes, Chosen { per_strand, frame: None })
}

/// Reads a `.npz` file; a moving cache gives the strands of a frame where they lie in the world.
///
/// # Errors
/// As [`read`]; a frame that the file does not have.
pub(super) fn read_frame(bytes: &[u8], chosen: Chosen) -> Result<Parsed, GroomError> {
    let mut arrays = Arrays::new(bytes)?;
    arrays.frame = chosen.frame.unwrap_or(0).into();
    let mut problems = Vec::new();
    let mut groom = places(&mut arrays, chosen, &mut problems)?;
    let (strands, points) = (groom.strand_count(), groom.points.len());
    groom.widths = widths(&mut arrays, strands, points)?.unwrap_or(groom.widths);
    groom.colors = match arrays.is_of("colors", strands, points)? {
        true => arrays.triples("colors", strands)?.map(|colors| {
            let counts = groom.starts.windows(2).map(|pair| (pair[1] - pair[0]) as usize);
            colors.iter().zip(counts).flat_map(|(color, count)| std::iter::repeat_n(*color, count)).collect()
        }),
        false => arrays.triples("colors", points)?,
    };
    groom.transparencies = arrays.floats("transparencies", points, 1)?;
    let uvs = match arrays.floats("root_uv", strands, 2)? {
        None => arrays.floats("uv_coords", strands, 2)?,
        uvs => uvs,
    };
    groom.root_uvs = uvs.map(|all| all.chunks_exact(2).map(Vec2::from_slice).collect());
    groom.root_normals = arrays.vectors("root_normals", strands)?;
    groom.groups = arrays.whole("groups", strands)?;
    let flags = arrays.whole("guide_flags", strands)?;
    groom.guide_flags = flags.map(|all| all.into_iter().map(|flag| flag != 0).collect());
    groom.influences = influences(&mut arrays, strands)?;
    groom.masses = arrays.floats("masses", points, 1)?;
    groom.velocities = arrays.vectors("velocities", points)?;
    let Meta { groups, group_names, .. } = meta(&mut arrays)?;
    let of_cache = (0..).zip(group_names).filter(|(_, name)| !name.is_empty());
    groom.group_names = of_cache.chain(groups).collect();
    Ok(Parsed { format: ".npz", groom, problems })
}

/// Widths of points or strands, or twice the radii of them.
fn widths(arrays: &mut Arrays, strands: usize, points: usize) -> Result<Option<Widths>, GroomError> {
    for (name, factor) in [("widths", 1.0), ("strand_widths", 1.0), ("radii", 2.0)] {
        let is_of_strands = name == "strand_widths" || arrays.is_of(name, strands, points)?;
        let found = arrays.floats(name, if is_of_strands { strands } else { points }, 1)?;
        let found = found.map(|all| all.into_iter().map(|width| factor * width).collect());
        if let Some(widths) = found {
            return Ok(Some(if is_of_strands {
                Widths::PerStrand(widths)
            } else {
                Widths::PerPoint(widths)
            }));
        }
    }
    Ok(None)
}

/// The strands alone.
fn places(arrays: &mut Arrays, chosen: Chosen, problems: &mut Vec<String>) -> Result<Groom, GroomError> {
    let Some(name) = PLACES.iter().find(|name| arrays.has(name)) else {
        let names: Vec<&str> = arrays.npz.names().take(8).collect();
        return Err(arrays.source.error(
            format!("the arrays {names:?}"),
            "one of `points` or `positions`, with `starts` or `counts`",
        ));
    };
    let starts = starts(arrays)?;
    let placed = arrays.with(name, |source, array| match &starts {
        None => Ok((array::strands(source, array, chosen.per_strand)?, 1)),
        Some(starts) => from_starts(source, array, starts, chosen.frame.unwrap_or(0).into()),
    })?;
    let (groom, frames) = placed.expect("the array is there");
    if frames > 1 {
        problems.push(match chosen.frame {
            None => format!("it holds {frames} frames: the strands of the first are taken"),
            Some(frame) => format!("it holds {frames} frames: the strands of frame {frame} are taken"),
        });
    }
    Ok(groom)
}

/// First points of strands and the number of points, by any of the names that research code has for them.
fn starts(arrays: &mut Arrays) -> Result<Option<Vec<u32>>, GroomError> {
    for name in ["starts", "offsets"] {
        let starts = arrays.with(name, |source, array| array.whole(source, name))?;
        if starts.is_some() {
            return Ok(starts);
        }
    }
    let counts = arrays.with("counts", |source, array| array.whole(source, "counts"))?;
    let Some(counts) = counts else { return Ok(None) };
    let mut total = 0_u64;
    let ends = counts.iter().map(|count| {
        total += u64::from(*count);
        u32::try_from(total).unwrap_or(u32::MAX)
    });
    Ok(Some([0].into_iter().chain(ends).collect()))
}

/// Strands that begin at `starts` in an array of points or in a frame of points, and the number of frames.
fn from_starts(
    source: &Source,
    array: &Array,
    starts: &[u32],
    frame: u64,
) -> Result<(Groom, u64), GroomError> {
    let (frames, points) = match array.shape[..] {
        [points, 3] => (1, points),
        [frames, points, 3] if frames > 0 => (frames, points),
        _ => return Err(source.error(format!("`points` of shape {:?}", array.shape), "[point, 3]")),
    };
    if frame >= frames {
        return Err(source.error(format!("{frames} frames"), format!("a frame {frame}, counted from 0")));
    }
    let rising = starts.windows(2).all(|pair| pair[0] <= pair[1]);
    let whole = starts.first() == Some(&0) && starts.last().map(|last| u64::from(*last)) == Some(points);
    let strands = starts.len() as u64 - u64::from(!starts.is_empty());
    if !(rising && whole && (1..=MAX_STRANDS).contains(&strands) && points <= MAX_POINTS) {
        let found = format!("`starts` of {} numbers for {points} points", starts.len());
        return Err(
            source.error(found, "the first point of each strand, rising from 0, and the number of points")
        );
    }
    let points = array::points(array, frame * points, points);
    Ok((Groom { starts: starts.to_vec(), points, ..Groom::empty(0.0) }, frames))
}

fn influences(arrays: &mut Arrays, strands: usize) -> Result<Option<Influences>, GroomError> {
    let guides = arrays.with("guide_indices", |source, array| {
        Ok((array.shape.clone(), array.whole(source, "guide_indices")?))
    })?;
    let Some((shape, guides)) = guides else { return Ok(None) };
    let [rows, each] = shape[..] else {
        return Err(arrays
            .source
            .error(format!("`guide_indices` of shape {shape:?}"), "[strand, 3 or more]"));
    };
    // A cache of guides names the guides of strands that are not among its points.
    if rows != strands as u64 {
        return Ok(None);
    }
    let weights = arrays.floats("guide_weights", strands, each as usize)?;
    let weights =
        weights.ok_or_else(|| arrays.source.error("`guide_indices` alone", "`guide_weights` too"))?;
    Influences::new(each as usize, guides, weights, strands).map(Some)
}

fn meta(arrays: &mut Arrays) -> Result<Meta, GroomError> {
    let Some(array) = arrays.get("meta")? else { return Ok(Meta::default()) };
    let text = array.raw().filter(|text| text.len() <= MAX_META);
    // A groom reads the names of groups alone: other text is ignored.
    Ok(text.and_then(|text| serde_json::from_slice(text).ok()).unwrap_or_default())
}

/// Writes a `.npz` file.
///
/// # Errors
/// None: the format holds every groom.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let (strands, points) = (groom.strand_count(), groom.points.len());
    let whole = |name, shape: &[usize], all: &[u32]| npz::Array::u32s(name, shape, all.iter().copied());
    let floats = |name, shape: &[usize], all: &[f32]| npz::Array::f32s(name, shape, all.iter().copied());
    let vectors = |name, rows, all: &[Vec3]| {
        npz::Array::f32s(name, &[rows, 3], all.iter().flat_map(|vector| vector.to_array()))
    };
    let mut arrays =
        vec![vectors("points", points, &groom.points), whole("starts", &[strands + 1], &groom.starts)];
    match &groom.widths {
        Widths::PerPoint(widths) => arrays.push(floats("widths", &[points], widths)),
        _ if Attribute::Widths.is_in(groom) => {
            arrays.push(npz::Array::f32s("strand_widths", &[strands], groom.root_widths()));
        }
        // The width that a reader gives where a file has none is left out.
        _ => {}
    }
    let colors = groom.colors.as_ref().map(|all| floats("colors", &[points, 3], all.as_flattened()));
    arrays.extend(colors);
    arrays.extend(groom.transparencies.as_ref().map(|all| floats("transparencies", &[points], all)));
    let uvs =
        |all: &Vec<Vec2>| npz::Array::f32s("root_uv", &[strands, 2], all.iter().flat_map(|uv| uv.to_array()));
    arrays.extend(groom.root_uvs.as_ref().map(uvs));
    arrays.extend(groom.root_normals.as_ref().map(|all| vectors("root_normals", strands, all)));
    arrays.extend(groom.groups.as_ref().map(|all| whole("groups", &[strands], all)));
    let flags = |all: &Vec<bool>| {
        npz::Array::of("guide_flags", Kind::U8, &[strands], all.iter().map(|flag| u8::from(*flag)).collect())
    };
    arrays.extend(groom.guide_flags.as_ref().map(flags));
    if let Some(influences) = &groom.influences {
        let shape = [strands, influences.per_strand()];
        arrays.push(whole("guide_indices", &shape, influences.guides()));
        arrays.push(floats("guide_weights", &shape, influences.weights()));
    }
    arrays.extend(groom.masses.as_ref().map(|all| floats("masses", &[points], all)));
    arrays.extend(groom.velocities.as_ref().map(|all| vectors("velocities", points, all)));
    let meta = Meta {
        version: 1,
        units: "m".to_owned(),
        up: "y".to_owned(),
        what: "groom".to_owned(),
        groups: groom.group_names.clone(),
        group_names: Vec::new(),
    };
    let meta = serde_json::to_vec(&meta).expect("plain text");
    arrays.push(npz::Array::of("meta", Kind::U8, &[meta.len()], meta));
    Ok(npz::pack(&arrays))
}
