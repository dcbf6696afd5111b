//! Opacity maps: hair counts to the layer behind the first hair that it lies in.

use glam::Vec3;
use strandline_body::BodyFrame;
use strandline_checks::{On, law};
use strandline_groom::{Groom, Guides};
use strandline_render::cpu::{opacity_depth, opacity_layers};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, FrameInput, LevelOfDetail, Light, LightKind, Look, PictureSettings, Shadow,
};
use strandline_render::{Shadows, Strands};

use crate::strands::line;

/// Hairs of a sheet, and how far they lie apart \[m\]: twice their width.
const HAIRS: usize = 500;
const APART: f32 = 1e-4;

/// Level sheets of parallel hairs 5 cm long, so far \[m\] below the plane y = 0 each.
fn sheets(depths: &[f32]) -> Strands {
    let hair = |depth: f32, index: usize| {
        let start = Vec3::new(index as f32 * APART, -depth, 0.0);
        line(start, start + Vec3::Z * 0.05, 3)
    };
    let lines: Vec<_> =
        depths.iter().flat_map(|&depth| (0..HAIRS).flat_map(move |index| hair(depth, index))).collect();
    let mut strands = Strands::default();
    strands.resize(HAIRS * depths.len(), 1, 4);
    strands.positions = lines;
    strands.widths.fill(0.5 * APART);
    strands
}

/// Shadows of strands under a sun straight above.
fn shadows(on: &On, strands: &Strands, shadow: Shadow) -> Shadows {
    let light =
        Light { kind: LightKind::Directional, position: Vec3::Y, target: Vec3::ZERO, ..Light::default() };
    let lights = std::slice::from_ref(&light);
    match on {
        On::Cpu => {
            let mut shadows = Shadows::default();
            opacity_depth(strands, None, lights, Vec3::ZERO, &shadow, &mut shadows);
            opacity_layers(strands, &mut shadows);
            shadows
        }
        On::Gpu(gpu) => {
            // Any guides: the strands take their place.
            let mut groom = Groom::empty(8e-5);
            groom.push(line(Vec3::ZERO, Vec3::NEG_Y * 0.1, 3));
            let guides = Guides::resample(&groom, 4).unwrap();
            let mut renderer = GpuRenderer::new(gpu, &guides, None, &PictureSettings::sized(16, 16)).unwrap();
            let input = FrameInput {
                positions: guides.positions(),
                body: &BodyFrame::REST,
                camera: &Camera::front(),
                look: &Look { follow_strands: 1, shadow, ..Look::thesis() },
                body_look: &BodyLook::default(),
                lights,
                level_of_detail: &LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() },
            };
            renderer.shadows_of(strands, &input).unwrap()
        }
    }
}

law! {
    fn hair_counts_to_the_layer_that_it_lies_in(on) {
        let shadow = Shadow { layers: [0.01, 0.03, 0.07], ..Shadow::default() };
        // One sheet in each layer behind the first hair, near the end of the layer.
        let strands = sheets(&[0.0, 0.008, 0.025, 0.06]);
        let shadows = shadows(on, &strands, shadow);
        let map = shadows.map(0).unwrap();
        // Each sheet is half open. At the end of a layer all of it counts, and the next layer does not.
        for (depth, expected) in shadow.layers.into_iter().zip([1.0, 1.5, 2.0]) {
            let places = (0..400).map(|index| Vec3::new(0.005 + index as f32 * 1e-4, -depth, 0.025));
            let found = places.map(|place| map.crossings(place)).sum::<f32>() / 400.0;
            // Texels hold up to a third more or less hair; the mean of 400 places leaves 2 %.
            assert!((found / expected - 1.0).abs() < 0.05, "{found} hairs before {depth} m, expected {expected}");
        }
    }
}
