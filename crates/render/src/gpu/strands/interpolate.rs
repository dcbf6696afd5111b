//! `interpolate`: the strands that are drawn, grown about each guide's curve.

use strandline_gpu::kernel;

use crate::gpu::inputs::Frame;
use crate::gpu::records::{Curve, Root, Tap};

kernel! {
    /// One thread is one point of a drawn strand.
    pub(crate) struct Interpolate in "interpolate" (crate::gpu::linked::INTERPOLATE), entry "interpolate" {
        0 frame: Read Frame,
        1 points: ReadWrite [f32; 4],
        7 radiances: ReadWrite [u32; 2],
        9 roots: Read Root,
        10 tables: Read Tap,
        11 curves: Read Curve,
        12 clumps: Read [f32; 4],
        13 scales: Read f32,
    }
}
