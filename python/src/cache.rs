//! Files of moving hair, to be read.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;
use strandline::Cache as Moving;

use crate::{arrays, errors};

/// Points \[m\] and the matrix `world_from_head` of a frame.
type FrameParts<'py> = (Bound<'py, PyAny>, [[f32; 4]; 4]);

/// A moving cache.
#[pyclass(module = "strandline._native", frozen)]
pub struct Cache {
    cache: Mutex<Moving>,
}

#[pymethods]
impl Cache {
    /// Opens a moving cache.
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Ok(Self { cache: Mutex::new(errors::run(py, || Moving::open(&path))?) })
    }

    /// Times of the frames \[s\], first points of the strands, which strands, and the scene as TOML; none where
    /// the file names none.
    #[allow(clippy::type_complexity)] // a tuple that Python takes apart
    fn about<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyAny>, Bound<'py, PyAny>, &'static str, Option<String>) {
        let cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let (times, starts) = (cache.times().to_vec(), cache.starts().to_vec());
        let scene = cache.scene().ok().map(|scene| scene.to_toml());
        (arrays::list(py, times), arrays::list(py, starts), cache.what().name(), scene)
    }

    /// Points \[m\], world space, and the head of a frame.
    fn read<'py>(&self, py: Python<'py>, frame: usize) -> PyResult<FrameParts<'py>> {
        let (points, body) = errors::run(py, || {
            let mut points = Vec::new();
            let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
            let body = cache.read(frame, &mut points)?;
            Ok((points, body))
        })?;
        let array = arrays::rows::<f32, _>(py, &points, 3)?;
        Ok((array, arrays::matrix(&body.world_from_head())))
    }
}
