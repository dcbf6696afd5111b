//! What is behind everything, for `draw`.

use strandline_gpu::drawing;

use super::inputs::Frame;

drawing! {
    /// One triangle over the whole picture.
    pub(super) struct Backdrop in "background" (super::linked::BACKGROUND),
    vertex "background_vertex", fragment Some("background"), {
        0 frame: Read Frame,
    }
}
