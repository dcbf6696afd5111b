//! `.npz`, NumPy arrays by name in a zip archive: ours, those of research code, and frames of a moving cache.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::bytes::Source;
use super::npy::{self, Array};
use super::zip::{self, Entry};
use super::{MAX_POINTS, MAX_STRANDS, Parsed, Part};
use crate::{Groom, GroomError, Influences, Widths};

/// Arrays that hold points, the first that is there counts.
const PLACES: [&str; 3] = ["points", "positions", "strands"];
/// Largest text with names \[byte\].
const MAX_META: usize = 16 << 20;

/// Fields of `meta` that concern a groom.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Meta {
    version: u32,
    units: String,
    up: String,
    what: String,
    groups: BTreeMap<u32, String>,
}

/// The arrays of a file by their names.
struct Arrays<'a> {
    source: Source<'a>,
    entries: Vec<Entry>,
}

impl Arrays<'_> {
    /// The bytes of an array, where there is one of a name.
    fn bytes(&self, name: &str) -> Result<Option<Vec<u8>>, GroomError> {
        let entry = self.entries.iter().find(|entry| entry.name.strip_suffix(".npy") == Some(name));
        entry.map(|entry| zip::unpack(&self.source, entry)).transpose()
    }

    /// Result of a function of an array, if there is one of a name.
    fn with<T>(
        &self,
        name: &str,
        make: impl Fn(&Source, &Array) -> Result<T, GroomError>,
    ) -> Result<Option<T>, GroomError> {
        let Some(bytes) = self.bytes(name)? else { return Ok(None) };
        let source = Source { bytes: &bytes, format: ".npz" };
        make(&source, &Array::new(&source)?).map(Some)
    }

    /// The numbers of an array of rows of `columns` numbers.
    fn floats(&self, name: &str, rows: usize, columns: usize) -> Result<Option<Vec<f32>>, GroomError> {
        self.with(name, |source, array| {
            let is_rows = match array.shape[..] {
                [found] => columns == 1 && found == rows as u64,
                [found, each] => found == rows as u64 && each == columns as u64,
                // Frames of a moving cache: the first one counts.
                [frames, found, each] => frames > 0 && found == rows as u64 && each == columns as u64,
                _ => false,
            };
            if !is_rows {
                let found = format!("`{name}` of shape {:?}", array.shape);
                return Err(source.error(found, format!("[{rows}, {columns}]")));
            }
            Ok(array.first_floats(rows * columns))
        })
    }

    fn whole(&self, name: &str, rows: usize) -> Result<Option<Vec<u32>>, GroomError> {
        self.with(name, |source, array| {
            if array.shape != [rows as u64] {
                let found = format!("`{name}` of shape {:?}", array.shape);
                return Err(source.error(found, format!("[{rows}]")));
            }
            array.whole(source, name)
        })
    }
}

/// Reads a `.npz` file. A moving cache gives the strands of its first frame.
///
/// # Errors
/// [`GroomError::Malformed`] with what is wrong; arrays that do not fit each other.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".npz" };
    let arrays = Arrays { source, entries: zip::entries(&source)? };
    let mut problems = Vec::new();
    let mut groom = places(&arrays, per_strand, &mut problems)?;
    let (strands, points) = (groom.strand_count(), groom.points.len());
    if let Some(widths) = arrays.floats("widths", points, 1)? {
        groom.widths = Widths::PerPoint(widths);
    } else if let Some(widths) = arrays.floats("strand_widths", strands, 1)? {
        groom.widths = Widths::PerStrand(widths);
    }
    let triples = |name, rows| -> Result<Option<Vec<[f32; 3]>>, GroomError> {
        Ok(arrays.floats(name, rows, 3)?.map(|all| all.as_chunks().0.to_vec()))
    };
    let vectors = |name, rows| -> Result<Option<Vec<Vec3>>, GroomError> {
        Ok(triples(name, rows)?.map(|all| all.into_iter().map(Vec3::from_array).collect()))
    };
    groom.colors = triples("colors", points)?;
    groom.transparencies = arrays.floats("transparencies", points, 1)?;
    let uvs = match arrays.floats("root_uv", strands, 2)? {
        None => arrays.floats("uv_coords", strands, 2)?,
        uvs => uvs,
    };
    groom.root_uvs = uvs.map(|all| all.chunks_exact(2).map(Vec2::from_slice).collect());
    groom.root_normals = vectors("root_normals", strands)?;
    groom.groups = arrays.whole("groups", strands)?;
    let flags = arrays.whole("guide_flags", strands)?;
    groom.guide_flags = flags.map(|all| all.into_iter().map(|flag| flag != 0).collect());
    groom.influences = influences(&arrays, strands)?;
    groom.masses = arrays.floats("masses", points, 1)?;
    groom.velocities = vectors("velocities", points)?;
    groom.group_names = meta(&arrays)?.groups;
    Ok(Parsed { format: ".npz", groom, problems })
}

/// The strands alone.
fn places(arrays: &Arrays, per_strand: Option<u32>, problems: &mut Vec<String>) -> Result<Groom, GroomError> {
    let name =
        PLACES.iter().find(|name| arrays.entries.iter().any(|entry| entry.name == format!("{name}.npy")));
    let Some(name) = name else {
        let names: Vec<&str> = arrays.entries.iter().take(8).map(|entry| &entry.name[..]).collect();
        return Err(arrays.source.error(format!("the arrays {names:?}"), "one of `points` or `positions`"));
    };
    let starts = arrays.with("starts", |source, array| array.whole(source, "starts"))?;
    let placed = arrays.with(name, |source, array| match &starts {
        None => Ok((npy::strands(source, array, per_strand)?, 1)),
        Some(starts) => from_starts(source, array, starts),
    })?;
    let (groom, frames) = placed.expect("the array is there");
    if frames > 1 {
        problems.push(format!("it holds {frames} frames: the strands of the first are taken"));
    }
    Ok(groom)
}

/// Strands that begin where `starts` says, in an array of points or of frames of points; how many frames.
fn from_starts(source: &Source, array: &Array, starts: &[u32]) -> Result<(Groom, u64), GroomError> {
    let (frames, points) = match array.shape[..] {
        [points, 3] => (1, points),
        [frames, points, 3] if frames > 0 => (frames, points),
        _ => return Err(source.error(format!("`points` of shape {:?}", array.shape), "[point, 3]")),
    };
    let rising = starts.windows(2).all(|pair| pair[0] <= pair[1]);
    let whole = starts.first() == Some(&0) && starts.last().map(|last| u64::from(*last)) == Some(points);
    let strands = starts.len() as u64 - u64::from(!starts.is_empty());
    if !(rising && whole && (1..=MAX_STRANDS).contains(&strands) && points <= MAX_POINTS) {
        let found = format!("`starts` of {} numbers for {points} points", starts.len());
        return Err(
            source.error(found, "the first point of each strand, rising from 0, and the number of points")
        );
    }
    let points = npy::points(array, points);
    Ok((Groom { starts: starts.to_vec(), points, ..Groom::empty(0.0) }, frames))
}

fn influences(arrays: &Arrays, strands: usize) -> Result<Option<Influences>, GroomError> {
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

fn meta(arrays: &Arrays) -> Result<Meta, GroomError> {
    let Some(bytes) = arrays.bytes("meta")? else { return Ok(Meta::default()) };
    let source = Source { bytes: &bytes, format: ".npz" };
    let array = Array::new(&source)?;
    let text = array.raw().filter(|text| text.len() <= MAX_META);
    // Names of groups alone are of interest here: a text that says something else says nothing.
    Ok(text.and_then(|text| serde_json::from_slice(text).ok()).unwrap_or_default())
}

/// Writes a `.npz` file.
///
/// # Errors
/// A groom of more than 4 GiB.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let (strands, points) = (groom.strand_count(), groom.points.len());
    let whole = |shape: &[usize], numbers: &[u32]| {
        npy::array("<u4", shape, numbers.iter().flat_map(|number| number.to_le_bytes()))
    };
    let mut files = vec![
        ("points.npy", npy::floats(&[points, 3], groom.points.iter().flat_map(|point| point.to_array()))),
        ("starts.npy", whole(&[strands + 1], &groom.starts)),
    ];
    match &groom.widths {
        Widths::PerPoint(widths) => {
            files.push(("widths.npy", npy::floats(&[points], widths.iter().copied())))
        }
        _ if Part::Widths.is_in(groom) => {
            files.push(("strand_widths.npy", npy::floats(&[strands], groom.root_widths())))
        }
        // A default width, taken because a file had none, is no attribute.
        _ => {}
    }
    let mut add = |name, array: Option<Vec<u8>>| files.extend(array.map(|array| (name, array)));
    let triples = |rows, all: &mut dyn Iterator<Item = [f32; 3]>| npy::floats(&[rows, 3], all.flatten());
    add("colors.npy", groom.colors.as_ref().map(|all| triples(points, &mut all.iter().copied())));
    let one = |all: &Vec<f32>| npy::floats(&[points], all.iter().copied());
    add("transparencies.npy", groom.transparencies.as_ref().map(one));
    let pairs = |all: &Vec<Vec2>| npy::floats(&[strands, 2], all.iter().flat_map(|uv| uv.to_array()));
    add("root_uv.npy", groom.root_uvs.as_ref().map(pairs));
    let vectors = |rows, all: &Vec<Vec3>| triples(rows, &mut all.iter().map(|vector| vector.to_array()));
    add("root_normals.npy", groom.root_normals.as_ref().map(|all| vectors(strands, all)));
    add("groups.npy", groom.groups.as_ref().map(|all| whole(&[strands], all)));
    let flags = |all: &Vec<bool>| npy::array("|u1", &[strands], all.iter().map(|flag| u8::from(*flag)));
    add("guide_flags.npy", groom.guide_flags.as_ref().map(flags));
    if let Some(influences) = &groom.influences {
        let shape = [strands, influences.per_strand()];
        add("guide_indices.npy", Some(whole(&shape, influences.guides())));
        add("guide_weights.npy", Some(npy::floats(&shape, influences.weights().iter().copied())));
    }
    add("masses.npy", groom.masses.as_ref().map(one));
    add("velocities.npy", groom.velocities.as_ref().map(|all| vectors(points, all)));
    let meta = Meta {
        version: 1,
        units: "m".to_owned(),
        up: "y".to_owned(),
        what: "groom".to_owned(),
        groups: groom.group_names.clone(),
    };
    let meta = serde_json::to_vec(&meta).expect("plain text");
    add("meta.npy", Some(npy::array("|u1", &[meta.len()], meta.iter().copied())));
    zip::pack(&files).ok_or_else(|| GroomError::CannotHold {
        format: ".npz",
        found: format!("{strands} strands of {points} points"),
        expected: "4 GiB at most",
        mend: "resample it, or thin it",
    })
}
