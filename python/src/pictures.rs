//! Pictures and cameras.

use std::path::{Path, PathBuf};

use glam::Vec3;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use strandline::{Camera, Error, Picture, low_level::render::Layers, scene::View};

use crate::{arrays, errors, scenes};

/// Position, target, upward direction, field of view \[degrees\] and near plane \[m\].
pub type CameraParts = ([f32; 3], [f32; 3], [f32; 3], f32, f32);

/// The camera of its parts.
pub fn camera((position, target, up, field_of_view, near): CameraParts) -> Camera {
    let [position, target, up] = [position, target, up].map(Vec3::from_array);
    Camera { position, target, up, field_of_view, near }
}

/// The parts of a camera.
pub fn parts(camera: &Camera) -> CameraParts {
    let Camera { position, target, up, field_of_view, near } = *camera;
    (position.to_array(), target.to_array(), up.to_array(), field_of_view, near)
}

/// An array of a picture, shape (row, column, 3), or 4 with opacity.
pub fn array<'py>(py: Python<'py>, picture: Picture) -> PyResult<Bound<'py, PyAny>> {
    let size = [picture.height as usize, picture.width as usize];
    let (pixels, channels) = match picture.alpha {
        None => (picture.pixels, 3),
        Some(_) => (picture.interleaved(), 4),
    };
    Ok(PyArray1::from_vec(py, pixels).reshape([size[0], size[1], channels])?.into_any())
}

/// Channels of a picture by name, shape (row, column).
pub fn channels<'py>(py: Python<'py>, layers: &Layers) -> PyResult<Bound<'py, PyDict>> {
    let shape = [layers.height as usize, layers.width as usize];
    let of = PyDict::new(py);
    for (name, values) in &layers.channels {
        of.set_item(name, PyArray1::from_slice(py, values).reshape(shape)?)?;
    }
    Ok(of)
}

/// A picture of an array.
fn picture(pixels: &PyReadonlyArrayDyn<'_, u8>) -> PyResult<Picture> {
    let shape = pixels.shape().to_vec();
    let channels = shape.get(2).copied().filter(|channels| [3, 4].contains(channels)).unwrap_or(3);
    let numbers = arrays::numbers(pixels, "pixels", &[None, None, Some(channels)])?;
    let [height, width] = [shape[0], shape[1]].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    if channels == 3 {
        return Ok(Picture { width, height, pixels: numbers, alpha: None });
    }
    let texels = numbers.as_chunks::<4>().0;
    let alpha = Some(texels.iter().map(|texel| texel[3]).collect());
    Ok(Picture {
        width,
        height,
        pixels: texels.iter().flat_map(|texel| texel[..3].to_vec()).collect(),
        alpha,
    })
}

/// The bytes of a .png.
#[pyfunction]
pub fn png<'py>(py: Python<'py>, pixels: PyReadonlyArrayDyn<'py, u8>) -> PyResult<Bound<'py, PyBytes>> {
    let picture = picture(&pixels)?;
    let encoded = errors::run(py, || {
        let mut bytes = Vec::new();
        let written = picture.encode(&mut bytes);
        let path = PathBuf::from("memory");
        written.map_err(|source| Error::Write { what: "the picture", path, source }).map(|()| bytes)
    })?;
    Ok(PyBytes::new(py, &encoded))
}

/// Writes a .png, which is whole or not there.
#[pyfunction]
pub fn save_png(py: Python<'_>, pixels: PyReadonlyArrayDyn<'_, u8>, path: PathBuf) -> PyResult<()> {
    let picture = picture(&pixels)?;
    errors::run(py, || Ok(picture.save(&path)?))
}

/// The 4 x 4 matrices `view_from_world` and `clip_from_view` of a camera.
#[pyfunction]
pub fn camera_matrices(py: Python<'_>, of: CameraParts, aspect: f32) -> PyResult<[[[f32; 4]; 4]; 2]> {
    let camera = camera(of);
    camera.validate().map_err(|error| errors::refused(py, &error.into()))?;
    let view = glam::Mat4::from(camera.view_from_world());
    Ok([view, camera.clip_from_view(aspect)].map(|matrix| matrix.transpose().to_cols_array_2d()))
}

/// The camera of a view by name that sees all of some points \[m\].
#[pyfunction]
pub fn view(
    py: Python<'_>,
    name: &str,
    points: PyReadonlyArrayDyn<'_, f32>,
    aspect: f32,
) -> PyResult<CameraParts> {
    let word = |error: strandline::settings::SettingError| errors::refused(py, &error.into());
    let view: View = name.parse().map_err(word)?;
    let points = arrays::points(&points, "points")?;
    let scene = scenes::parsed(py, "", Path::new(""))?;
    let start = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    let (min, max) = points.iter().fold(start, |(min, max), point| (min.min(*point), max.max(*point)));
    let bounds = strandline::mesh::Aabb { min, max };
    let section = strandline::scene::CameraSection { view, ..scene.camera };
    Ok(parts(&section.camera(bounds, &points, aspect)))
}
