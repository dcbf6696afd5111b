//! Bounds of hair and body, for `opacity_depth`, `shade` and `draw`.

use strandline_gpu::kernel;

use crate::gpu::inputs::Frame;
use crate::gpu::records::Vertex;

/// Points that one thread looks at.
pub(crate) const RUN: usize = 32;
/// Numbers of the box around the hair, behind which those of the lights lie.
pub(crate) const BOX: usize = 6;

kernel! {
    /// The box around the hair, and what each shadow light sees of it.
    pub(crate) struct MeasureHair in "measure" (crate::gpu::linked::MEASURE), entry "measure_hair" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 bounds: ReadWrite u32,
    }
}

kernel! {
    /// Bounds of the body as seen by each shadow light.
    pub(crate) struct MeasureBody in "measure" (crate::gpu::linked::MEASURE), entry "measure_body" {
        0 frame: Read Frame,
        7 bounds: ReadWrite u32,
        8 vertices: Read Vertex,
    }
}

kernel! {
    /// Windows of the maps, the grid of the surroundings, the range of depths.
    pub(crate) struct Fit in "fit" (crate::gpu::linked::FIT), entry "fit", threads (Some(1)) {
        0 frame: ReadWrite Frame,
        7 bounds: ReadWrite u32,
    }
}
