//! Wide strands are drawn round: bright in the middle and dark at their edges, and as bright altogether as thin ones;
//! whole pictures on both backends.

use glam::Vec3;
use strandline_body::BodyFrame;
use strandline_checks::{On, law};
use strandline_groom::{Groom, Guides};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, Environment, FrameInput, LevelOfDetail, Look, PictureSettings, Renderer, ToneMap,
};

use crate::linear::{Linear, channel};
use crate::terms::plain;

const SIZE: u32 = 192;
/// Distance of the eye \[m\], and the visible height of the plane through the strand \[m\].
const DISTANCE: f32 = 5.0;
const SEEN: f32 = 0.26;

/// Light and coverage of the pixels of a strand of a width in pixels, at an angle \[degrees\] from upright: white hair in
/// white surroundings, whose light is the same everywhere.
fn pixels(on: &On, width: f32, angle: f32) -> (Vec<f32>, Vec<f32>) {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let mut groom = Groom::empty(width * SEEN / SIZE as f32);
    let way = Vec3::new(sine, cosine, 0.0) * 0.1;
    groom.push((0..8).map(|point| way * (point as f32 / 3.5 - 1.0)));
    let guides = Guides::resample(&groom, 8).unwrap();
    let even = Environment { sky: Vec3::ONE, ground: Vec3::ONE };
    let look = Look { tip_width: 1.0, environment: even, ..plain(Vec3::splat(0.5)) };
    let camera = Camera {
        position: Vec3::new(0.0, 0.0, DISTANCE),
        target: Vec3::ZERO,
        field_of_view: 2.0 * (0.5 * SEEN / DISTANCE).atan().to_degrees(),
        ..Camera::default()
    };
    let settings = PictureSettings {
        layers: true,
        transparent: true,
        supersampling: 1,
        tone_map: ToneMap::Off,
        ..PictureSettings::sized(SIZE, SIZE)
    };
    let input = FrameInput {
        positions: guides.positions(),
        body: &BodyFrame::REST,
        camera: &camera,
        look: &look,
        body_look: &BodyLook::default(),
        lights: &[],
        level_of_detail: &LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() },
    };
    let (_, report) = match on {
        On::Cpu => Renderer::new(&guides, None, &settings).unwrap().draw(&input).unwrap(),
        On::Gpu(gpu) => GpuRenderer::new(gpu, &guides, None, &settings).unwrap().draw(&input).unwrap(),
    };
    let layers = report.layers.unwrap();
    let mask = channel(&layers, "mask.hair").to_vec();
    (Linear::of(&layers).pixels.iter().map(|pixel| pixel.x).collect(), mask)
}

law! {
    fn a_wide_strand_is_round_and_as_bright_as_a_thin_one(on) {
        for angle in [0.0, 23.0, 45.0, 80.0] {
            let mean = |(light, covered): &(Vec<f32>, Vec<f32>)| light.iter().sum::<f32>() / covered.iter().sum::<f32>();
            let thin = mean(&pixels(on, 1.2, angle));
            for width in [2.5, 4.0, 9.0] {
                let wide = pixels(on, width, angle);
                assert!((mean(&wide) / thin - 1.0).abs() < 0.01, "{width} at {angle}: {} {thin}", mean(&wide));
                // Wholly covered samples only: coverage in channels is flat.
                let shown = wide.0.iter().zip(&wide.1).filter(|(_, covered)| **covered > 0.99);
                let (least, most) = shown
                    .map(|(light, covered)| light / covered / thin)
                    .fold((f32::MAX, 0.0_f32), |(least, most), light| (least.min(light), most.max(light)));
                if width == 9.0 {
                    assert!(least < 0.8 && (1.2..1.35).contains(&most), "{angle}: {least} to {most}");
                }
            }
        }
        // Thin strands are flat.
        let (light, covered) = pixels(on, 1.2, 23.0);
        let shown = light.iter().zip(&covered).filter(|(_, covered)| **covered > 0.1);
        let all: Vec<f32> = shown.map(|(light, covered)| light / covered).collect();
        assert!(all.iter().all(|light| (light / all[0] - 1.0).abs() < 0.01), "{all:?}");
    }
}
