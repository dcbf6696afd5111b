//! A device and its resources.

mod bandwidth;
mod buffer;
// A page has no naga.
#[cfg(not(target_family = "wasm"))]
mod check;
mod drawing;
mod errors;
mod gpu;
mod kernel;
mod layout;
mod linked;
mod pipelines;
mod readback;
mod recorder;
mod rigid;
mod scan;
mod texture;
mod timer;
mod transfer;
mod wanted;

pub use buffer::Buffer;
#[cfg(not(target_family = "wasm"))]
pub use check::check;
pub use drawing::{BoundDrawing, Drawing, Output};
pub use gpu::Gpu;
pub use kernel::{Access, Binding, Bindings, Bound, Declaration, Dispatches, Kernel, Resource, groups};
pub use layout::{Field, Layout, Mirror, Tail};
pub use readback::{Copied, Download, Readback, Slot};
pub use recorder::{Amount, Recorder, Targets};
pub use rigid::Rigid;
pub use scan::Scan;
pub use texture::Texture;
pub use timer::Timer;
pub use transfer::Transfer;
pub use wanted::Wanted;
