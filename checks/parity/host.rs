//! Pictures in a host's own texture.

use strandline_gpu::{Download, Gpu, Texture, wgpu};
use strandline_groom::Style;
use strandline_render::gpu::GpuRenderer;
use strandline_render::{FrameInput, Picture, PictureSettings};

use crate::picture::{Both, drawn_on_gpu};

/// A host's own texture, drawn into and read back.
fn drawn_to_host(
    gpu: &Gpu,
    renderer: &mut GpuRenderer,
    input: &FrameInput,
    format: wgpu::TextureFormat,
) -> Picture {
    let (width, height) = (128, 64);
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    renderer.draw_to(input, None, &texture.create_view(&Default::default()), format).unwrap();
    let download = Download::new(gpu, u64::from(4 * width * height)).unwrap();
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: download.raw(), layout },
        texture.size(),
    );
    let submission = gpu.queue().submit([encoder.finish()]);
    let pixels = download.read(Some(submission), |bytes| {
        let (texels, _) = bytes.as_chunks::<4>();
        texels.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect()
    });
    Picture { width, height, pixels: pixels.unwrap(), alpha: None }
}

#[test]
fn resolve_draws_into_a_hosts_texture_of_either_kind() {
    let mut both = Both::new(Style::Bob, 8);
    both.settings = PictureSettings::sized(128, 64);
    let positions = both.positions();
    let Some(mut renderer) = drawn_on_gpu(&both, &positions, true) else { return };
    let gpu = renderer.gpu().clone();
    let input = both.input(&positions);
    let own = renderer.draw(&input).unwrap().0;
    for format in [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba8UnormSrgb] {
        let host = drawn_to_host(&gpu, &mut renderer, &input, format);
        // The order of equal depths and of sums may differ from frame to frame, and so may the
        // rounding of the texture's own sRGB: a step of 255 here and there.
        let off = own.pixels.iter().zip(&host.pixels).filter(|(one, other)| one.abs_diff(**other) > 2);
        assert!(off.count() * 200 <= own.pixels.len(), "{format:?}");
    }
    renderer.set_picture(&PictureSettings::sized(64, 64)).unwrap();
    let texture = Texture::new(&gpu, "of the host", [128, 64], wgpu::TextureFormat::Rgba8Unorm).unwrap();
    let error = renderer
        .draw_to(&input, None, texture.view(), wgpu::TextureFormat::Rgba8Unorm)
        .unwrap_err()
        .to_string();
    assert!(error.contains("128 x 64"), "{error}");
}
