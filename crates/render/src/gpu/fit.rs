//! Where hair and body lie, for `opacity_depth`, `shade` and `draw`.

use strandline_gpu::kernel;

use super::inputs::{Frame, LightSource};

/// Points that one thread looks at, as in fit.wesl.
pub(super) const RUN: usize = 32;

kernel! {
    /// The box around the hair, and what each shadow light sees of it.
    pub(super) struct MeasureHair in "fit" (super::linked::FIT), entry "measure_hair" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        2 lights: Read LightSource,
        7 bounds: ReadWrite u32,
    }
}

kernel! {
    /// What each shadow light sees of the body.
    pub(super) struct MeasureBody in "fit" (super::linked::FIT), entry "measure_body" {
        0 frame: Read Frame,
        2 lights: Read LightSource,
        7 bounds: ReadWrite u32,
        8 vertices: Read [f32; 4],
    }
}

kernel! {
    /// Windows of the maps, the grid of the surroundings, the range of depths.
    pub(super) struct Fit in "fit" (super::linked::FIT), entry "fit" {
        0 frame: Read Frame,
        2 lights: Read LightSource,
        3 fitted: ReadWrite [f32; 4],
        7 bounds: ReadWrite u32,
    }
}
