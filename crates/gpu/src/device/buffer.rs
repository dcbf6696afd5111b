use std::marker::PhantomData;
use std::sync::Arc;

use bytemuck::Pod;

use crate::{Gpu, GpuError, Readback};

/// Elements of one type on the device.
#[derive(Debug)]
pub struct Buffer<T> {
    lease: Arc<Lease>,
    raw: wgpu::Buffer,
    name: &'static str,
    len: usize,
    element: PhantomData<T>,
}

/// Memory that is returned with its last user.
#[derive(Debug)]
struct Lease {
    gpu: Gpu,
    bytes: u64,
}

impl Drop for Lease {
    fn drop(&mut self) {
        self.gpu.give_memory_back(self.bytes);
    }
}

impl<T: Pod> Buffer<T> {
    /// A buffer of zeros; an empty buffer has room for one element, since bindings need it.
    ///
    /// # Errors
    /// It is larger than WebGPU's default limits allow, or the device has no memory left.
    pub fn new(gpu: &Gpu, name: &'static str, len: usize) -> Result<Self, GpuError> {
        Self::with_bytes(gpu, name, len, len.max(1) * size_of::<T>())
    }

    /// As [`Buffer::new`], with room for elements of another type behind the last; for one at least.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn with_tail<U: Pod>(
        gpu: &Gpu,
        name: &'static str,
        len: usize,
        tail: usize,
    ) -> Result<Self, GpuError> {
        Self::with_bytes(gpu, name, len, len.max(1) * size_of::<T>() + tail.max(1) * size_of::<U>())
    }

    fn with_bytes(gpu: &Gpu, name: &'static str, len: usize, bytes: usize) -> Result<Self, GpuError> {
        let bytes = bytes.next_multiple_of(4) as u64;
        gpu.check_size(name, bytes)?;
        gpu.take_memory(name, bytes)?;
        let lease = Arc::new(Lease { gpu: gpu.clone(), bytes });
        let descriptor = wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST
                | wgpu::BufferUsages::INDEX
                | wgpu::BufferUsages::QUERY_RESOLVE,
            mapped_at_creation: false,
        };
        let made = gpu.ask(name, || gpu.device().create_buffer(&descriptor));
        match made {
            Ok(raw) => Ok(Self { lease, raw, name, len, element: PhantomData }),
            Err(GpuError::OutOfMemory { adapter, what, .. }) => {
                Err(GpuError::OutOfMemory { adapter, what, bytes })
            }
            Err(other) => Err(other),
        }
    }

    /// A buffer that holds copies of elements.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn from_slice(gpu: &Gpu, name: &'static str, elements: &[T]) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, name, elements.len())?;
        buffer.write(elements)?;
        Ok(buffer)
    }

    /// The same memory as elements of another type.
    pub fn viewed_as<U: Pod>(&self) -> Buffer<U> {
        let len = self.len * size_of::<T>() / size_of::<U>();
        let (lease, raw) = (self.lease.clone(), self.raw.clone());
        Buffer { lease, raw, name: self.name, len, element: PhantomData }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True without elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The device that it lies on.
    pub fn gpu(&self) -> &Gpu {
        &self.lease.gpu
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The buffer itself, for a renderer on the same device.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.raw
    }

    /// Replaces the first elements.
    ///
    /// # Errors
    /// The device was lost, or there are more elements than the buffer holds.
    pub fn write(&self, elements: &[T]) -> Result<(), GpuError> {
        self.write_at(0, elements)
    }

    /// Replaces the elements from number `first` on; it lies at a multiple of four bytes.
    ///
    /// # Errors
    /// As [`Buffer::write`].
    pub fn write_at(&self, first: usize, elements: &[T]) -> Result<(), GpuError> {
        self.write_bytes(first * size_of::<T>(), bytemuck::cast_slice(elements))
    }

    /// Replaces the first elements behind the last of the buffer's own: see [`Buffer::with_tail`].
    ///
    /// # Errors
    /// As [`Buffer::write`].
    pub fn write_tail<U: Pod>(&self, elements: &[U]) -> Result<(), GpuError> {
        self.write_bytes(self.len * size_of::<T>(), bytemuck::cast_slice(elements))
    }

    fn write_bytes(&self, first: usize, bytes: &[u8]) -> Result<(), GpuError> {
        if bytes.is_empty() {
            return Ok(());
        }
        let (gpu, end) = (self.gpu(), (first + bytes.len()) as u64);
        gpu.check_lost()?;
        if end > self.raw.size() {
            let message = format!("a write ends at byte {end} of {}", self.raw.size());
            return Err(GpuError::Refused { adapter: gpu.name(), what: self.name.to_owned(), message });
        }
        gpu.count_to_device(bytes.len());
        gpu.queue().write_buffer(&self.raw, first as u64, bytes);
        Ok(())
    }

    /// Waits for the device and copies all elements back.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn read(&self) -> Result<Vec<T>, GpuError> {
        self.read_first(self.len)
    }

    /// Waits for the device and copies the first `count` elements back.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn read_first(&self, count: usize) -> Result<Vec<T>, GpuError> {
        let mut batch = Readback::new();
        let part = batch.add(self, count);
        Ok(batch.read(self.gpu())?.take(part))
    }
}

impl<T> Buffer<T> {
    /// As [`Buffer::raw`], for any type of element.
    pub(crate) fn raw_buffer(&self) -> &wgpu::Buffer {
        &self.raw
    }
}

impl Gpu {
    /// Copies the first buffer of each pair into the second, which is as long.
    ///
    /// # Errors
    /// The device was lost, or a buffer is another device's.
    pub fn copy<T: Pod>(&self, what: &str, pairs: [[&Buffer<T>; 2]; 2]) -> Result<(), GpuError> {
        self.ask(what, || {
            let mut encoder = self.device().create_command_encoder(&Default::default());
            for [from, to] in pairs {
                encoder.copy_buffer_to_buffer(from.raw(), 0, to.raw(), 0, from.raw().size());
            }
            self.queue().submit([encoder.finish()]);
        })
    }
}
