//! Where hair and body lie, for `opacity_depth`, `shade` and `draw`.

use strandline_gpu::kernel;

use super::inputs::Frame;
use super::records::Vertex;

/// Points that one thread looks at.
pub(super) const RUN: usize = 32;
/// Numbers of the box around the hair, behind which those of the lights lie.
pub(super) const BOX: usize = 6;

kernel! {
    /// The box around the hair, and what each shadow light sees of it.
    pub(super) struct MeasureHair in "measure" (super::linked::MEASURE), entry "measure_hair" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 bounds: ReadWrite u32,
    }
}

kernel! {
    /// What each shadow light sees of the body.
    pub(super) struct MeasureBody in "measure" (super::linked::MEASURE), entry "measure_body" {
        0 frame: Read Frame,
        7 bounds: ReadWrite u32,
        8 vertices: Read Vertex,
    }
}

kernel! {
    /// Windows of the maps, the grid of the surroundings, the range of depths.
    pub(super) struct Fit in "fit" (super::linked::FIT), entry "fit", threads (Some(1)) {
        0 frame: ReadWrite Frame,
        7 bounds: ReadWrite u32,
    }
}
