//! Grooms and meshes as dictionaries of arrays.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use strandline::{
    Error, Groom, Mesh,
    format::{self, Cleaning, LoadOptions, Scale},
    low_level::{
        body::{Mannequin, VertexMotion},
        groom::{Influences, Widths},
    },
};

use crate::{arrays, errors, scenes};

/// A groom as a dictionary of arrays; attributes that it lacks are not in it.
pub fn dictionary<'py>(py: Python<'py>, groom: Groom) -> PyResult<Bound<'py, PyDict>> {
    let of = PyDict::new(py);
    of.set_item("points", arrays::rows::<f32, _>(py, &groom.points, 3)?)?;
    match groom.widths {
        Widths::Constant(width) => of.set_item("widths", width)?,
        Widths::PerStrand(widths) | Widths::PerPoint(widths) => {
            of.set_item("widths", arrays::list(py, widths))?;
        }
    }
    if let Some(uvs) = groom.root_uvs {
        of.set_item("root_uvs", arrays::rows::<f32, _>(py, &uvs, 2)?)?;
    }
    if let Some(normals) = groom.root_normals {
        of.set_item("root_normals", arrays::rows::<f32, _>(py, &normals, 3)?)?;
    }
    if let Some(groups) = groom.groups {
        of.set_item("groups", arrays::list(py, groups))?;
        of.set_item("group_names", groom.group_names)?;
    }
    if let Some(flags) = groom.guide_flags {
        of.set_item("guide_flags", arrays::list(py, flags))?;
    }
    if let Some(influences) = groom.influences {
        let each = influences.per_strand();
        of.set_item("guide_indices", arrays::rows::<u32, _>(py, influences.guides(), each)?)?;
        of.set_item("guide_weights", arrays::rows::<f32, _>(py, influences.weights(), each)?)?;
    }
    if let Some(colors) = groom.colors {
        of.set_item("colors", arrays::rows::<f32, _>(py, &colors, 3)?)?;
    }
    if let Some(transparencies) = groom.transparencies {
        of.set_item("transparencies", arrays::list(py, transparencies))?;
    }
    if let Some(masses) = groom.masses {
        of.set_item("masses", arrays::list(py, masses))?;
    }
    if let Some(velocities) = groom.velocities {
        of.set_item("velocities", arrays::rows::<f32, _>(py, &velocities, 3)?)?;
    }
    of.set_item("starts", arrays::list(py, groom.starts))?;
    Ok(of)
}

/// Numbers of one attribute of a dictionary.
fn attribute<T: numpy::Element + Copy>(
    of: &Bound<'_, PyDict>,
    name: &str,
    shape: &[Option<usize>],
) -> PyResult<Option<Vec<T>>> {
    let Some(array) = of.get_item(name)? else { return Ok(None) };
    let array = array.extract::<PyReadonlyArrayDyn<'_, T>>()?;
    arrays::numbers(&array, name, shape).map(Some)
}

/// Rows of numbers of one attribute.
fn rows<const N: usize>(of: &Bound<'_, PyDict>, name: &str) -> PyResult<Option<Vec<[f32; N]>>> {
    let numbers = attribute::<f32>(of, name, &[None, Some(N)])?;
    Ok(numbers.map(|numbers| numbers.as_chunks::<N>().0.to_vec()))
}

/// A groom of a dictionary as [`dictionary`] makes it; arrays that do not belong together are refused.
pub fn groom(of: &Bound<'_, PyDict>) -> PyResult<Groom> {
    let py = of.py();
    let missing = |name: &'static str| PyKeyError::new_err(name);
    let points = rows::<3>(of, "points")?.ok_or_else(|| missing("points"))?;
    let starts = attribute::<u32>(of, "starts", &[None])?.ok_or_else(|| missing("starts"))?;
    let strands = starts.len().saturating_sub(1);
    let width = of.get_item("widths")?.ok_or_else(|| missing("widths"))?;
    let widths = match width.extract::<f32>() {
        Ok(width) if width.is_finite() && width >= 0.0 => Widths::Constant(width),
        Ok(width) => {
            return Err(errors::value(py, &format!("groom.widths is {width}, expected 0 or more [m]")));
        }
        Err(_) => {
            let widths = attribute::<f32>(of, "widths", &[None])?.unwrap_or_default();
            if widths.len() == strands { Widths::PerStrand(widths) } else { Widths::PerPoint(widths) }
        }
    };
    let influences = match attribute::<u32>(of, "guide_indices", &[None, None])? {
        None => None,
        Some(guides) => {
            let weights = attribute::<f32>(of, "guide_weights", &[None, None])?.unwrap_or_default();
            let each = guides.len() / strands.max(1);
            let influences = Influences::new(each, guides, weights, strands);
            Some(influences.map_err(|error| errors::refused(py, &error.into()))?)
        }
    };
    let vectors = |rows: Option<Vec<[f32; 3]>>| rows.map(|rows| rows.into_iter().map(Vec3::from).collect());
    let uvs = rows::<2>(of, "root_uvs")?;
    let names = match of.get_item("group_names")? {
        Some(names) => names.extract::<BTreeMap<u32, String>>()?,
        None => BTreeMap::new(),
    };
    let groom = Groom {
        starts,
        points: points.into_iter().map(Vec3::from).collect(),
        widths,
        root_uvs: uvs.map(|rows| rows.into_iter().map(Vec2::from).collect()),
        root_normals: vectors(rows::<3>(of, "root_normals")?),
        groups: attribute::<u32>(of, "groups", &[None])?,
        group_names: names,
        guide_flags: attribute::<bool>(of, "guide_flags", &[None])?,
        influences,
        colors: rows::<3>(of, "colors")?,
        transparencies: attribute::<f32>(of, "transparencies", &[None])?,
        masses: attribute::<f32>(of, "masses", &[None])?,
        velocities: vectors(rows::<3>(of, "velocities")?),
        numbers: None,
        files: std::collections::BTreeMap::new(),
    };
    groom.check_lengths().map_err(|error| errors::refused(py, &error.into()))?;
    Ok(groom)
}

/// Reads a groom: its dictionary, and a note for each problem that was mended.
#[pyfunction]
#[pyo3(signature = (path, *, scale, up, turn, points_per_strand, frame, root_end, strict, clean))]
#[allow(clippy::too_many_arguments)] // the options of reading, by name
pub fn load<'py>(
    py: Python<'py>,
    path: PathBuf,
    scale: Option<f32>,
    up: &str,
    turn: [f32; 3],
    points_per_strand: Option<u32>,
    frame: Option<u32>,
    root_end: &str,
    strict: bool,
    clean: bool,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let word = |error: strandline::settings::SettingError| errors::refused(py, &error.into());
    let options = LoadOptions {
        strict,
        scale: scale.map_or(Scale::Auto, Scale::Factor),
        up: up.parse().map_err(word)?,
        turn: Vec3::from_array(turn),
        per_strand: points_per_strand,
        frame,
        root_end: root_end.parse().map_err(word)?,
        cleaning: if clean { Cleaning::All } else { Cleaning::Named },
    };
    let loaded = errors::run(py, || Ok(format::load(&path, &options)?))?;
    Ok((dictionary(py, loaded.groom)?, loaded.report.problems))
}

/// Grows the style of a scene in TOML: guides alone, or `groom.bound` strands in all.
#[pyfunction]
pub fn grow<'py>(py: Python<'py>, scene: &str) -> PyResult<Bound<'py, PyDict>> {
    let scene = scenes::parsed(py, scene, Path::new(""))?;
    let strands = scene.groom.bound.map_or(0, |bound| bound as usize);
    let groom = errors::run(py, || scene.grow(strands))?;
    dictionary(py, groom)
}

/// Writes a groom; returns the attributes that the format could not hold, and what was changed to make it fit.
#[pyfunction]
pub fn save(
    py: Python<'_>,
    of: &Bound<'_, PyDict>,
    path: PathBuf,
) -> PyResult<(Vec<&'static str>, Vec<String>)> {
    let groom = groom(of)?;
    let saved = errors::run(py, || Ok(groom.save(&path)?))?;
    Ok((saved.left_out, saved.notes))
}

/// The groom with so many points on each strand, evenly along it.
#[pyfunction]
pub fn resample<'py>(
    py: Python<'py>,
    of: &Bound<'py, PyDict>,
    points: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let groom = groom(of)?;
    dictionary(py, errors::run(py, || Ok(groom.resampled(points)?))?)
}

/// Vertices, triangles and notes of a mesh.
type MeshParts<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Vec<String>);

/// Reads a mesh in its own axes: vertices times `scale`, triangles, and notes on all that is odd.
#[pyfunction]
pub fn load_mesh<'py>(py: Python<'py>, path: PathBuf, scale: f32) -> PyResult<MeshParts<'py>> {
    let (mesh, notes) = errors::run(py, || Ok(Mesh::load_noted(&path, scale)?))?;
    parts(py, &mesh, notes)
}

/// The built-in bust, head space \[m\].
#[pyfunction]
pub fn mannequin(py: Python<'_>) -> PyResult<MeshParts<'_>> {
    let mesh = errors::run(py, || Ok(Mannequin::new().mesh()))?;
    parts(py, &mesh, Vec::new())
}

fn parts<'py>(py: Python<'py>, mesh: &Mesh, notes: Vec<String>) -> PyResult<MeshParts<'py>> {
    let vertices = arrays::rows::<f32, _>(py, &mesh.positions, 3)?;
    Ok((vertices, arrays::rows::<u32, _>(py, &mesh.triangles, 3)?, notes))
}

/// A mesh of vertices and triangles.
pub fn mesh(
    vertices: &PyReadonlyArrayDyn<'_, f32>,
    triangles: &PyReadonlyArrayDyn<'_, u32>,
) -> PyResult<Mesh> {
    let positions = arrays::points(vertices, "vertices")?;
    let corners = arrays::numbers(triangles, "faces", &[None, Some(3)])?;
    let mesh = Mesh::new(positions, corners.as_chunks::<3>().0.to_vec());
    mesh.map_err(|error| errors::refused(vertices.py(), &Error::from(error)))
}

/// The motion of a mesh of its vertices over time, shape (frame, vertex, 3), with times of marks \[s\].
pub fn motion(
    frames: &PyReadonlyArrayDyn<'_, f32>,
    frames_per_second: f64,
    teleports: &[f64],
) -> PyResult<VertexMotion> {
    let numbers = arrays::numbers(frames, "motion", &[None, None, Some(3)])?;
    let (count, vertices) = (frames.shape()[0], frames.shape()[1]);
    let points: Vec<Vec3> = numbers.as_chunks::<3>().0.iter().map(|point| Vec3::from_array(*point)).collect();
    let frames_of = points.chunks(vertices.max(1)).map(<[Vec3]>::to_vec).collect();
    let times = (0..count).map(|frame| frame as f64 / frames_per_second).collect();
    let motion = VertexMotion::sampled(times, frames_of).and_then(|motion| motion.with_teleports(teleports));
    motion.map_err(|error| errors::refused(frames.py(), &Error::from(error)))
}
