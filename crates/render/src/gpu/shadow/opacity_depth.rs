//! `opacity_depth`: for each light with shadow, the depth of the first hair and of the body.

use strandline_gpu::{drawing, kernel};

use crate::gpu::inputs::Frame;
use crate::gpu::records::{Corner, Vertex};

kernel! {
    /// One thread is one texel.
    pub(crate) struct ClearMaps in "opacity_depth" (crate::gpu::linked::OPACITY_DEPTH), entry "clear_maps" {
        0 frame: Read Frame,
        4 maps: ReadWrite u32,
    }
}

kernel! {
    /// One thread is one segment for one light.
    pub(crate) struct OpacityDepth in "opacity_depth" (crate::gpu::linked::OPACITY_DEPTH), entry "opacity_depth" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        4 maps: ReadWrite u32,
    }
}

drawing! {
    /// The body's depth on the plane of a light.
    pub(crate) struct BodyDepth in "opacity_depth" (crate::gpu::linked::OPACITY_DEPTH),
    vertex "body_depth_vertex", fragment None, {
        0 frame: Read Frame,
        7 triangles: Read u32,
        8 vertices: Read Vertex,
    }
}

drawing! {
    /// The same of a body whose materials cut parts of it away.
    pub(crate) struct CutDepth in "opacity_depth" (crate::gpu::linked::OPACITY_DEPTH),
    vertex "cut_depth_vertex", fragment Some("cut_depth"), {
        0 frame: Read Frame,
        7 triangles: Read u32,
        8 vertices: Read Vertex,
        9 corners: Read Corner,
        10 surfaces: Read u32,
    }
}
