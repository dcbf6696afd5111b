//! Vertices over time from files: arrays of numpy, and meshes of one topology, one behind the other.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use strandline_base::memory::{self, Need};
use strandline_base::npz::{Bare, Kind, Npz};
use strandline_base::par::prelude::*;
use strandline_base::read_plain;

use crate::parsing::{Refusal, read_file};
use crate::teleports::Teleports;
use crate::vertex_frames::VertexFrames;
use crate::{BodyError, Mesh, MeshFormat, VertexMotion, obj};

/// Names of the arrays of vertices, faces and rates; the first that is present counts.
const VERTICES: [&str; 4] = ["vertices", "verts", "positions", "v"];
const FACES: [&str; 3] = ["faces", "f", "triangles"];
const RATES: [&str; 4] = ["fps", "frames_per_second", "mocap_framerate", "mocap_frame_rate"];
/// Largest .npy that is read \[byte\], and memory that its reader takes for each of them \[byte\].
const FILE_LIMIT: u64 = 16 << 30;
const TAKEN: u64 = 4;
/// Memory that a number of an array takes beside its own bytes: one of double precision, and the place or index made of it \[byte\].
const NUMBER: u64 = 12;
/// Most meshes of a sequence.
const MOST_FILES: usize = 100_000;

/// An array of numbers.
struct Numbers {
    kind: Kind,
    shape: Vec<u64>,
    bytes: Vec<u8>,
}

/// Arrays of a file.
#[derive(Default)]
struct MotionArrays {
    vertices: Option<Numbers>,
    faces: Option<Numbers>,
    times: Option<Numbers>,
    rate: Option<Numbers>,
    /// Times of marks \[s\].
    teleports: Vec<f64>,
    has_poses: bool,
}

impl VertexMotion {
    /// Loads the vertices of a mesh over time from a .npy or .npz file, in the units and axes of the mesh: an array
    /// `[frame, vertex, 3]` or `[frame, 3 * vertex]`, in an archive by the name vertices, verts, positions or v, with
    /// `times` \[s\] or a rate `fps` \[Hz\] where it is not `rate`, and `teleports`, times \[s\] of marks. The vertices are in the order of the mesh's file.
    ///
    /// # Errors
    /// See [`BodyError`]: no such array, another number of vertices than the mesh has, more memory than may be taken.
    pub fn load(path: &Path, mesh: &Mesh, mesh_file: Option<&Path>, rate: f64) -> Result<Self, BodyError> {
        let order = match mesh_file.filter(|file| is_obj(file)) {
            Some(file) => Some(obj::order(&read_file(file)?).map_err(|refusal| refused(file, refusal))?),
            None => None,
        };
        let count = mesh.positions.len();
        let wanted = order.as_ref().map_or(count, |(_, written)| *written);
        let found = arrays(path)?;
        let frames = found.frames().and_then(|frames| {
            let given = frames.first().map_or(0, Vec::len);
            if given != wanted {
                return Err((
                    format!("{given} vertices in a frame, for a mesh of {wanted}"),
                    "those of the mesh",
                ));
            }
            Ok(frames)
        });
        let frames = frames.map_err(|refusal| refused(path, refusal))?;
        let frames = match order {
            Some((order, _)) => frames.iter().map(|frame| in_order(frame, &order)).collect(),
            None => frames,
        };
        let times = found.times(frames.len(), rate).map_err(|refusal| refused(path, refusal))?;
        Self::sampled(times, frames)?.with_rest(&mesh.positions).with_teleports(&found.teleports)
    }
}

fn is_obj(file: &Path) -> bool {
    matches!(MeshFormat::of(file), Ok(MeshFormat::Obj))
}

/// The places of a frame in the order of a mesh.
fn in_order(frame: &[Vec3], order: &[u32]) -> Vec<Vec3> {
    order.iter().map(|index| frame[*index as usize]).collect()
}

impl Mesh {
    /// True for a path that names a mesh in motion: an .npz, a folder, or a number in the name, such as `walk%04d.obj`.
    pub fn is_sequence(path: &Path) -> bool {
        let is_npz = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npz"));
        is_npz || pattern(path).is_some() || path.is_dir()
    }

    /// The .obj files of a mesh in motion, in their order, of a folder or a pattern; none of another path, or where there are none.
    pub fn sequence_files(path: &Path) -> Vec<PathBuf> {
        if pattern(path).is_none() && !path.is_dir() {
            return Vec::new();
        }
        sequence(path).unwrap_or_default().into_iter().map(|(_, file)| file).collect()
    }

    /// Loads a mesh in motion: an .npz with vertices and `faces`, or .obj files with the same faces. The mesh at rest is
    /// the first frame. Files are `rate` \[Hz\] apart, those of a pattern by their numbers.
    ///
    /// # Errors
    /// See [`BodyError`]: files with other faces, more memory than may be taken.
    pub fn load_sequence(path: &Path, rate: f64) -> Result<(Self, VertexMotion), BodyError> {
        Self::load_sequence_noted(path, rate).map(|(mesh, motion, _)| (mesh, motion))
    }

    /// As [`Mesh::load_sequence`], with notes on what is odd in the first file but could be read, human-readable. Looks are those
    /// of the first file: the others give vertices alone.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load_sequence_noted(
        path: &Path,
        rate: f64,
    ) -> Result<(Self, VertexMotion, Vec<String>), BodyError> {
        if pattern(path).is_none() && !path.is_dir() {
            return of_arrays(path, rate).map(|(mesh, motion)| (mesh, motion, Vec::new()));
        }
        let files = sequence(path)?;
        let Some((_, first)) = files.first() else {
            return Err(out_of_sequence(path, ("no such .obj file".into(), "files of a mesh in motion")));
        };
        let (mesh, notes) = Self::load_noted(first, 1.0)?;
        let (count, each) = (files.len() as u64, 12 * mesh.positions.len() as u64);
        memory::check(&[Need::new("the frames of the body", count, each)])?;
        let read = |(_, file): &(u64, PathBuf)| {
            let frame = Self::load_shape(file)?;
            if frame.triangles != mesh.triangles || frame.positions.len() != mesh.positions.len() {
                return Err(out_of_sequence(
                    file,
                    ("other faces than the first file".into(), "meshes of one topology"),
                ));
            }
            Ok(frame.positions)
        };
        let further: Vec<Vec<Vec3>> = files[1..].par_iter().map(read).collect::<Result<_, _>>()?;
        let frames = std::iter::once(mesh.positions.clone()).chain(further).collect();
        let start = files[0].0;
        let times = files.iter().map(|(number, _)| (number - start) as f64 / rate).collect();
        Ok((mesh, VertexMotion::sampled(times, frames)?, notes))
    }
}

/// A mesh and its motion from one archive.
fn of_arrays(path: &Path, rate: f64) -> Result<(Mesh, VertexMotion), BodyError> {
    let found = arrays(path)?;
    let refuse = |refusal| refused(path, refusal);
    let triangles = found.triangles().map_err(refuse)?;
    let frames = found.frames().map_err(refuse)?;
    let times = found.times(frames.len(), rate).map_err(refuse)?;
    let frames = VertexFrames::new(times, frames)?;
    let mesh = Mesh::new(frames.positions(f64::NEG_INFINITY, &Teleports::default()), triangles)?;
    Ok((mesh, VertexMotion::of_frames(frames).with_teleports(&found.teleports)?))
}

fn refused(path: &Path, (found, expected): Refusal) -> BodyError {
    BodyError::Mesh { path: path.into(), found, expected, mend: "write it again, as `numpy.savez` does" }
}

fn out_of_sequence(path: &Path, (found, expected): Refusal) -> BodyError {
    let mend = "export the frames of one mesh, with their numbers as walk0001.obj and so on";
    BodyError::Mesh { path: path.into(), found, expected, mend }
}

/// The words before and behind the number in the name of files; none for a file that is there.
fn pattern(path: &Path) -> Option<(String, String)> {
    let name = path.file_name().filter(|_| !path.exists())?.to_str()?;
    let (before, rest) = name.split_once('%')?;
    let (width, after) = rest.split_once('d')?;
    let is_width = width.bytes().all(|letter| letter.is_ascii_digit());
    is_width.then(|| (before.to_owned(), after.to_owned()))
}

/// The .obj files of a pattern or a folder, with their numbers, in order.
fn sequence(path: &Path) -> Result<Vec<(u64, PathBuf)>, BodyError> {
    let pattern = pattern(path);
    let folder = match &pattern {
        Some(_) => path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")),
        None => path,
    };
    let unread = |source| BodyError::Read { path: folder.into(), source };
    let mut files = Vec::new();
    for entry in folder.read_dir().map_err(unread)? {
        let file = entry.map_err(unread)?.path();
        let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let number = match &pattern {
            Some((before, after)) => {
                let digits =
                    name.strip_prefix(before.as_str()).and_then(|rest| rest.strip_suffix(after.as_str()));
                let digits = digits.filter(|digits| digits.bytes().all(|letter| letter.is_ascii_digit()));
                digits.and_then(|digits| digits.parse().ok())
            }
            None => is_obj(&file).then(|| trailing_number(&file)),
        };
        files.extend(number.map(|number: u64| (number, file)));
        if files.len() > MOST_FILES {
            return Err(out_of_sequence(path, (format!("more than {MOST_FILES} files"), "a shorter motion")));
        }
    }
    files.sort();
    if pattern.is_none() {
        files.iter_mut().zip(0..).for_each(|(file, number)| file.0 = number);
    }
    files.dedup_by_key(|file| file.0);
    Ok(files)
}

/// The digits at the end of a name as a number: 10 comes behind 2 without leading zeros too. 0 without digits.
fn trailing_number(file: &Path) -> u64 {
    let name = file.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
    let digits = name.len() - name.bytes().rev().take_while(u8::is_ascii_digit).count();
    name[digits..].parse().unwrap_or(0)
}

/// The arrays of a file that tell of a motion.
fn arrays(path: &Path) -> Result<MotionArrays, BodyError> {
    let unread = |source| BodyError::Read { path: path.into(), source };
    let malformed = |error: &dyn std::fmt::Display| {
        refused(path, (format!("a file that cannot be read ({error})"), "arrays as numpy writes them"))
    };
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npy")) {
        memory::check_file("the motion of the body", path, FILE_LIMIT, TAKEN)?;
        let bytes = read_plain(path, FILE_LIMIT).map_err(unread)?;
        let Bare { kind, shape, bytes } = Bare::new(&bytes).map_err(|error| malformed(&error))?;
        let vertices = Some(Numbers { kind, shape, bytes: bytes.into_owned() });
        return Ok(MotionArrays { vertices, ..MotionArrays::default() });
    }
    let file = File::open(path).map_err(unread)?;
    let mut npz = Npz::new(BufReader::new(file)).map_err(|error| malformed(&error))?;
    memory::check(&[Need::new("the motion of the body", npz.unpacked_bytes(), TAKEN)])?;
    let mut array = |names: &[&str]| {
        for name in names {
            if let Some(mut rows) = npz.open(name).map_err(|error| malformed(&error))? {
                let (count, each) = (rows.bytes() / rows.kind().bytes(), rows.kind().bytes());
                memory::check(&[Need::new(format!("the array `{name}` of the body"), count, each + NUMBER)])?;
                let bytes = npz.all(&mut rows).map_err(|error| malformed(&error))?;
                return Ok(Some(Numbers { kind: rows.kind(), shape: rows.shape().to_vec(), bytes }));
            }
        }
        Ok::<_, BodyError>(None)
    };
    let (vertices, faces) = (array(&VERTICES)?, array(&FACES)?);
    let (times, rate) = (array(&["times"])?, array(&RATES)?);
    let teleports = array(&["teleports"])?.map(|marks| marks.kind.numbers(&marks.bytes).collect());
    let teleports = teleports.unwrap_or_default();
    let has_poses = npz.names().any(|name| name == "poses");
    Ok(MotionArrays { vertices, faces, times, rate, teleports, has_poses })
}

impl MotionArrays {
    /// The vertices of all frames.
    fn frames(&self) -> Result<Vec<Vec<Vec3>>, Refusal> {
        const EXPECTED: &str =
            "an array [frame, vertex, 3] of float32 or float64, named vertices, verts, positions or v";
        let Some(Numbers { kind, shape, bytes }) = &self.vertices else {
            let found = if self.has_poses { "poses of a body model and no vertices" } else { "no vertices" };
            return Err((found.into(), EXPECTED));
        };
        let each = match shape[..] {
            [_, vertices, 3] => vertices,
            [_, columns] if columns % 3 == 0 => columns / 3,
            _ => 0,
        };
        let frame_bytes = each.checked_mul(3 * kind.bytes()).and_then(|bytes| usize::try_from(bytes).ok());
        let frame_bytes = frame_bytes.filter(|bytes| *bytes > 0 && matches!(kind, Kind::F32 | Kind::F64));
        let Some(frame_bytes) = frame_bytes else {
            return Err((format!("vertices of shape {shape:?}"), EXPECTED));
        };
        let frame = |bytes: &[u8]| {
            let numbers: Vec<f64> = kind.numbers(bytes).collect();
            let places = numbers.as_chunks::<3>().0.iter();
            places.map(|place| DVec3::from_array(*place).as_vec3()).collect::<Vec<_>>()
        };
        Ok(bytes.chunks_exact(frame_bytes).map(frame).collect())
    }

    /// Times \[s\] of so many frames.
    fn times(&self, frames: usize, rate: f64) -> Result<Vec<f64>, Refusal> {
        if let Some(Numbers { kind, shape, bytes }) = &self.times {
            let times: Vec<f64> = kind.numbers(bytes).collect();
            if shape.len() != 1 || times.len() != frames {
                return Err((
                    format!("times of shape {shape:?} for {frames} frames"),
                    "a time for each frame",
                ));
            }
            return Ok(times);
        }
        let given = self.rate.as_ref().map(|rate| rate.kind.numbers(&rate.bytes).next().unwrap_or(0.0));
        let rate = given.unwrap_or(rate);
        if !(rate.is_finite() && rate > 0.0) {
            return Err((format!("a rate of {rate} frames per second"), "a rate above zero"));
        }
        Ok((0..frames).map(|frame| frame as f64 / rate).collect())
    }

    /// The triangles.
    fn triangles(&self) -> Result<Vec<[u32; 3]>, Refusal> {
        const EXPECTED: &str = "an array [triangle, 3] of whole numbers, named faces, f or triangles";
        let Some(Numbers { kind, shape, bytes }) = &self.faces else {
            let mend = "faces, or the mesh as body.file and this file as body.vertices";
            return Err(("no faces".into(), mend));
        };
        let corners: Vec<f64> = kind.numbers(bytes).collect();
        let is_whole =
            |corner: &f64| *corner >= 0.0 && *corner <= f64::from(u32::MAX) && corner.fract() == 0.0;
        if !matches!(shape[..], [_, 3]) || !corners.iter().all(is_whole) {
            return Err((format!("faces of shape {shape:?}"), EXPECTED));
        }
        Ok(corners.as_chunks::<3>().0.iter().map(|corners| corners.map(|corner| corner as u32)).collect())
    }
}
