//! Kernels: one declaration from which the pipeline's layout, the bind group and the check against
//! the linked shader derive.

use std::marker::PhantomData;

use crate::gpu::Compiled;
use crate::{Gpu, GpuError, Layout, Timer};

/// How a kernel uses a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// `var<storage, read>`.
    Read,
    /// `var<storage, read_write>`.
    ReadWrite,
}

/// One buffer of a kernel.
#[derive(Clone, Debug)]
pub struct Binding {
    /// Its number in group 0.
    pub index: u32,
    /// The variable's name.
    pub name: &'static str,
    /// How it is used.
    pub access: Access,
    /// What an element is.
    pub layout: Layout,
}

/// What is known of a kernel without a device.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// The shader module.
    pub module: &'static str,
    /// Its linked text.
    pub source: &'static str,
    /// The entry point.
    pub entry: &'static str,
    /// Its buffers.
    pub bindings: Vec<Binding>,
}

/// The buffers of a kernel. [`kernel!`](crate::kernel) makes them.
pub trait Bindings {
    /// The kernel, whatever the lifetime of its buffers.
    type Kernel;
    /// The declaration.
    fn declaration() -> Declaration;
    /// The buffers in the order of the declaration.
    fn buffers(&self) -> Vec<&wgpu::Buffer>;
}

/// Declares a kernel: a struct of the buffers that it is bound to.
///
/// ```text
/// kernel! {
///     /// What it does.
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
        $($index:literal $name:ident: $access:ident $kind:ty,)*
    }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug)]
        $visibility struct $kernel<'a> {
            $(#[allow(missing_docs)] pub $name: &'a $crate::Buffer<$kind>,)*
        }

        impl $crate::Bindings for $kernel<'_> {
            type Kernel = $kernel<'static>;

            fn declaration() -> $crate::Declaration {
                $crate::Declaration {
                    module: $module,
                    source: $source,
                    entry: $entry,
                    bindings: vec![$($crate::Binding {
                        index: $index,
                        name: stringify!($name),
                        access: $crate::Access::$access,
                        layout: <$kind as $crate::Mirror>::layout(),
                    },)*],
                }
            }

            fn buffers(&self) -> Vec<&$crate::wgpu::Buffer> {
                vec![$(self.$name.raw(),)*]
            }
        }
    };
}

/// A compiled kernel; `B` is what [`kernel!`](crate::kernel) declared, with a static lifetime.
#[derive(Debug)]
pub struct Kernel<B> {
    compiled: Compiled,
    bindings: PhantomData<fn(B)>,
}

impl<B: Bindings<Kernel = B>> Kernel<B> {
    /// Compiles a kernel with values for its `override` constants; a device compiles each once.
    ///
    /// # Errors
    /// The driver does not take it, or the device was lost.
    pub fn new(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Self, GpuError> {
        let declaration = B::declaration();
        // The text is static: its place stands for it.
        let key = format!("{:p} {} {constants:?}", declaration.source, declaration.entry);
        let compiled = gpu.kernel(key, || compile(gpu, &declaration, constants))?;
        Ok(Self { compiled, bindings: PhantomData })
    }

    /// Binds a kernel to its buffers.
    ///
    /// # Errors
    /// A buffer does not fit, or the device was lost.
    pub fn bind<C: Bindings<Kernel = B>>(&self, gpu: &Gpu, buffers: &C) -> Result<Bound, GpuError> {
        let declaration = B::declaration();
        let raw = buffers.buffers();
        let group = gpu.guarded(declaration.entry, || {
            let entries: Vec<_> = declaration
                .bindings
                .iter()
                .zip(&raw)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding: binding.index,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(declaration.entry),
                layout: &self.compiled.layout,
                entries: &entries,
            })
        })?;
        Ok(Bound { pipeline: self.compiled.pipeline.clone(), group })
    }
}

fn compile(gpu: &Gpu, declaration: &Declaration, constants: &[(&str, f64)]) -> Result<Compiled, GpuError> {
    let Declaration { module, source, entry, bindings } = declaration;
    let made = gpu.guarded(module, || {
        let device = gpu.device();
        let entries: Vec<_> = bindings.iter().map(entry_of).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(entry),
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(entry),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(module),
            source: wgpu::ShaderSource::Wgsl((*source).into()),
        });
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
    made.map_err(|error| match error {
        GpuError::Refused { adapter, what, message } => GpuError::Shader { adapter, module: what, message },
        other => other,
    })
}

fn entry_of(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let ty = match binding.access {
        Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
        Access::ReadWrite => wgpu::BufferBindingType::Storage { read_only: false },
    };
    wgpu::BindGroupLayoutEntry {
        binding: binding.index,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    }
}

/// A kernel with its buffers, ready to run.
#[derive(Clone, Debug)]
pub struct Bound {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
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
    /// what those before it wrote.
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

/// Workgroups for a number of threads, in rows of no more than WebGPU's 65,535: the index of a
/// workgroup is `x + y * num_workgroups.x`. Never none: an empty dispatch would leave reports unwritten.
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
