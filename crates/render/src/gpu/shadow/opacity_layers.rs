//! `opacity_layers`: for each light with shadow, the hairs crossed in three layers behind the first.

use strandline_gpu::kernel;

use crate::gpu::inputs::Frame;

kernel! {
    /// One thread is one segment for one light.
    pub(crate) struct OpacityLayers in "opacity_layers" (crate::gpu::linked::OPACITY_LAYERS), entry "opacity_layers" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        4 maps: ReadWrite u32,
    }
}
