//! Copies from the device: several buffers with one submission.

use std::marker::PhantomData;
use std::ops::Range;

use bytemuck::Pod;

use super::transfer::{Mapping, StagingMemory, mapped};
use crate::{Buffer, Gpu, GpuError, Transfer};

/// Buffers to be copied back together.
#[derive(Debug, Default)]
pub struct Readback<'a> {
    copies: Vec<(&'a wgpu::Buffer, Range<usize>)>,
    bytes: usize,
}

/// Place of the copy of one buffer of a [`Readback`].
#[derive(Clone, Debug)]
pub struct Slot<T> {
    bytes: Range<usize>,
    element: PhantomData<T>,
}

/// Copied bytes.
#[derive(Debug)]
pub struct Copied {
    pub(super) bytes: Vec<u8>,
}

impl<'a> Readback<'a> {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the first `count` elements of a buffer, or all where it holds fewer.
    pub fn add<T: Pod>(&mut self, buffer: &'a Buffer<T>, count: usize) -> Slot<T> {
        let size = count.min(buffer.len()) * size_of::<T>();
        let bytes = self.bytes..self.bytes + size;
        // Copies start and end at whole words.
        self.bytes = bytes.end.next_multiple_of(4);
        if size > 0 {
            self.copies.push((buffer.raw(), bytes.start..self.bytes));
        }
        Slot { bytes, element: PhantomData }
    }

    /// Waits for the copies and takes them.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn read(self, gpu: &Gpu) -> Result<Copied, GpuError> {
        gpu.check_wait("a copy back")?;
        self.begin(gpu)?.wait()
    }

    /// Submits the copies, after everything that was submitted before.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn begin(self, gpu: &Gpu) -> Result<Transfer, GpuError> {
        let held = StagingMemory::new(gpu, self.bytes as u64)?;
        if self.bytes == 0 {
            return Ok(Transfer::new(held, None));
        }
        gpu.ask("readback", || {
            let staging = gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: self.bytes as u64,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let mut encoder = gpu.device().create_command_encoder(&Default::default());
            for (buffer, bytes) in &self.copies {
                let (start, size) = (bytes.start as u64, bytes.len() as u64);
                encoder.copy_buffer_to_buffer(buffer, 0, &staging, start, size);
            }
            let submission = gpu.queue().submit([encoder.finish()]);
            Transfer::new(held, Some((staging, submission)))
        })
    }
}

impl Copied {
    /// The elements of one buffer.
    pub fn take<T: Pod>(&self, slot: Slot<T>) -> Vec<T> {
        bytemuck::pod_collect_to_vec(&self.bytes[slot.bytes])
    }
}

/// Memory of the host's that copies go to again and again.
#[derive(Debug)]
pub struct Download {
    held: StagingMemory,
    staging: wgpu::Buffer,
}

impl Download {
    /// Room for bytes.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn new(gpu: &Gpu, bytes: u64) -> Result<Self, GpuError> {
        let held = StagingMemory::new(gpu, bytes)?;
        let staging = gpu.ask("readback", || {
            gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        Ok(Self { held, staging })
    }

    /// Target of copies.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.staging
    }

    /// Waits for the submission that copied (`None`: for all submissions), and gives the copied bytes.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read<T>(
        &self,
        submission: Option<wgpu::SubmissionIndex>,
        look: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, GpuError> {
        let gpu = &self.held.gpu;
        gpu.check_wait("a copy back")?;
        let mut mapping = Mapping::new(&self.staging, submission);
        mapping.wait(gpu)?;
        let view = mapped(gpu, &self.staging)?;
        let result = look(&view);
        drop(view);
        self.staging.unmap();
        Ok(result)
    }
}
