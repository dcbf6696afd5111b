//! Kernels: one declaration from which the pipeline's layout, the bind group and the check against
//! the linked shader derive.

use std::marker::PhantomData;

use super::pipelines::Compiled;
use crate::{Gpu, GpuError, Layout};

/// Use of a buffer by a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// `var<storage, read>`.
    Read,
    /// `var<storage, read_write>`.
    ReadWrite,
    /// `var` of type `texture_2d`, read without a sampler.
    Texture,
    /// `var` of type `texture_storage_2d<rgba16float, write>`.
    Written,
}

/// One buffer of a kernel.
#[derive(Clone, Debug)]
pub struct Binding {
    /// Its number in group 0.
    pub index: u32,
    /// The variable's name.
    pub name: &'static str,
    /// Its use.
    pub access: Access,
    /// Layout of an element.
    pub layout: Layout,
}

/// Declaration of a kernel, known without a device.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// The shader module.
    pub module: &'static str,
    /// Its linked text.
    pub source: &'static str,
    /// The entry point, of a drawing that of its vertices.
    pub entry: &'static str,
    /// The entry point of a drawing's fragments, where it has any.
    pub fragment: Option<&'static str>,
    /// True for a drawing.
    pub draws: bool,
    /// Threads of a workgroup, along its first axis; `None` if a constant of the pipeline chooses them, and for a
    /// drawing.
    pub threads: Option<usize>,
    /// Its buffers.
    pub bindings: Vec<Binding>,
}

impl Declaration {
    /// Key that is unique to this declaration.
    pub(crate) fn key(&self) -> String {
        // The source is static: its place stands for it.
        format!("{:p} {} {:?}", self.source, self.entry, self.fragment)
    }
}

/// The buffers of a kernel. [`kernel!`](crate::kernel) makes them.
pub trait Bindings {
    /// The kernel, for any lifetime of its buffers.
    type Kernel;
    /// The declaration.
    fn declaration() -> Declaration;
    /// The buffers and textures in the order of the declaration.
    fn resources(&self) -> Vec<wgpu::BindingResource<'_>>;
}

/// A buffer or a texture of a declaration.
pub trait Resource {
    /// Its binding.
    fn resource(&self) -> wgpu::BindingResource<'_>;
}

impl<T> Resource for crate::Buffer<T> {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        self.raw_buffer().as_entire_binding()
    }
}

impl Resource for crate::Texture {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::TextureView(self.view())
    }
}

/// The type of a field of a declaration.
#[doc(hidden)]
#[macro_export]
macro_rules! field_type {
    (Texture $kind:ty) => { $crate::Texture };
    (Written $kind:ty) => { $crate::Texture };
    ($access:ident $kind:ty) => { $crate::Buffer<$kind> };
}

/// Common to the declarations of kernels and drawings.
#[doc(hidden)]
#[macro_export]
macro_rules! declare {
    ($(#[$attribute:meta])* $visibility:vis struct $kernel:ident in $module:literal ($source:expr),
     $entry:expr, $fragment:expr, $draws:literal, $threads:expr, {
        $($index:literal $name:ident: $access:ident $kind:ty,)*
    }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug)]
        $visibility struct $kernel<'a> {
            $(#[allow(missing_docs)] pub $name: &'a $crate::field_type!($access $kind),)*
        }

        impl $crate::Bindings for $kernel<'_> {
            type Kernel = $kernel<'static>;

            fn declaration() -> $crate::Declaration {
                $crate::Declaration {
                    module: $module,
                    source: $source,
                    entry: $entry,
                    fragment: $fragment,
                    draws: $draws,
                    threads: $threads,
                    bindings: vec![$($crate::Binding {
                        index: $index,
                        name: stringify!($name),
                        access: $crate::Access::$access,
                        layout: <$kind as $crate::Mirror>::layout(),
                    },)*],
                }
            }

            fn resources(&self) -> Vec<$crate::wgpu::BindingResource<'_>> {
                vec![$($crate::Resource::resource(self.$name),)*]
            }
        }
    };
}

/// Declares a kernel: a struct of the buffers that it is bound to. Its workgroups have [`THREADS`](crate::THREADS) threads
/// where it does not say `threads` behind its entry point: `threads (Some(MANY))`, `threads (None)` where a constant of
/// the pipeline chooses.
///
/// ```text
/// kernel! {
///     /// Its purpose.
///     pub struct Name in "module" (LINKED_TEXT), entry "name" {
///         0 step: Read Step,
///         1 positions: Read f32,
///         2 velocities: ReadWrite f32,
///     }
/// }
/// ```
#[macro_export]
macro_rules! kernel {
    ($(#[$attribute:meta])* $visibility:vis struct $kernel:ident in $module:literal ($source:expr), entry $entry:literal {
        $($bindings:tt)*
    }) => {
        $crate::kernel! {
            $(#[$attribute])*
            $visibility struct $kernel in $module ($source), entry $entry, threads (Some($crate::THREADS)) {
                $($bindings)*
            }
        }
    };
    ($(#[$attribute:meta])* $visibility:vis struct $kernel:ident in $module:literal ($source:expr), entry $entry:literal,
     threads ($threads:expr) {
        $($index:literal $name:ident: $access:ident $kind:ty,)*
    }) => {
        $crate::declare! {
            $(#[$attribute])* $visibility struct $kernel in $module ($source), $entry, None, false, $threads, {
                $($index $name: $access $kind,)*
            }
        }
    };
}

/// A compiled kernel; `B` is the type declared by [`kernel!`](crate::kernel), with a static lifetime.
#[derive(Debug)]
pub struct Kernel<B> {
    compiled: Compiled<wgpu::ComputePipeline>,
    bindings: PhantomData<fn(B)>,
}

impl<B: Bindings<Kernel = B>> Kernel<B> {
    /// Compiles a kernel with values for its `override` constants; a device compiles each once.
    ///
    /// # Errors
    /// The driver does not take it, or the device was lost.
    pub fn new(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Self, GpuError> {
        let declaration = B::declaration();
        let key = format!("{} {constants:?}", declaration.key());
        let compiled = gpu.kernels().get(key, || compile(gpu, &declaration, constants))?;
        Ok(Self { compiled, bindings: PhantomData })
    }

    /// Binds a kernel to its buffers.
    ///
    /// # Errors
    /// A buffer does not fit, or the device was lost.
    pub fn bind<C: Bindings<Kernel = B>>(&self, gpu: &Gpu, buffers: &C) -> Result<Bound, GpuError> {
        let group = bind_group(gpu, &self.compiled.layout, buffers)?;
        Ok(Bound { pipeline: self.compiled.pipeline.clone(), group, threads: C::declaration().threads })
    }
}

fn compile(
    gpu: &Gpu,
    declaration: &Declaration,
    constants: &[(&str, f64)],
) -> Result<Compiled<wgpu::ComputePipeline>, GpuError> {
    let Declaration { module, entry, .. } = declaration;
    let made = gpu.ask(module, || {
        let device = gpu.device();
        let (layout, pipeline_layout) = layouts(device, declaration);
        let shader = shader_module(device, declaration);
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(&pipeline_layout),
            module: &shader,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                // Every kernel writes its workgroup memory before it reads it.
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        Compiled { pipeline, layout }
    });
    made.map_err(as_shader_error)
}

/// An error of the driver about a pipeline is an error of the shader.
pub(crate) fn as_shader_error(error: GpuError) -> GpuError {
    match error {
        GpuError::Refused { adapter, what, message } => GpuError::Shader { adapter, module: what, message },
        other => other,
    }
}

pub(crate) fn layouts(
    device: &wgpu::Device,
    declaration: &Declaration,
) -> (wgpu::BindGroupLayout, wgpu::PipelineLayout) {
    let entries: Vec<_> = declaration.bindings.iter().map(|binding| entry_of(binding, declaration)).collect();
    let label = Some(declaration.entry);
    let layout =
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    (layout, pipeline_layout)
}

pub(crate) fn shader_module(device: &wgpu::Device, declaration: &Declaration) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(declaration.module),
        source: wgpu::ShaderSource::Wgsl(declaration.source.into()),
    })
}

pub(crate) fn bind_group<C: Bindings>(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    buffers: &C,
) -> Result<wgpu::BindGroup, GpuError> {
    let declaration = C::declaration();
    let resources = buffers.resources();
    gpu.ask(declaration.entry, || {
        let bindings = declaration.bindings.iter().zip(resources);
        let entries: Vec<_> = bindings
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding: binding.index, resource })
            .collect();
        gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(declaration.entry),
            layout,
            entries: &entries,
        })
    })
}

fn entry_of(binding: &Binding, declaration: &Declaration) -> wgpu::BindGroupLayoutEntry {
    let buffer = |read_only| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let visibility = match (declaration.draws, binding.access) {
        (false, _) => wgpu::ShaderStages::COMPUTE,
        (true, Access::Texture) => wgpu::ShaderStages::FRAGMENT,
        (true, _) => wgpu::ShaderStages::VERTEX_FRAGMENT,
    };
    let ty = match binding.access {
        Access::Read => buffer(true),
        Access::ReadWrite => buffer(false),
        Access::Texture => wgpu::BindingType::Texture {
            sample_type: match binding.layout {
                Layout::Scalar("u32") => wgpu::TextureSampleType::Uint,
                _ => wgpu::TextureSampleType::Float { filterable: false },
            },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        Access::Written => wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: wgpu::TextureFormat::Rgba16Float,
            view_dimension: wgpu::TextureViewDimension::D2,
        },
    };
    wgpu::BindGroupLayoutEntry { binding: binding.index, visibility, ty, count: None }
}

/// A kernel with its buffers, ready to run.
#[derive(Clone, Debug)]
pub struct Bound {
    pub(crate) pipeline: wgpu::ComputePipeline,
    pub(crate) group: wgpu::BindGroup,
    /// Threads of a workgroup; `None` if a constant of the pipeline chose them.
    threads: Option<usize>,
}

impl Bound {
    /// Workgroups for a number of threads; if a constant of the pipeline chose their size, the number of workgroups itself.
    pub fn groups(&self, count: usize) -> [u32; 3] {
        groups(count, self.threads.unwrap_or(1))
    }

    /// The kernel over a number of threads, counted as in [`Bound::groups`].
    pub fn over(self, count: usize) -> (Self, [u32; 3]) {
        let groups = self.groups(count);
        (self, groups)
    }
}

/// Kernels with their buffers and their numbers of workgroups, in order.
pub type Dispatches = Vec<(Bound, [u32; 3])>;

/// Workgroups for a number of threads, in rows of no more than WebGPU's 65,535: the index of a
/// workgroup is `x + y * num_workgroups.x`. At least one: an empty dispatch would leave reports unwritten.
pub fn groups(threads: usize, workgroup_size: usize) -> [u32; 3] {
    const ROW: usize = 65_535;
    let count = threads.div_ceil(workgroup_size).max(1);
    let rows = count.div_ceil(ROW);
    [count.div_ceil(rows) as u32, rows as u32, 1]
}

#[cfg(test)]
mod tests {
    use super::groups;

    #[test]
    fn rows_of_workgroups_cover_every_thread_within_the_limit() {
        for threads in [0, 1, 64, 65, 65_535 * 64, 65_535 * 64 + 1, 65_536 * 64 * 3 + 5, 500_000_000] {
            let [x, y, z] = groups(threads, 64).map(|count| count as usize);
            assert!(x <= 65_535 && y <= 65_535 && x > 0 && y > 0 && z == 1, "{threads}");
            assert!(x * y * 64 >= threads);
            // No more than a row's worth of idle workgroups.
            assert!(x * y <= threads.div_ceil(64).max(1) + y, "{threads}");
        }
    }
}
