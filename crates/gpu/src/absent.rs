//! Replacement of a device in a build without GPUs: none can be made.

use std::marker::PhantomData;

use crate::{Adapter, Crossed, GpuError};

/// A device and its queue; it does not exist in this build.
#[derive(Clone, Debug)]
pub enum Gpu {}

impl Gpu {
    /// Absent in this build.
    ///
    /// # Errors
    /// Always: there are no GPUs in this build. So do the next two.
    pub fn auto() -> Result<Self, GpuError> {
        Err(GpuError::NotBuilt)
    }

    /// Absent in this build.
    ///
    /// # Errors
    /// Always.
    pub fn any() -> Result<Self, GpuError> {
        Err(GpuError::NotBuilt)
    }

    /// Absent in this build.
    ///
    /// # Errors
    /// Always.
    pub fn open(_: usize) -> Result<Self, GpuError> {
        Err(GpuError::NotBuilt)
    }

    /// No adapter.
    pub fn list() -> Vec<Adapter> {
        Vec::new()
    }

    /// The adapter.
    pub fn adapter(&self) -> &Adapter {
        match *self {}
    }

    /// True if both are one device.
    pub fn is_same(&self, _: &Self) -> bool {
        match *self {}
    }

    /// True if the device can measure the time of its work.
    pub fn has_timestamps(&self) -> bool {
        match *self {}
    }

    /// Bytes that all buffers together hold.
    pub fn memory_used(&self) -> u64 {
        match *self {}
    }

    /// Bytes that crossed.
    pub fn crossed(&self) -> Crossed {
        match *self {}
    }

    /// Times that the host waited.
    pub fn waits(&self) -> u64 {
        match *self {}
    }

    /// Tells whether a call may wait.
    ///
    /// # Errors
    /// Absent in this build.
    pub fn check_wait(&self, _: &str) -> Result<(), GpuError> {
        match *self {}
    }

    /// Bytes per second that a copy reads and writes.
    ///
    /// # Errors
    /// Absent in this build.
    pub fn copy_bandwidth(&self, _: usize) -> Result<f64, GpuError> {
        match *self {}
    }

    /// Copies buffers.
    ///
    /// # Errors
    /// Absent in this build.
    pub fn copy<T>(&self, _: &str, _: [[&Buffer<T>; 2]; 2]) -> Result<(), GpuError> {
        match *self {}
    }
}

/// Memory of a device.
#[derive(Clone, Debug)]
pub struct Buffer<T> {
    gpu: Gpu,
    element: PhantomData<T>,
}

impl<T> Buffer<T> {
    /// A buffer of zeros.
    ///
    /// # Errors
    /// Absent in this build.
    pub fn new(gpu: &Gpu, _: &'static str, _: usize) -> Result<Self, GpuError> {
        match *gpu {}
    }

    /// Number of elements.
    #[expect(clippy::len_without_is_empty, reason = "nobody asks")]
    pub fn len(&self) -> usize {
        match self.gpu {}
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}
