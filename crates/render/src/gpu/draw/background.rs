//! The background, for `draw`.

use strandline_gpu::drawing;

use crate::gpu::inputs::Frame;

drawing! {
    /// One triangle over the whole picture.
    pub(crate) struct Backdrop in "background" (crate::gpu::linked::BACKGROUND),
    vertex "background_vertex", fragment Some("background"), {
        0 frame: Read Frame,
    }
}
