//! Whole pictures on both backends.

use glam::Vec3;
use strandline_body::Mannequin;
use strandline_checks::flip::compare;
use strandline_checks::gpu;
use strandline_groom::Style;
use strandline_render::gpu::GpuRenderer;
use strandline_render::{Camera, Light, Look, Picture, PictureSettings, Renderer, ToneMap};

use crate::picture::Both;

/// Both backends' pictures.
fn pictures(both: &Both, body: bool) -> Option<[Picture; 2]> {
    let on_gpu = on_gpu(both, body)?;
    let (positions, mesh) = (both.positions(), body.then_some(&both.mesh));
    let mut on_cpu = Renderer::new(&both.guides, mesh, &both.settings).unwrap();
    Some([on_cpu.draw(&both.input(&positions)).unwrap().0, on_gpu])
}

fn on_gpu(both: &Both, body: bool) -> Option<Picture> {
    let (positions, mesh) = (both.positions(), body.then_some(&both.mesh));
    let mut renderer = GpuRenderer::new(&gpu()?, &both.guides, mesh, &both.settings).unwrap();
    Some(renderer.draw(&both.input(&positions)).unwrap().0)
}

/// Allowed difference of the two backends: skin is lit once per pixel on the CPU and once per sample on a
/// GPU, and blending rounds to half floats. Long hair on a head: a mean of 0.0074 found on a software adapter, of 0.0105
/// on an H200.
pub const MEAN: f32 = 0.012;
const ONE_IN_A_HUNDRED: f32 = 0.1;

fn check_pictures(name: &str, both: &Both, body: bool) {
    let Some([on_cpu, on_gpu]) = pictures(both, body) else { return };
    compare(&on_gpu, &on_cpu, MEAN, ONE_IN_A_HUNDRED).unwrap_or_else(|message| panic!("{name}: {message}"));
}

#[test]
fn draw_agrees_with_and_without_a_body() {
    check_pictures("long hair on a head", &Both::new(Style::Long, 12), true);
    check_pictures("curls alone", &Both::new(Style::Curly, 24), false);
}

#[test]
fn draw_agrees_on_a_face_with_eyes() {
    let mut both = Both::new(Style::Pixie, 12);
    both.mesh = Mannequin::new().figure();
    let face = both.body.world_from_head().point(Vec3::new(0.0, -0.03, 0.08));
    let ahead = both.body.world_from_head().direction(Vec3::Z);
    both.camera = Camera { position: face + 0.45 * ahead, target: face, ..both.camera };
    let Some([on_cpu, face]) = pictures(&both, true) else { return };
    compare(&face, &on_cpu, MEAN, ONE_IN_A_HUNDRED).unwrap();
    // Neither skin without its colours nor a head without eyes is near it.
    both.mesh.materials = None;
    let Some(plain) = on_gpu(&both, true) else { return };
    assert!(compare(&plain, &on_cpu, MEAN, ONE_IN_A_HUNDRED).is_err());
}

#[test]
fn draw_agrees_where_the_near_plane_cuts() {
    let mut both = Both::new(Style::Pixie, 12);
    both.camera.near = 1.0;
    check_pictures("short hair cut open", &both, true);
}

#[test]
fn draw_agrees_on_wide_ribbons_that_turn() {
    let mut both = Both::new(Style::Curly, 24);
    both.look = Look { width_scale: 12.0, hair_count: 0, follow_strands: 1, ..both.look };
    check_pictures("wide curls", &both, false);
}

#[test]
fn draw_agrees_on_an_open_body_in_blinding_light() {
    let mut both = Both::new(Style::Pixie, 12);
    // The back of the head is cut away, so that its inside shows.
    let half = both
        .mesh
        .triangles
        .iter()
        .filter(|corners| corners.iter().all(|&corner| both.mesh.positions[corner as usize].z > -0.03));
    both.mesh.triangles = half.copied().collect();
    assert!(!both.mesh.is_closed());
    for light in &mut both.lights {
        light.intensity *= 1e5;
    }
    // One sample a pixel: both light the skin at the same points.
    both.settings.supersampling = 1;
    both.settings.exposure = -14.0;
    both.camera = Camera::back();
    check_pictures("an open head in blinding light", &both, true);
    both.settings.exposure = 0.0;
    check_pictures("all white", &both, true);
}

#[test]
fn draw_agrees_on_skin_in_a_soft_box() {
    let mut both = Both::new(Style::Pixie, 12);
    let [soft, ..] = Light::studio(both.camera.target);
    both.lights = vec![Light { samples: 1, shadow: false, intensity: 4.0, ..soft }];
    both.settings.supersampling = 1;
    check_pictures("a head in a soft box", &both, true);
}

#[test]
fn draw_agrees_on_hair_before_the_lens() {
    let mut both = Both::new(Style::Wavy, 12);
    // Hair from the near plane on: places in the order must not be spent on the first millimetres.
    both.camera = Camera { position: Vec3::new(0.02, 0.0, 0.14), near: 1e-4, ..both.camera };
    both.look.hair_count = 0;
    check_pictures("hair before the lens", &both, false);
}

#[test]
fn draw_agrees_far_away() {
    let mut both = Both::new(Style::Wavy, 12);
    both.camera.position *= 8.0;
    both.camera.field_of_view = 5.0;
    check_pictures("wavy hair from afar", &both, false);
}

#[test]
fn draw_agrees_where_strands_are_left_out() {
    for look in [Look::brown(), Look::thesis()] {
        let mut both = Both::new(Style::Wavy, 12);
        both.look = Look { follow_strands: 1, ..look };
        both.look.fibre.chiang.cells = 12;
        both.camera.position *= 8.0;
        both.camera.field_of_view = 5.0;
        let left_out = both.level().left_out;
        assert!(left_out > 3.0 && left_out < 7.0, "{left_out} of eight");
        check_pictures("strands of their own from afar", &both, true);
    }
}

#[test]
fn draw_notices_another_width_and_a_missing_light() {
    let both = Both::new(Style::Wavy, 12);
    let Some([on_cpu, _]) = pictures(&both, true) else { return };
    let mut thicker = Both::new(Style::Wavy, 12);
    thicker.look.width_scale = 1.3;
    let mut darker = Both::new(Style::Wavy, 12);
    darker.lights.truncate(1);
    for wrong in [thicker, darker] {
        let Some(wrong) = on_gpu(&wrong, true) else { return };
        assert!(compare(&wrong, &on_cpu, MEAN, ONE_IN_A_HUNDRED).is_err());
    }
}

#[test]
fn resolve_agrees_at_every_setting() {
    for (supersampling, transparent, exposure, tone_map) in [
        (1, false, 0.0, ToneMap::Filmic),
        (2, true, 0.0, ToneMap::Filmic),
        (2, false, 1.5, ToneMap::Filmic),
        (2, false, 0.7, ToneMap::Off),
        (1, false, 0.5, ToneMap::Aces),
    ] {
        let mut both = Both::new(Style::Bob, 8);
        // An odd size: rows of pictures on the device are longer than those of the picture.
        both.settings = PictureSettings {
            supersampling,
            transparent,
            exposure,
            tone_map,
            ..PictureSettings::sized(131, 77)
        };
        let Some([on_cpu, on_gpu]) = pictures(&both, false) else { return };
        compare(&on_gpu, &on_cpu, MEAN, ONE_IN_A_HUNDRED).unwrap();
        assert_eq!(on_gpu.alpha.is_some(), transparent);
        if let (Some(one), Some(other)) = (&on_cpu.alpha, &on_gpu.alpha) {
            let off: u32 = one.iter().zip(other).map(|(one, other)| u32::from(one.abs_diff(*other))).sum();
            // Half floats hold opacity to a quarter of a step of 255.
            assert!(off as usize <= one.len() / 4, "{off} steps of {} pixels", one.len());
        }
    }
}
