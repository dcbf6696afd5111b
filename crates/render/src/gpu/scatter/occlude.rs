//! Surroundings hidden by hair, for `shade` and `draw`.

use strandline_gpu::{MANY, kernel};

use crate::gpu::inputs::Frame;

kernel! {
    /// One thread is one segment.
    pub(crate) struct SumAreas in "occlude" (crate::gpu::linked::OCCLUDE), entry "sum_areas" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 areas: ReadWrite u32,
    }
}

kernel! {
    /// One workgroup is one direction.
    pub(crate) struct Sweep in "occlude" (crate::gpu::linked::OCCLUDE), entry "sweep", threads (Some(MANY)) {
        0 frame: Read Frame,
        6 cubes: ReadWrite f32,
        7 areas: ReadWrite u32,
    }
}
