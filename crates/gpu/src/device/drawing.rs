//! Drawings: vertices pulled from buffers, drawn as triangles.

use std::marker::PhantomData;

use super::kernel::{as_shader_error, bind_group, layouts, shader_module};
use super::pipelines::Compiled;
use crate::{Bindings, Declaration, Gpu, GpuError};

/// Declares a drawing: a struct of the buffers and textures that it is bound to.
///
/// ```text
/// drawing! {
///     /// Its purpose.
///     pub struct Name in "module" (LINKED_TEXT), vertex "name_vertex", fragment Some("name") {
///         0 frame: Read Frame,
///         1 samples: Texture f32,
///     }
/// }
/// ```
#[macro_export]
macro_rules! drawing {
    ($(#[$attribute:meta])* $visibility:vis struct $drawing:ident in $module:literal ($source:expr),
     vertex $vertex:literal, fragment $fragment:expr, {
        $($index:literal $name:ident: $access:ident $kind:ty,)*
    }) => {
        $crate::declare! {
            $(#[$attribute])* $visibility struct $drawing in $module ($source), $vertex, $fragment, true, None, {
                $($index $name: $access $kind,)*
            }
        }
    };
}

/// Target of a drawing, and its blending.
#[derive(Clone, Debug, Default)]
pub struct Output {
    /// Format of the colours and their blending; `None` if only depth is drawn.
    pub color: Option<(wgpu::TextureFormat, Option<wgpu::BlendState>)>,
    /// Test against a depth texture.
    pub depth: Option<wgpu::DepthStencilState>,
}

/// A compiled drawing; `B` is the type declared by [`drawing!`](crate::drawing), with a static lifetime.
#[derive(Debug)]
pub struct Drawing<B> {
    compiled: Compiled<wgpu::RenderPipeline>,
    bindings: PhantomData<fn(B)>,
}

/// A drawing with its buffers, ready to run.
#[derive(Clone, Debug)]
pub struct BoundDrawing {
    pub(crate) pipeline: wgpu::RenderPipeline,
    pub(crate) group: wgpu::BindGroup,
}

impl<B: Bindings<Kernel = B>> Drawing<B> {
    /// Compiles a drawing with values for its `override` constants; a device compiles each once for an output.
    ///
    /// # Errors
    /// The driver does not take it, or the device was lost.
    pub fn new(gpu: &Gpu, output: &Output, constants: &[(&str, f64)]) -> Result<Self, GpuError> {
        let declaration = B::declaration();
        let compile = || {
            let made = gpu.ask(declaration.module, || compiled(gpu, &declaration, output, constants));
            made.map_err(as_shader_error)
        };
        let key = format!("{} {constants:?} {output:?}", declaration.key());
        let compiled = gpu.drawings().get(key, compile)?;
        Ok(Self { compiled, bindings: PhantomData })
    }

    /// Binds a drawing to its buffers.
    ///
    /// # Errors
    /// A buffer does not fit, or the device was lost.
    pub fn bind<C: Bindings<Kernel = B>>(&self, gpu: &Gpu, buffers: &C) -> Result<BoundDrawing, GpuError> {
        let group = bind_group(gpu, &self.compiled.layout, buffers)?;
        Ok(BoundDrawing { pipeline: self.compiled.pipeline.clone(), group })
    }
}

fn compiled(
    gpu: &Gpu,
    declaration: &Declaration,
    output: &Output,
    constants: &[(&str, f64)],
) -> Compiled<wgpu::RenderPipeline> {
    let device = gpu.device();
    let (layout, pipeline_layout) = layouts(device, declaration);
    let module = &shader_module(device, declaration);
    let compilation_options = wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let target = output.color.map(|(format, blend)| {
        Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })
    });
    let fragment = declaration.fragment.map(|entry| wgpu::FragmentState {
        module,
        entry_point: Some(entry),
        compilation_options: compilation_options.clone(),
        targets: target.as_slice(),
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(declaration.entry),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(declaration.entry),
            compilation_options: compilation_options.clone(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: output.depth.clone(),
        multisample: wgpu::MultisampleState::default(),
        fragment,
        multiview_mask: None,
        cache: None,
    });
    Compiled { pipeline, layout }
}
