//! Guide points of a simulation on the same device.

use strandline_gpu::Buffer;

/// Guide points that lie on the device, `[block][point][component][lane]` \[m\], world space: at the two
/// states between which a picture lies.
#[derive(Clone, Copy)]
pub struct DevicePoints<'a> {
    /// Before the moment shown.
    pub before: &'a Buffer<f32>,
    /// After it.
    pub after: &'a Buffer<f32>,
    /// Place of the moment between them, 0 to 1.
    pub share: f32,
}
