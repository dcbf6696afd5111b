//! The body, for `draw`.

use strandline_gpu::drawing;

use super::inputs::{Frame, LightSource};

drawing! {
    /// Three vertices are one triangle.
    pub(super) struct Body in "body" (super::linked::BODY), vertex "body_vertex", fragment Some("body"), {
        0 frame: Read Frame,
        2 lights: Read LightSource,
        3 fitted: Read [f32; 4],
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 triangles: Read u32,
        8 vertices: Read [f32; 4],
    }
}
