//! The body, for `draw`.

use glam::Vec3;
use strandline_body::Mesh;
use strandline_gpu::drawing;

use crate::gpu::inputs::Frame;
use crate::gpu::records::Vertex;

drawing! {
    /// Three vertices are one triangle.
    pub(crate) struct Body in "body" (crate::gpu::linked::BODY), vertex "body_vertex", fragment Some("body"), {
        0 frame: Read Frame,
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 triangles: Read u32,
        8 vertices: Read Vertex,
    }
}

/// A ball around a mesh: the middle of its box and the way to a corner.
pub(crate) fn ball(mesh: Option<&Mesh>) -> (Vec3, f32) {
    let positions = mesh.map_or(&[][..], |mesh| &mesh.positions);
    if positions.is_empty() {
        return (Vec3::ZERO, 0.0);
    }
    let (low, high) = positions
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(low, high), &point| (low.min(point), high.max(point)));
    // A hundredth more keeps rounding inside.
    (0.5 * (low + high), 0.505 * low.distance(high))
}
