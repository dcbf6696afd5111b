//! The back-to-front order of the segments, for `draw`.

use strandline_gpu::kernel;

use crate::gpu::inputs::Frame;

kernel! {
    /// One thread is one strand.
    pub(crate) struct ListSegments in "sort" (crate::gpu::linked::SORT), entry "list_segments" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 keys: ReadWrite u32,
        8 starts: ReadWrite u32,
    }
}

kernel! {
    /// One thread is one segment.
    pub(crate) struct OrderSegments in "sort" (crate::gpu::linked::SORT), entry "order_segments" {
        0 frame: Read Frame,
        7 keys: ReadWrite u32,
        8 starts: ReadWrite u32,
        10 order: ReadWrite u32,
    }
}
