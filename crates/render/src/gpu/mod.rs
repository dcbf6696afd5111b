//! The stages as kernels and drawings, through wgpu; every one has a twin in plain Rust under the same
//! name.
//!
//! A [`GpuRenderer`] keeps its buffers from frame to frame; a frame is one submission. Guide points may
//! lie on the device already, and the picture may stay there.

mod buffers;
mod channel_state;
mod channels;
mod codes;
mod draw;
mod frame;
mod framing;
mod half;
mod inputs;
mod linked;
mod probe;
mod records;
mod renderer;
mod resolve;
mod scatter;
mod scene;
mod shade;
mod shadow;
mod skin;
mod stages;
mod strands;

pub use linked::modules;
pub use renderer::GpuRenderer;
pub use stages::declarations;
pub use strands::bound_solids::DeviceSolids;
pub use strands::device_points::DevicePoints;

/// Most lights of a picture.
pub const MAX_LIGHTS: usize = 32;
/// Most lights with shadow among them.
pub const MAX_SHADOWS: usize = 8;

/// Places in the order of depth.
const ORDER_STEPS: usize = 65_536;
