//! `shade`: light from every point of the hair toward the camera.

use strandline_gpu::kernel;

use super::inputs::{Frame, LightSource};

kernel! {
    /// One thread is one point.
    pub(super) struct Shade in "shade" (super::linked::SHADE), entry "shade" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        2 lights: Read LightSource,
        3 fitted: Read [f32; 4],
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}
