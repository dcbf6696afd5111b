//! A thin kit over wgpu: a device, typed buffers, kernels that are held to their shaders, readback
//! and timestamps. There is no hair in it.
//!
//! Everything keeps to WebGPU's default limits on every adapter. Without the feature `wgpu` the
//! kit knows the names of backends and that there is no GPU.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // compared values may be rounded

// `mirror!` names the crate.
extern crate self as strandline_gpu;

#[cfg(not(feature = "wgpu"))]
mod absent;
mod adapter;
mod backend;
#[cfg(feature = "wgpu")]
mod device;
mod error;
mod threads;

#[cfg(not(feature = "wgpu"))]
pub use absent::{Buffer, Gpu};
pub use adapter::{Adapter, Crossed};
pub use backend::{Backend, UnknownBackend};
#[cfg(feature = "wgpu")]
pub use device::*;
pub use error::GpuError;
pub use threads::{MANY, THREADS};

/// The crate that the host's device and queue come from.
#[cfg(feature = "wgpu")]
pub use wgpu;

#[cfg(feature = "wgpu")]
#[doc(hidden)]
pub use bytemuck;
