use crate::{Gpu, GpuError};

/// A two-dimensional texture on the device, with its memory counted.
#[derive(Debug)]
pub struct Texture {
    gpu: Gpu,
    raw: wgpu::Texture,
    view: wgpu::TextureView,
    bytes: u64,
}

impl Texture {
    /// A texture of a size in texels, to be drawn into.
    ///
    /// # Errors
    /// It is larger than WebGPU's default limits allow, or the device has no memory left.
    pub fn new(
        gpu: &Gpu,
        name: &'static str,
        size: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        Self::for_uses(gpu, name, size, format, wgpu::TextureUsages::empty())
    }

    /// As [`Texture::new`], a texture that kernels write too: see [`Access::Written`](crate::Access::Written).
    ///
    /// # Errors
    /// As [`Texture::new`].
    pub fn written(
        gpu: &Gpu,
        name: &'static str,
        size: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        Self::for_uses(gpu, name, size, format, wgpu::TextureUsages::STORAGE_BINDING)
    }

    fn for_uses(
        gpu: &Gpu,
        name: &'static str,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        more: wgpu::TextureUsages,
    ) -> Result<Self, GpuError> {
        let limit = u64::from(wgpu::Limits::default().max_texture_dimension_2d);
        let needed = u64::from(width.max(height));
        if needed > limit {
            let what = format!("a texture as wide or high in texels for {name}");
            return Err(GpuError::Limit { adapter: gpu.name(), what, needed, limit });
        }
        let texel = u64::from(format.block_copy_size(None).unwrap_or(4));
        let bytes = u64::from(width) * u64::from(height) * texel;
        gpu.take_memory(name, bytes)?;
        let made = gpu.ask(name, || {
            let raw = gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some(name),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC
                    | more,
                view_formats: &[],
            });
            let view = raw.create_view(&wgpu::TextureViewDescriptor::default());
            (raw, view)
        });
        match made {
            Ok((raw, view)) => Ok(Self { gpu: gpu.clone(), raw, view, bytes }),
            Err(error) => {
                gpu.give_memory_back(bytes);
                Err(error)
            }
        }
    }

    /// The whole of it.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The texture itself.
    pub fn raw(&self) -> &wgpu::Texture {
        &self.raw
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.raw.width(), self.raw.height()]
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        self.gpu.give_memory_back(self.bytes);
    }
}
