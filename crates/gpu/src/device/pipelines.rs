//! Compiled kernels and drawings, kept for later requests of the same.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::GpuError;

/// A compiled kernel or drawing.
#[derive(Clone, Debug)]
pub(crate) struct Compiled<P> {
    pub pipeline: P,
    pub layout: wgpu::BindGroupLayout,
}

/// Compiled kernels or drawings, kept for later requests of the same.
#[derive(Debug)]
pub(crate) struct Pipelines<P>(Mutex<HashMap<String, Compiled<P>>>);

impl<P> Default for Pipelines<P> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<P: Clone> Pipelines<P> {
    /// Number of those that are kept.
    pub fn count(&self) -> usize {
        self.known().len()
    }

    /// Pipeline of a key, compiled at its first use.
    pub fn get(
        &self,
        key: String,
        compile: impl FnOnce() -> Result<Compiled<P>, GpuError>,
    ) -> Result<Compiled<P>, GpuError> {
        if let Some(known) = self.known().get(&key) {
            return Ok(known.clone());
        }
        let compiled = compile()?;
        self.known().insert(key, compiled.clone());
        Ok(compiled)
    }

    fn known(&self) -> MutexGuard<'_, HashMap<String, Compiled<P>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
