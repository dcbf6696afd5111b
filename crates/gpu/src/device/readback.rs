//! Copies from the device: several buffers with one submission and one wait.

use std::marker::PhantomData;
use std::ops::Range;

use bytemuck::Pod;

use crate::{Buffer, Gpu, GpuError};

/// Buffers to be copied back together.
#[derive(Debug, Default)]
pub struct Readback<'a> {
    parts: Vec<(&'a wgpu::Buffer, Range<usize>)>,
    bytes: usize,
}

/// One of the buffers of a [`Readback`].
#[derive(Clone, Debug)]
pub struct Part<T> {
    bytes: Range<usize>,
    element: PhantomData<T>,
}

/// What was copied.
#[derive(Debug)]
pub struct Copied {
    bytes: Vec<u8>,
}

impl<'a> Readback<'a> {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the first `count` elements of a buffer, or all where it holds fewer.
    pub fn add<T: Pod>(&mut self, buffer: &'a Buffer<T>, count: usize) -> Part<T> {
        let size = count.min(buffer.len()) * size_of::<T>();
        let bytes = self.bytes..self.bytes + size;
        // Copies start and end at whole words.
        self.bytes = bytes.end.next_multiple_of(4);
        if size > 0 {
            self.parts.push((buffer.raw(), bytes.start..self.bytes));
        }
        Part { bytes, element: PhantomData }
    }

    /// Waits for the device and copies.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn read(self, gpu: &Gpu) -> Result<Copied, GpuError> {
        if self.bytes == 0 {
            return Ok(Copied { bytes: Vec::new() });
        }
        gpu.take_memory("the copy back", self.bytes as u64)?;
        let copied = self.copy(gpu);
        gpu.give_memory_back(self.bytes as u64);
        copied
    }

    fn copy(&self, gpu: &Gpu) -> Result<Copied, GpuError> {
        let staging = gpu.guarded("readback", || {
            let staging = gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: self.bytes as u64,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let mut encoder = gpu.device().create_command_encoder(&Default::default());
            for (buffer, bytes) in &self.parts {
                let (start, size) = (bytes.start as u64, bytes.len() as u64);
                encoder.copy_buffer_to_buffer(buffer, 0, &staging, start, size);
            }
            gpu.queue().submit([encoder.finish()]);
            staging.slice(..).map_async(wgpu::MapMode::Read, |_| ());
            staging
        })?;
        gpu.wait()?;
        let view = staging.slice(..).get_mapped_range().map_err(|error| GpuError::Refused {
            adapter: gpu.name(),
            what: "reading back".to_owned(),
            message: error.to_string(),
        })?;
        gpu.count_from_device(view.len());
        Ok(Copied { bytes: view.to_vec() })
    }
}

impl Copied {
    /// The elements of one buffer.
    pub fn take<T: Pod>(&self, part: Part<T>) -> Vec<T> {
        bytemuck::pod_collect_to_vec(&self.bytes[part.bytes])
    }
}

/// Memory of the host's that copies go to again and again.
#[derive(Debug)]
pub struct Download {
    gpu: Gpu,
    staging: wgpu::Buffer,
}

impl Download {
    /// Room for bytes.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn new(gpu: &Gpu, bytes: u64) -> Result<Self, GpuError> {
        gpu.take_memory("the copy back", bytes)?;
        let made = gpu.guarded("readback", || {
            gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        match made {
            Ok(staging) => Ok(Self { gpu: gpu.clone(), staging }),
            Err(error) => {
                gpu.give_memory_back(bytes);
                Err(error)
            }
        }
    }

    /// Where copies are to go.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.staging
    }

    /// Waits for the device and shows what was copied.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read<T>(&self, look: impl FnOnce(&[u8]) -> T) -> Result<T, GpuError> {
        self.gpu.guarded("readback", || self.staging.slice(..).map_async(wgpu::MapMode::Read, |_| ()))?;
        self.gpu.wait()?;
        let view = self.staging.slice(..).get_mapped_range().map_err(|error| GpuError::Refused {
            adapter: self.gpu.name(),
            what: "reading back".to_owned(),
            message: error.to_string(),
        })?;
        self.gpu.count_from_device(view.len());
        let result = look(&view);
        drop(view);
        self.staging.unmap();
        Ok(result)
    }
}

impl Drop for Download {
    fn drop(&mut self) {
        self.gpu.give_memory_back(self.staging.size());
    }
}
