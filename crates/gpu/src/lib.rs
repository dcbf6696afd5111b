//! A thin kit over wgpu: a device, typed buffers, kernels that are held to their shaders, readback
//! and timestamps. There is no hair in it.
//!
//! Everything keeps to WebGPU's default limits, whatever the adapter offers.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // what is held to others may be rounded

mod backend;
mod bandwidth;
mod buffer;
mod check;
mod drawing;
mod error;
mod gpu;
mod kernel;
mod layout;
mod linked;
mod list;
mod readback;
mod recorder;
mod scan;
mod texture;
mod timer;

pub use backend::{Backend, UnknownBackend};
pub use buffer::Buffer;
pub use check::check;
pub use drawing::{BoundDrawing, Drawing, Output};
pub use error::GpuError;
pub use gpu::{Crossed, Gpu};
pub use kernel::{Access, Binding, Bindings, Bound, Declaration, Dispatches, Kernel, Resource, groups};
pub use layout::{Field, Layout, Mirror};
pub use list::Adapter;
pub use readback::{Copied, Download, Part, Readback};
pub use recorder::{Amount, Recorder, Targets};
pub use scan::Scan;
pub use texture::Texture;
pub use timer::Timer;

/// The crate that the host's device and queue come from.
pub use wgpu;

#[doc(hidden)]
pub use bytemuck;
