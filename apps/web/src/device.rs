//! A device of the browser, and the canvas that it draws into.

#![allow(unsafe_code)] // written by wasm_bindgen

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use strandline::device::{Gpu, Wanted, wgpu};
use wasm_bindgen::prelude::*;

/// Format of the canvas: the bytes of a picture.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A device of the browser with a canvas.
#[wasm_bindgen]
pub struct Device {
    gpu: Gpu,
    surface: wgpu::Surface<'static>,
    size: Cell<[u32; 2]>,
    pending: Arc<AtomicU32>,
}

#[wasm_bindgen]
impl Device {
    /// Asks the browser for a device that draws into a canvas.
    pub async fn request(canvas: wgpu::web_sys::OffscreenCanvas) -> Result<Device, JsError> {
        let refused = |message: String| JsError::new(&message);
        let gpu = Gpu::request(Wanted::Any).await.map_err(|error| refused(error.to_string()))?;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let target = wgpu::SurfaceTarget::OffscreenCanvas(canvas);
        let surface = instance.create_surface(target).map_err(|error| refused(error.to_string()))?;
        Ok(Self { gpu, surface, size: Cell::default(), pending: Arc::default() })
    }

    /// Pictures that were submitted and that the device has not finished.
    pub fn pending(&self) -> u32 {
        self.pending.load(Relaxed)
    }

    /// Destroys the device of the browser, as its loss does.
    pub fn lose(&self) {
        self.gpu.device().destroy();
    }
}

impl Device {
    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The texture of the canvas in a size \[pixel\], for one picture; `None` where the device gives none.
    pub(crate) fn target(&self, size: [u32; 2]) -> Option<(wgpu::SurfaceTexture, wgpu::TextureFormat)> {
        if self.size.get() != size {
            let settings = wgpu::SurfaceConfiguration {
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                format: FORMAT,
                color_space: wgpu::SurfaceColorSpace::Auto,
                width: size[0],
                height: size[1],
                present_mode: wgpu::PresentMode::Fifo,
                desired_maximum_frame_latency: 2,
                alpha_mode: wgpu::CompositeAlphaMode::Opaque,
                view_formats: Vec::new(),
            };
            self.surface.configure(self.gpu.device(), &settings);
            self.size.set(size);
        }
        match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(texture)
            | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => Some((texture, FORMAT)),
            _ => None,
        }
    }

    /// Counts the work that was submitted until now as a picture on its way.
    pub(crate) fn watch(&self) {
        self.pending.fetch_add(1, Relaxed);
        let pending = Arc::clone(&self.pending);
        self.gpu.queue().on_submitted_work_done(move || _ = pending.fetch_sub(1, Relaxed));
    }
}
