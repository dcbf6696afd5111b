//! Records kernels and drawings into one submission.

use crate::{Bound, BoundDrawing, Buffer, Gpu, Timer};

/// Targets of drawings.
#[derive(Clone, Copy)]
pub struct Targets<'a> {
    /// A texture for colours, and whether it is cleared first.
    pub color: Option<(&'a wgpu::TextureView, wgpu::LoadOp<wgpu::Color>)>,
    /// A texture for depths, the same way.
    pub depth: Option<(&'a wgpu::TextureView, wgpu::LoadOp<f32>)>,
}

/// Number of vertices and instances of a drawing.
#[derive(Clone, Copy)]
pub enum Amount<'a> {
    /// A number of vertices, three per triangle, once, as the instance of a number.
    Vertices {
        /// Number of vertices.
        count: u32,
        /// The number.
        instance: u32,
    },
    /// The vertices of indices, for a number of instances.
    Instanced {
        /// Three a triangle.
        indices: &'a Buffer<u32>,
        /// Number of instances.
        instances: u32,
    },
}

/// Records one submission.
pub struct Recorder<'a> {
    encoder: wgpu::CommandEncoder,
    timer: Option<&'a Timer>,
    dispatches: usize,
}

impl<'a> Recorder<'a> {
    /// Starts to record; a timer takes the time of every stage.
    pub fn new(gpu: &Gpu, timer: Option<&'a Timer>) -> Self {
        let encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        Self { encoder, timer, dispatches: 0 }
    }

    /// Fills a buffer with zeros.
    pub fn clear<T: bytemuck::Pod>(&mut self, buffer: &crate::Buffer<T>) {
        self.encoder.clear_buffer(buffer.raw(), 0, None);
    }

    /// Records a stage: kernels and their numbers of workgroups, one after the other. Each sees
    /// the results of those before it.
    pub fn stage(&mut self, name: &'static str, kernels: &[(Bound, [u32; 3])]) {
        let timestamp_writes = self.timer.and_then(|timer| timer.next(name));
        let mut pass = self
            .encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(name), timestamp_writes });
        for (bound, [x, y, z]) in kernels {
            pass.set_pipeline(&bound.pipeline);
            pass.set_bind_group(0, &bound.group, &[]);
            pass.dispatch_workgroups(*x, *y, *z);
            self.dispatches += 1;
        }
    }

    /// Records drawings of a stage into targets, one after the other.
    pub fn draw(&mut self, name: &'static str, targets: &Targets, drawings: &[(&BoundDrawing, Amount)]) {
        let timestamp_writes =
            self.timer.and_then(|timer| timer.next(name)).map(|marks| wgpu::RenderPassTimestampWrites {
                query_set: marks.query_set,
                beginning_of_pass_write_index: marks.beginning_of_pass_write_index,
                end_of_pass_write_index: marks.end_of_pass_write_index,
            });
        let color = targets.color.map(|(view, load)| {
            let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        });
        let depth_stencil_attachment =
            targets.depth.map(|(view, load)| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            });
        let mut pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(name),
            color_attachments: color.as_slice(),
            depth_stencil_attachment,
            timestamp_writes,
            ..Default::default()
        });
        for (bound, amount) in drawings {
            pass.set_pipeline(&bound.pipeline);
            pass.set_bind_group(0, &bound.group, &[]);
            match amount {
                Amount::Vertices { count, instance } => pass.draw(0..*count, *instance..*instance + 1),
                Amount::Instanced { indices, instances } => {
                    pass.set_index_buffer(indices.raw().slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..indices.len() as u32, 0, 0..*instances);
                }
            }
        }
    }

    /// The encoder, for copies between stages.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        &mut self.encoder
    }

    /// Kernels recorded so far.
    pub fn dispatches(&self) -> usize {
        self.dispatches
    }

    /// Ends the recording; `last` may add copies.
    pub fn finish(mut self, last: impl FnOnce(&mut wgpu::CommandEncoder)) -> wgpu::CommandBuffer {
        last(&mut self.encoder);
        self.encoder.finish()
    }
}
