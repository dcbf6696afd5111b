//! The stages as kernels and drawings, through wgpu; every one has a twin in plain Rust under the same
//! name.
//!
//! A [`GpuRenderer`] keeps its buffers from frame to frame; a frame is one submission. Guide points may
//! lie on the device already, and the picture may stay there.

mod background;
mod body;
mod bound;
mod bound_solids;
mod buffers;
mod channels;
mod codes;
mod device_points;
mod draw;
mod fit;
mod frame;
mod inputs;
mod interpolate;
mod light_grid;
mod linked;
mod occlude;
mod opacity_depth;
mod opacity_layers;
mod points;
mod probe;
mod records;
mod renderer;
mod resolve;
mod scene;
mod shade;
mod sort;
mod stages;
mod tessellate;

pub use device_points::DevicePoints;
pub use linked::modules;
pub use renderer::GpuRenderer;
pub use stages::declarations;

/// Most lights of a picture.
pub const MAX_LIGHTS: usize = 32;
/// Most lights with shadow among them.
pub const MAX_SHADOWS: usize = 8;

/// Places in the order of depth.
const ORDER_STEPS: usize = 65_536;
