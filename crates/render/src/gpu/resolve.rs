//! `resolve`: from samples to pixels, in linear light; then exposure, tone map, sRGB.

use strandline_gpu::{BoundDrawing, Download, Drawing, Gpu, GpuError, Output, Texture, Timer, drawing, wgpu};

use super::buffers::{Groom, Targets};
use super::inputs::Frame;
use crate::{Picture, PictureSettings};

drawing! {
    /// One triangle over the whole picture.
    pub(super) struct Resolve in "resolve" (super::linked::RESOLVE),
    vertex "resolve_vertex", fragment Some("resolve"), {
        0 frame: Read Frame,
        2 depths: Texture f32,
        7 samples: Texture f32,
    }
}

/// Format of the renderer's own pictures.
pub(super) const PICTURE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The stage for targets of one format, bound to the samples.
pub(super) struct ToFormat {
    pub format: wgpu::TextureFormat,
    drawing: Drawing<Resolve<'static>>,
    pub bound: BoundDrawing,
}

impl ToFormat {
    pub fn new(
        gpu: &Gpu,
        format: wgpu::TextureFormat,
        groom: &Groom,
        targets: &Targets,
    ) -> Result<Self, GpuError> {
        let output = Output { color: Some((format, None)), depth: None };
        let linear = if format.is_srgb() { 1.0 } else { 0.0 };
        let drawing = Drawing::new(gpu, &output, &[("LINEAR", linear)])?;
        let bound = drawing.bind(gpu, &buffers(groom, targets))?;
        Ok(Self { format, drawing, bound })
    }

    /// Binds the stage to other samples.
    pub fn bind(&self, gpu: &Gpu, groom: &Groom, targets: &Targets) -> Result<BoundDrawing, GpuError> {
        self.drawing.bind(gpu, &buffers(groom, targets))
    }
}

/// Buffers that the stage reads.
fn buffers<'a>(groom: &'a Groom, targets: &'a Targets) -> Resolve<'a> {
    Resolve { frame: &groom.frame, depths: &targets.depth, samples: &targets.samples }
}

/// A picture on the device and its way back.
pub(super) struct Own {
    pub texture: Texture,
    pub download: Download,
    row_bytes: u32,
}

impl Own {
    pub fn new(gpu: &Gpu, settings: &PictureSettings) -> Result<Self, GpuError> {
        let row_bytes = (4 * settings.width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row_bytes) * u64::from(settings.height);
        Ok(Self {
            texture: Texture::new(gpu, "picture", [settings.width, settings.height], PICTURE)?,
            download: Download::new(gpu, bytes + Timer::BYTES)?,
            row_bytes,
        })
    }

    fn marks_offset(&self) -> u64 {
        u64::from(self.row_bytes) * u64::from(self.texture.size()[1])
    }

    /// Records the copy of the picture and of the times of the stages.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, timer: Option<&Timer>) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.row_bytes),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.texture.raw().as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: self.download.raw(), layout },
            self.texture.raw().size(),
        );
        if let Some(timer) = timer {
            timer.resolve(encoder, self.download.raw(), self.marks_offset());
        }
    }

    /// Waits for the picture of a submission; returns the seconds of the stages.
    pub fn read(
        &self,
        submission: wgpu::SubmissionIndex,
        timer: Option<&Timer>,
        transparent: bool,
        picture: &mut Picture,
    ) -> Result<Vec<(&'static str, f64)>, GpuError> {
        let [width, height] = self.texture.size();
        let offset = self.marks_offset() as usize;
        self.download.read(Some(submission), |bytes| {
            picture.width = width;
            picture.height = height;
            picture.pixels.clear();
            let mut alpha = picture.alpha.take().filter(|_| transparent).unwrap_or_default();
            alpha.clear();
            for row in bytes[..offset].chunks_exact(self.row_bytes as usize) {
                let (pixels, _) = row[..4 * width as usize].as_chunks::<4>();
                picture.pixels.extend(pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]));
                if transparent {
                    alpha.extend(pixels.iter().map(|&[.., opacity]| opacity));
                }
            }
            picture.alpha = transparent.then_some(alpha);
            let marks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes[offset..]);
            timer.map(|timer| timer.seconds(&marks)).unwrap_or_default()
        })
    }
}
