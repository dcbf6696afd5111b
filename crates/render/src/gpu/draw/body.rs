//! The body, for `draw`.

use strandline_gpu::drawing;

use crate::gpu::inputs::Frame;
use crate::gpu::records::{Corner, Vertex};

drawing! {
    /// Three vertices are one triangle.
    pub(crate) struct Body in "body" (crate::gpu::linked::BODY), vertex "body_vertex", fragment Some("body"), {
        0 frame: Read Frame,
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 triangles: Read u32,
        8 vertices: Read Vertex,
        9 corners: Read Corner,
        10 surfaces: Read u32,
    }
}
