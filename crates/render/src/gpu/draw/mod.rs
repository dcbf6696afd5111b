//! `draw`: the hair as ribbons over body and background, back to front.

pub(crate) mod background;
pub(crate) mod body;
pub(crate) mod sort;

use strandline_gpu::{Buffer, Gpu, GpuError, Output, drawing, wgpu};

use crate::gpu::buffers::{DEPTH, SAMPLES, TRIANGLES};
use crate::gpu::inputs::Frame;

drawing! {
    /// Four vertices are one segment.
    pub(crate) struct Hair in "draw" (crate::gpu::linked::DRAW), vertex "hair_vertex", fragment Some("hair"), {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 radiances: Read [u32; 2],
        8 starts: Read u32,
        10 order: Read u32,
    }
}

/// Segments that share the indices of one instance.
pub(crate) const BATCH: usize = 16_384;

/// Two triangles for each segment of a batch.
pub(crate) fn indices(gpu: &Gpu) -> Result<Buffer<u32>, GpuError> {
    let corners = |segment: u32| [0, 1, 2, 2, 1, 3].map(|corner| 4 * segment + corner);
    let indices: Vec<u32> = (0..BATCH as u32).flat_map(corners).collect();
    Buffer::from_slice(gpu, "indices", &indices)
}

/// Blending of hair: depth is one over the distance, so that nearer is greater.
pub(crate) fn hair_output() -> Output {
    Output {
        color: Some((SAMPLES, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING))),
        depth: Some(depth(wgpu::CompareFunction::GreaterEqual, false)),
    }
}

/// Of the body the nearest triangle.
pub(crate) fn body_output() -> Output {
    Output { color: Some((TRIANGLES, None)), depth: Some(depth(wgpu::CompareFunction::Greater, true)) }
}

/// The background covers everything.
pub(crate) fn background_output() -> Output {
    Output { color: Some((SAMPLES, None)), depth: None }
}

/// Depths of a body for a light: nearer is smaller.
pub(crate) fn body_depth_output() -> Output {
    Output { color: None, depth: Some(depth(wgpu::CompareFunction::Less, true)) }
}

fn depth(compare: wgpu::CompareFunction, writes: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(writes),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}
