//! Scenes as TOML.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use strandline::{Error, HeadMotion, Scene, settings::Kind};

use crate::{arrays, errors};

/// A scene of TOML whose relative paths start from `folder`.
pub fn parsed(py: Python<'_>, text: &str, folder: &Path) -> PyResult<Scene> {
    let mut scene = Scene::parse(text, "scene").map_err(|error| errors::refused(py, &error))?;
    scene.folder = folder.to_owned();
    Ok(scene)
}

/// The scene with every key spelled out.
#[pyfunction]
pub fn whole(py: Python<'_>, text: &str) -> PyResult<String> {
    Ok(parsed(py, text, Path::new(""))?.to_toml())
}

/// A built-in scene, or the scene of a file, as TOML.
#[pyfunction]
pub fn builtin(py: Python<'_>, name: &str) -> PyResult<String> {
    let scene: Scene = name.parse().map_err(|error: Error| errors::refused(py, &error))?;
    Ok(scene.to_toml())
}

/// Refuses a key that no setting has, with the nearest one; with a value also what the setting does not take. Returns
/// true for a section.
#[pyfunction]
#[pyo3(signature = (key, value = None))]
pub fn check(py: Python<'_>, key: &str, value: Option<&str>) -> PyResult<bool> {
    let row = Scene::row(key).map_err(|error| errors::refused(py, &error))?;
    if let Some(value) = value {
        Scene::default().set(key, value).map_err(|error| errors::refused(py, &error))?;
    }
    Ok(matches!(row.kind, Kind::Group(_)) && !key.ends_with(']'))
}

/// The value of a setting of a scene as TOML; empty where it has none.
#[pyfunction]
pub fn get(py: Python<'_>, text: &str, key: &str) -> PyResult<String> {
    parsed(py, text, Path::new(""))?.get(key).map_err(|error| errors::refused(py, &error))
}

/// The sentence, the range and the value of a setting, or a line for each setting of a section.
#[pyfunction]
pub fn explain(py: Python<'_>, text: &str, key: &str) -> PyResult<String> {
    parsed(py, text, Path::new(""))?.explain(key).map_err(|error| errors::refused(py, &error))
}

/// 4 x 4 matrices `world_from_head` of a scene's motion at times \[s\]. Without a pivot in the scene the head turns about
/// `pivot` \[m\].
#[pyfunction]
pub fn head(py: Python<'_>, text: &str, times: Vec<f64>, pivot: [f32; 3]) -> PyResult<Vec<[[f32; 4]; 4]>> {
    let scene = parsed(py, text, &PathBuf::new())?;
    let pivot = scene.motion.pivot.unwrap_or(pivot.into());
    let motion = HeadMotion::new(&scene.motion, pivot).map_err(|error| errors::refused(py, &error))?;
    Ok(times.into_iter().map(|time| arrays::matrix(&motion.pose(time))).collect())
}
