//! The back-to-front order of the segments, for `draw`.

use strandline_gpu::kernel;

use super::inputs::Frame;

kernel! {
    /// One thread is one strand.
    pub(super) struct ListSegments in "sort" (super::linked::SORT), entry "list_segments" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 keys: ReadWrite u32,
        8 starts: ReadWrite u32,
    }
}

kernel! {
    /// One thread is one segment.
    pub(super) struct OrderSegments in "sort" (super::linked::SORT), entry "order_segments" {
        0 frame: Read Frame,
        7 keys: ReadWrite u32,
        8 starts: ReadWrite u32,
        10 order: ReadWrite u32,
    }
}
