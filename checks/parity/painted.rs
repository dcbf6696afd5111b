//! Bodies with materials: colours, textures, cut-outs and their shadows.

use glam::{Quat, Vec2, Vec3};
use strandline_body::{BodyFrame, Mesh, MeshFormat};
use strandline_checks::{flip::compare, gpu};
use strandline_groom::{Groom, Guides, Style};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    Background, BodyLook, Camera, Environment, FrameInput, LevelOfDetail, Light, LightKind, Look, Picture,
    PictureSettings, Renderer, ToneMap,
};

use crate::painted_file::{BOARD, RED, painted};
use crate::picture::Both;

fn body() -> Mesh {
    Mesh::from_bytes(&painted(), MeshFormat::Gltf).unwrap()
}

/// Width and height of the pictures.
const SIZE: usize = 256;
/// The colour behind the body.
const BEHIND: f32 = 0.05;

/// A camera on the z axis [m].
fn camera(z: f32) -> Camera {
    Camera { position: z * Vec3::Z, target: Vec3::ZERO, field_of_view: 40.0, ..Camera::front() }
}

/// A picture of linear light, from a place on the z axis [m].
struct Linear([Vec<f32>; 3], f32);

impl Linear {
    /// The light of the pixel that shows a place [m].
    fn at(&self, place: Vec3) -> Vec3 {
        let scale = 0.5 * SIZE as f32;
        let focal = scale * camera(self.1).focal();
        let on_screen = scale + focal / (self.1 - place.z) * Vec2::new(place.x, -place.y);
        let index = on_screen.y as usize * SIZE + on_screen.x as usize;
        Vec3::from([0, 1, 2].map(|channel| self.0[channel][index]))
    }
}

/// Pictures of both backends of the body almost without hair, from a place on the z axis [m].
fn linear(body_look: BodyLook, around: f32, lights: &[Light], from: f32) -> Vec<Linear> {
    let mut groom = Groom::empty(8e-5);
    groom.push((0..8).map(|point| Vec3::new(0.6, 2e-3 * point as f32 - 0.6, -0.6)));
    let guides = Guides::resample(&groom, 8).unwrap();
    let behind = Vec3::splat(BEHIND);
    let settings = PictureSettings {
        layers: true,
        tone_map: ToneMap::Off,
        background: Background { top: behind, bottom: behind },
        ..PictureSettings::sized(SIZE as u32, SIZE as u32)
    };
    let even = Vec3::splat(around);
    let look = Look { environment: Environment { sky: even, ground: even }, ..Look::thesis() };
    let input = FrameInput {
        positions: guides.positions(),
        body: &BodyFrame::REST,
        camera: &camera(from),
        look: &look,
        body_look: &body_look,
        lights,
        level_of_detail: &LevelOfDetail::default(),
    };
    let mesh = &body();
    let mut reports = vec![Renderer::new(&guides, Some(mesh), &settings).unwrap().draw(&input).unwrap().1];
    if let Some(gpu) = gpu() {
        let mut renderer = GpuRenderer::new(&gpu, &guides, Some(mesh), &settings).unwrap();
        reports.push(renderer.draw(&input).unwrap().1);
    }
    let linear = |report: strandline_render::FrameReport| {
        let layers = report.layers.unwrap();
        let channel = |name: &str| {
            layers.channels.iter().find(|(own, _)| own == name).map(|(_, values)| values.to_vec()).unwrap()
        };
        Linear(["R", "G", "B"].map(channel), from)
    };
    reports.into_iter().map(linear).collect()
}

fn matt() -> BodyLook {
    BodyLook { wrap: 0.0, softness: 0.0, oil: 0.0, specular: 0.0, scalp: 0.0, ..BodyLook::default() }
}

/// The middle of a texel of the board [m].
fn on_board(texel: usize) -> Vec3 {
    let (right, down) = ((texel % 2) as f32 - 0.5, (texel / 2) as f32 - 0.5);
    Vec3::new(-0.15 + 0.05 * right, -0.05 * down, 0.15)
}

/// The middle of a texel is seen up to half a pixel aside, mixed with its neighbours: by .0098 at most on the CPU. Half
/// floats of a device add half a thousandth.
fn close(one: Vec3, other: Vec3) -> bool {
    (one - other).abs().max_element() < 0.011
}

/// Linear light of a stored number [IEC 61966-2-1].
fn light(stored: u8) -> f32 {
    let part = f32::from(stored) / 255.0;
    if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
}

#[test]
fn textures_and_colours_are_seen_in_even_light_as_the_file_has_them() {
    let [cut, left] = [Vec3::new(0.125, 0.0, 0.15), Vec3::new(0.175, 0.0, 0.15)];
    let wall = Vec3::new(0.4, 0.6, 0.8);
    for picture in linear(matt(), 1.0, &[], 1.0) {
        for (texel, stored) in BOARD.iter().enumerate() {
            let expected = Vec3::from(stored.map(light)) * Vec3::new(RED, 1.0, 1.0);
            let found = picture.at(on_board(texel));
            assert!(close(found, expected), "{texel}: {found} and {expected}");
        }
        let found = [cut, left, Vec3::new(0.0, 0.15, 0.15)].map(|place| picture.at(place));
        // Through what is cut away, and through glass, the wall with its colours of vertices is seen.
        assert!(close(found[0], wall) && close(found[2], wall), "{found:?}");
        let brown = Vec3::from([90, 60, 30].map(light));
        assert!(close(found[1], brown), "{found:?}");
    }
    let plain = BodyLook { materials: false, color: Vec3::new(0.2, 0.5, 0.3), ..matt() };
    for picture in linear(plain, 1.0, &[], 1.0) {
        let found = [on_board(0), left, cut].map(|place| picture.at(place));
        assert!(found.iter().all(|found| close(*found, plain.color)), "the body's own colour: {found:?}");
    }
}

#[test]
fn light_falls_through_what_is_cut_away() {
    let sun = Light {
        kind: LightKind::Directional,
        position: Vec3::new(0.0, 0.5, 1.0),
        target: Vec3::ZERO,
        color: Vec3::ONE,
        intensity: 1.0,
        shadow: true,
        ..Light::default()
    };
    for picture in linear(matt(), 0.0, &[sun], 1.0) {
        let [lit, dark, open] = [0.125, 0.175, 0.25].map(|x| picture.at(Vec3::new(x, -0.15, -0.15)).y);
        assert!(open > 0.2 && lit > 0.9 * open && dark < 0.1 * open, "{lit}, {dark} of {open}");
    }
}

#[test]
fn a_smooth_material_mirrors_a_light_and_a_rough_one_does_not() {
    let (eye, from) = (Vec3::new(0.03, 0.02, 0.08), 0.4);
    let lamp = Light {
        kind: LightKind::Directional,
        position: eye + Vec3::Z,
        target: eye,
        color: Vec3::ONE,
        intensity: 1.0,
        shadow: false,
        ..Light::default()
    };
    // The brightest of the places about one that faces lamp and camera.
    let brightest = |picture: &Linear, place: Vec3| {
        let about = |at: i32| place + 5e-4 * Vec3::new((at % 9 - 4) as f32, (at / 9 - 4) as f32, 0.0);
        (0..81).map(|at| picture.at(about(at)).max_element()).fold(0.0, f32::max)
    };
    let bright = |specular: f32| {
        let pictures = linear(BodyLook { specular, ..matt() }, 0.0, &[lamp], from);
        pictures.into_iter().map(move |picture| {
            [eye + 0.025 * Vec3::Z, Vec3::new(0.0, -0.02, 0.098)].map(|place| brightest(&picture, place))
        })
    };
    for ([shiny, rough], [eye, skin]) in bright(0.04).zip(bright(0.0)) {
        assert!(shiny > eye + 1.0 && rough < skin + 0.05, "{shiny}, {rough}; {eye}, {skin}");
    }
}

#[test]
fn draw_agrees_on_a_body_with_materials() {
    let mut both = Both::new(Style::Pixie, 12);
    let plain = both.settings;
    both.mesh = body();
    both.body =
        strandline_body::Pose { rotation: Quat::from_rotation_y(0.3), translation: Vec3::ZERO }.into();
    both.camera = Camera { position: Vec3::new(0.2, 0.1, 0.9), ..camera(1.0) };
    both.settings = PictureSettings { width: 256, height: 256, ..plain };
    let positions = both.positions();
    let input = both.input(&positions);
    let drawn = |input: &FrameInput| {
        let on_cpu =
            Renderer::new(&both.guides, Some(&both.mesh), &both.settings).unwrap().draw(input).unwrap().0;
        let on_gpu = gpu().map(|gpu| {
            GpuRenderer::new(&gpu, &both.guides, Some(&both.mesh), &both.settings)
                .unwrap()
                .draw(input)
                .unwrap()
                .0
        });
        (on_cpu, on_gpu)
    };
    // Allowed difference of two pictures, as in draw.rs.
    let alike = |one: &Picture, other: &Picture| compare(one, other, 0.01, 0.1);
    let (on_cpu, on_gpu) = drawn(&input);
    let without =
        drawn(&FrameInput { body_look: &BodyLook { materials: false, ..*input.body_look }, ..input }).0;
    assert!(alike(&without, &on_cpu).is_err(), "the comparison can fail");
    if let Some(on_gpu) = on_gpu {
        alike(&on_gpu, &on_cpu).unwrap();
    }
}
