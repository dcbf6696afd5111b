//! The body, for `draw`: the triangle that each sample shows, and its depth.

use strandline_gpu::drawing;

use crate::gpu::inputs::Frame;
use crate::gpu::records::{Corner, Vertex};

drawing! {
    /// Three vertices are one triangle.
    pub(crate) struct Body in "body" (crate::gpu::linked::BODY), vertex "body_vertex", fragment Some("body"), {
        0 frame: Read Frame,
        7 triangles: Read u32,
        8 vertices: Read Vertex,
    }
}

drawing! {
    /// The same of a body whose materials cut parts of it away.
    pub(crate) struct CutBody in "body" (crate::gpu::linked::BODY),
    vertex "cut_body_vertex", fragment Some("cut_body"), {
        0 frame: Read Frame,
        7 triangles: Read u32,
        8 vertices: Read Vertex,
        9 corners: Read Corner,
        10 surfaces: Read u32,
    }
}
