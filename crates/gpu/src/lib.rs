//! A thin kit over wgpu: a device, typed buffers, kernels that are held to their shaders, readback
//! and timestamps. There is no hair in it.
//!
//! Everything keeps to WebGPU's default limits, whatever the adapter offers. Without the feature `wgpu` the
//! kit knows the names of backends and that there is no GPU.

#![forbid(unsafe_code)]

#[cfg(not(feature = "wgpu"))]
mod absent;
mod adapter;
mod backend;
mod error;

#[cfg(feature = "wgpu")]
mod bandwidth;
#[cfg(feature = "wgpu")]
mod buffer;
#[cfg(feature = "wgpu")]
mod check;
#[cfg(feature = "wgpu")]
mod drawing;
#[cfg(feature = "wgpu")]
mod gpu;
#[cfg(feature = "wgpu")]
mod kernel;
#[cfg(feature = "wgpu")]
mod layout;
#[cfg(feature = "wgpu")]
mod linked;
#[cfg(feature = "wgpu")]
mod readback;
#[cfg(feature = "wgpu")]
mod recorder;
#[cfg(feature = "wgpu")]
mod scan;
#[cfg(feature = "wgpu")]
mod texture;
#[cfg(feature = "wgpu")]
mod timer;

pub use adapter::{Adapter, Crossed};
pub use backend::{Backend, UnknownBackend};
pub use error::GpuError;

#[cfg(not(feature = "wgpu"))]
pub use absent::{Buffer, Gpu};
#[cfg(feature = "wgpu")]
pub use {
    buffer::Buffer,
    check::check,
    drawing::{BoundDrawing, Drawing, Output},
    gpu::Gpu,
    kernel::{Access, Binding, Bindings, Bound, Declaration, Dispatches, Kernel, Resource, groups},
    layout::{Field, Layout, Mirror},
    readback::{Copied, Download, Part, Readback},
    recorder::{Amount, Recorder, Targets},
    scan::Scan,
    texture::Texture,
    timer::Timer,
};

/// The crate that the host's device and queue come from.
#[cfg(feature = "wgpu")]
pub use wgpu;

#[cfg(feature = "wgpu")]
#[doc(hidden)]
pub use bytemuck;
