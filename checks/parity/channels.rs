//! Linear light and the further channels of pictures, on both backends.

use std::sync::Arc;

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::gpu;
use strandline_groom::Style;
use strandline_render::gpu::GpuRenderer;
use strandline_render::{Layers, Light, LightKind, PictureSettings, Renderer};

use crate::picture::Both;

/// Both backends' channels, the CPU's first.
fn channels(both: &Both, body: bool) -> Option<[Arc<Layers>; 2]> {
    let (positions, mesh) = (both.positions(), body.then_some(&both.mesh));
    let settings = PictureSettings { layers: true, ..both.settings };
    let input = both.input(&positions);
    let mut on_gpu = GpuRenderer::new(&gpu()?, &both.guides, mesh, &settings).unwrap();
    let mut on_cpu = Renderer::new(&both.guides, mesh, &settings).unwrap();
    let found = [on_cpu.draw(&input).unwrap().1, on_gpu.draw(&input).unwrap().1];
    Some(found.map(|report| report.layers.unwrap()))
}

fn channel<'a>(layers: &'a Layers, name: &str) -> &'a [f32] {
    &layers.channels.iter().find(|(own, _)| own == name).unwrap().1
}

/// Mean distance of channels of one name, over pixels that are kept, and the mean size of the first.
fn apart(pair: &[Arc<Layers>; 2], name: &str, keep: impl Fn(usize) -> bool) -> [f32; 2] {
    let [one, other] = [0, 1].map(|which| channel(&pair[which], name));
    let kept: Vec<usize> = (0..one.len()).filter(|&at| keep(at)).collect();
    assert!(kept.len() > 1000, "{} pixels for {name}", kept.len());
    let mean =
        |value: &dyn Fn(usize) -> f32| kept.iter().map(|&at| value(at)).sum::<f32>() / kept.len() as f32;
    [mean(&|at| (one[at] - other[at]).abs()), mean(&|at| one[at].abs())]
}

/// Mean distance of the light of both over its mean.
fn light_apart(pair: &[Arc<Layers>; 2]) -> f32 {
    let [off, all] = ["R", "G", "B"]
        .map(|name| apart(pair, name, |_| true))
        .into_iter()
        .fold([0.0; 2], |[off, all], [more, whole]| [off + more, all + whole]);
    off / all
}

/// Allowed difference of the two: skin is lit once per pixel on the CPU and once per sample on a GPU. Found
/// 0.009 with a body and 7e-4, the rounding of half floats, without.
const LIGHT: f32 = 0.02;
/// The same in light with soft shadows: found 0.004.
const SOFT_LIGHT: f32 = 0.006;

#[test]
fn channels_agree_pixel_by_pixel() {
    for (body, supersampling) in [(true, 2), (false, 1)] {
        let mut both = Both::new(Style::Wavy, 12);
        both.settings = PictureSettings { supersampling, ..PictureSettings::sized(203, 177) };
        let Some(pair) = channels(&both, body) else { return };
        assert_eq!(pair[0].channels.len(), pair[1].channels.len());
        let mask = channel(&pair[0], "mask.hair");
        let hair = |at: usize| mask[at] > 0.5;
        let light = light_apart(&pair);
        assert!(light <= LIGHT, "light: {light}");
        for name in ["A", "mask.hair"] {
            let [off, _] = apart(&pair, name, |_| true);
            // Each ribbon that is blended over others rounds to half floats, 2.4e-4 of the value: found 2e-4.
            assert!(off <= 1e-3, "{name}: {off}");
        }
        for name in ["tangent.X", "tangent.Y", "tangent.Z"] {
            let [off, _] = apart(&pair, name, hair);
            // As above, and colours of points as half floats: found 5e-4.
            assert!(off <= 2e-3, "{name}: {off}");
        }
        let [off, whole] = apart(&pair, "depth.Z", hair);
        // Less that of the middle of the hair, half floats hold depths within 20 cm to 0.1 mm: found 0.06 mm.
        assert!(off <= 5e-4 && whole > 0.5, "depth: {off} m of {whole}");
        let [one, other] = [0, 1].map(|which| channel(&pair[which], "strand.id"));
        let different = one.iter().zip(other).filter(|(one, other)| one != other).count();
        let known = one.iter().filter(|&&strand| strand > 0.0).count();
        // Of two strands at the same distance to the last bit either may be named.
        assert!(different * 100 <= known && known > 1000, "{different} of {known} strands");
    }
}

#[test]
fn channels_notice_hair_elsewhere_and_other_light() {
    let both = Both::new(Style::Bob, 8);
    let Some([on_cpu, _]) = channels(&both, true) else { return };
    let mut moved = Both::new(Style::Bob, 8);
    moved.body = moved.body.carried_by(&Pose { translation: Vec3::Z * 0.01, ..Pose::IDENTITY });
    let mut dim = Both::new(Style::Bob, 8);
    dim.lights.truncate(1);
    let Some([_, moved]) = channels(&moved, true) else { return };
    let Some([_, dim]) = channels(&dim, true) else { return };
    let mask = channel(&on_cpu, "mask.hair").to_vec();
    let [off, _] = apart(&[Arc::clone(&on_cpu), moved], "depth.Z", |at| mask[at] > 0.5);
    assert!(off > 5e-3, "{off} m");
    assert!(light_apart(&[on_cpu, dim]) > 10.0 * LIGHT);
}

/// Long hair in one light before the head, of a kind.
fn in_light(kind: LightKind) -> Both {
    let mut both = Both::new(Style::Long, 12);
    let Light { position, target, .. } = both.lights[0];
    // It faces a place beside the head, so that less reaches the head than shines straight on.
    let target = target + Vec3::X * 0.9;
    // Places with and without shadows of their own, of sides that differ.
    let front = Light { kind, width: 1.8, height: 0.2, samples: 2, position, target, ..Light::default() };
    let side = Vec3::new(1.4, 0.3, -0.2);
    both.lights =
        vec![front, Light { position: side, samples: 3, shadow: false, width: 0.5, intensity: 0.3, ..front }];
    both
}

#[test]
fn lights_with_an_area_light_alike() {
    let kinds = [LightKind::Rectangle, LightKind::Disc, LightKind::Point];
    let drawn: Option<Vec<_>> = kinds.iter().map(|kind| channels(&in_light(*kind), true)).collect();
    let Some(drawn) = drawn else { return };
    for (kind, pair) in kinds.iter().zip(&drawn).take(2) {
        let light = light_apart(pair);
        assert!(light <= SOFT_LIGHT, "{kind:?}: {light}");
        // A light of the other kind, and one without an area, are noticed.
        for (other, [_, wrong]) in kinds.iter().zip(&drawn).filter(|(other, _)| *other != kind) {
            let light = light_apart(&[Arc::clone(&pair[0]), Arc::clone(wrong)]);
            assert!(light > 2.0 * SOFT_LIGHT, "{kind:?} as {other:?}: {light}");
        }
    }
}
