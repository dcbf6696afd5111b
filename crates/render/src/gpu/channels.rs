//! A picture as channels: the twin of frame/channels.rs.

use glam::{Vec3, Vec4};
use strandline_gpu::{Bound, Download, Gpu, GpuError, Kernel, Recorder, Texture, wgpu};

use super::GpuRenderer;
use super::codes;
use super::frame::samples;
use super::half::{from_half, to_half};
use super::inputs::Frame;
use super::probe::vectors;
use super::shade::Numbers;
use crate::frame::edges::smooth_edges;
use crate::frame::filter::resolve_linear;
use crate::frame::known::{body_depths, nearest_strands};
use crate::frame::motion::{Before, Motion};
use crate::frame::samples::Samples;
use crate::frame::{
    Stage,
    channels::{BLACK, Known},
};
use crate::{FrameInput, Layers, PictureSettings, RenderError};

/// Kinds of numbers.
const COVERAGE_AND_DEPTH: usize = 0;
const TANGENT: usize = 1;

impl GpuRenderer {
    /// The picture that was drawn last, from the same input, as channels: see [`Layers`]. The strands' light is lost.
    ///
    /// The device draws light, coverage, depths and directions; strands are numbered on the host, from the points and
    /// the body's depths that are on the device.
    pub(super) fn channels(&mut self, input: &FrameInput) -> Result<Layers, RenderError> {
        let settings = self.settings;
        let scale = settings.supersampling as usize;
        let mut found = Samples::default();
        found.resize(
            (settings.width * settings.supersampling) as usize,
            (settings.height * settings.supersampling) as usize,
        );
        self.read_light(&mut found)?;
        self.read_depths(input.camera.near, &mut found)?;
        smooth_edges(&mut found);
        let light = resolve_linear(&found, &settings);
        let bodies = body_depths(&found, scale);
        let points = self.points()?;
        let strands = nearest_strands(&self.drawn_of(&points), input.camera, &found, scale);
        let points = vectors(&points);
        let mut covered = self.with_numbers(input, COVERAGE_AND_DEPTH, &mut found)?;
        let middle = input.middle(self.bounds);
        let depth = -input.camera.view_from_world().transform_point3(middle).z;
        covered.iter_mut().for_each(|hair| hair.y += depth * hair.x);
        let directions = self.with_numbers(input, TANGENT, &mut found)?;
        let motion = Motion::new(self.channels.before.as_ref(), input, &settings);
        let (of_points, body_motions) = (motion.of_points(&points), motion.of_body(&bodies));
        self.channels.before = Some(Before::new(input, points));
        let motions = self.with_motions(input, &of_points, &mut found)?;
        let known = Known { light, covered, directions, bodies, motions, body_motions, strands };
        Ok(known.layers(&settings))
    }

    /// Hair drawn over nothing, with numbers in the place of its light, before a black body.
    fn with_numbers(
        &mut self,
        input: &FrameInput,
        kind: usize,
        found: &mut Samples,
    ) -> Result<Vec<Vec4>, RenderError> {
        if self.channels.numbers.is_none() {
            let compiled = |kind: usize| Kernel::new(&self.gpu, &[("NUMBERS", kind as f64)]);
            self.channels.numbers = Some([compiled(COVERAGE_AND_DEPTH)?, compiled(TANGENT)?]);
        }
        let (Some(kernels), Some(strands)) = (&self.channels.numbers, &self.strands) else {
            unreachable!("drawn before");
        };
        let buffers =
            Numbers { frame: &self.groom.frame, points: &strands.points, radiances: &strands.radiances };
        let numbers = kernels[kind].bind(&self.gpu, &buffers)?;
        self.drawn_flat(input, Some(numbers), found)
    }

    /// Hair drawn so with its displacement.
    fn with_motions(
        &self,
        input: &FrameInput,
        motions: &[Vec3],
        found: &mut Samples,
    ) -> Result<Vec<Vec4>, RenderError> {
        let Some(strands) = &self.strands else { unreachable!("drawn before") };
        let halves: Vec<[u32; 2]> =
            motions.iter().map(|motion| [to_half(motion.x) | to_half(motion.y) << 16, 0]).collect();
        strands.radiances.write(&halves)?;
        self.drawn_flat(input, None, found)
    }

    /// Hair drawn over nothing as flat ribbons, before a black body, in the light that its points have or that a
    /// kernel gives them.
    fn drawn_flat(
        &self,
        input: &FrameInput,
        numbers: Option<Bound>,
        found: &mut Samples,
    ) -> Result<Vec<Vec4>, RenderError> {
        let Some(stages) = &self.stages else { unreachable!("drawn before") };
        let settings = PictureSettings { transparent: true, ..self.settings };
        let input = FrameInput { body_look: &BLACK, lights: &[], ..*input };
        let scene = self.scene(&input, &settings, 1.0);
        let mut flat = Frame::new(&scene);
        flat.kinds |= codes::FLAT;
        self.groom.frame.write(&[flat])?;
        let points = scene.strand_count() * scene.curve_points();
        self.gpu.ask("channels", || {
            let mut recorder = Recorder::new(&self.gpu, None);
            if let Some(numbers) = numbers {
                recorder.stage(Stage::Shade.name(), &[numbers.over(points)]);
            }
            samples(&mut recorder, &scene, &self.held(stages));
            self.gpu.queue().submit([recorder.finish(|_| ())]);
        })?;
        self.read_light(found)?;
        Ok(resolve_linear(found, &settings))
    }

    /// Colours of the samples that were drawn last.
    fn read_light(&self, found: &mut Samples) -> Result<(), RenderError> {
        let texels: Vec<[u32; 2]> = texels(&self.gpu, &self.targets.samples, wgpu::TextureAspect::All)?;
        let width = found.width();
        for (at, &[xy, zw]) in texels.iter().enumerate() {
            let index = found.index(at % width, at / width);
            found.colors[index] = Vec4::from([xy, xy >> 16, zw, zw >> 16].map(from_half));
        }
        Ok(())
    }

    /// Depths of the body in the samples that were drawn last.
    fn read_depths(&self, near: f32, found: &mut Samples) -> Result<(), RenderError> {
        let texels: Vec<f32> = texels(&self.gpu, &self.targets.depth, wgpu::TextureAspect::DepthOnly)?;
        let width = found.width();
        for (at, depth) in texels.iter().enumerate() {
            let index = found.index(at % width, at / width);
            found.inverse_depths[index] = depth / near;
        }
        Ok(())
    }
}

/// Texels of a texture, shape `[row][column]`.
fn texels<T: bytemuck::Pod>(
    gpu: &Gpu,
    texture: &Texture,
    aspect: wgpu::TextureAspect,
) -> Result<Vec<T>, GpuError> {
    let [width, height] = texture.size();
    let own_bytes = width as usize * size_of::<T>();
    let row_bytes = own_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let download = Download::new(gpu, row_bytes as u64 * u64::from(height))?;
    let submission = gpu.ask("channels", || {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row_bytes as u32),
            rows_per_image: None,
        };
        let commands = Recorder::new(gpu, None).finish(|encoder| {
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo { aspect, ..texture.raw().as_image_copy() },
                wgpu::TexelCopyBufferInfo { buffer: download.raw(), layout },
                texture.raw().size(),
            );
        });
        gpu.queue().submit([commands])
    })?;
    download.read(Some(submission), |bytes| {
        let rows = bytes.chunks_exact(row_bytes);
        rows.flat_map(|row| bytemuck::pod_collect_to_vec::<u8, T>(&row[..own_bytes])).collect()
    })
}
