//! Hair of every pigment in four lights that fit no direction along which light is carried, against means by rows of
//! path-traced pictures (reference/look/README.md).

use glam::Vec3;
use strandline_checks::{On, law};
use strandline_render::Light;
use strandline_render::fibre::Chiang;

use crate::light::{Scene, sphere, sun};
use crate::linear::{Linear, folder};

/// Bands of rows of a picture.
const BANDS: usize = 16;
/// Share of the brightest band's light below which a band is not looked at by itself.
const DIM: f32 = 0.2;

/// Lights and the directions in which they go.
const LIGHTS: [(&str, [f32; 3]); 4] = [
    ("behind", [-0.3, -0.5, 0.8]),
    ("side", [-1.0, -0.15, -0.1]),
    ("above", [0.1, -1.0, -0.05]),
    ("below", [0.25, 0.6, -0.75]),
];
/// Hair, with its eumelanin and pheomelanin.
const PIGMENTS: [(&str, [f32; 2]); 4] =
    [("white", [0.0, 0.0]), ("blonde", [0.3, 0.0]), ("brown", [0.6, 0.2]), ("black", [8.0, 0.0])];

/// The ball of `brown_directional` with other hair in another light.
fn scene(way: [f32; 3], [eumelanin, pheomelanin]: [f32; 2]) -> Scene {
    let mut scene = sphere(Some(Light { position: -Vec3::from(way), ..sun() }), 0.0);
    scene.look.fibre.chiang = Chiang { eumelanin, pheomelanin, ..Chiang::default() };
    scene
}

/// Means of the bands of a reference.
fn reference(light: &str, pigment: &str) -> Vec<Vec3> {
    let text = std::fs::read_to_string(folder().join("look/four_lights.csv")).unwrap();
    let start = format!("{light},{pigment},");
    let lines = text.lines().filter_map(|line| line.strip_prefix(&start));
    let numbers = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect::<Vec<f32>>();
    lines.map(|line| Vec3::from_slice(&numbers(line)[1..])).collect()
}

fn bands(picture: &Linear) -> Vec<Vec3> {
    let size = picture.pixels.len() / BANDS;
    picture.pixels.chunks(size).map(|band| band.iter().sum::<Vec3>() / size as f32).collect()
}

/// Greatest share by which a channel of the whole differs, and of a band that is not dim.
fn apart(found: &[Vec3], expected: &[Vec3]) -> [f32; 2] {
    let off = |found: Vec3, expected: Vec3| (found / expected - 1.0).abs().max_element();
    let most = expected.iter().map(|band| band.element_sum()).fold(0.0, f32::max);
    let bright = found.iter().zip(expected).filter(|(_, band)| band.element_sum() > DIM * most);
    let sum = |bands: &[Vec3]| bands.iter().sum::<Vec3>();
    let worst = bright.map(|(found, expected)| off(*found, *expected)).fold(0.0, f32::max);
    [off(sum(found), sum(expected)), worst]
}

law! {
    fn hair_in_any_light_is_as_bright_as_path_tracing_shows_it(on) {
        let chosen = on.either(&PIGMENTS[..], &PIGMENTS[..1]);
        for (light, way) in on.either(&LIGHTS[..], &LIGHTS[..1]) {
            for (pigment, melanin) in chosen {
                let found = bands(&scene(*way, *melanin).drawn_by(on));
                let [whole, band] = apart(&found, &reference(light, pigment));
                println!("{light} {pigment}: {whole:.3} {band:.3}");
            }
        }
    }
}

#[test]
fn trial() {
    let Ok(names) = std::env::var("TRIAL") else { return };
    let out = std::env::var("TRIAL_OUT").unwrap();
    for name in names.split(',') {
        let parts: Vec<&str> = name.split('_').collect();
        if parts[0] == "head" {
            let [eumelanin, pheomelanin] = match parts[1] {
                "white" => [0.0, 0.0],
                "blonde" => [0.3, 0.0],
                "brown" => [0.6, 0.2],
                _ => [8.0, 0.0],
            };
            let mut scene = crate::light::named_head(parts[2]);
            scene.look.fibre.chiang = Chiang { eumelanin, pheomelanin, ..scene.look.fibre.chiang };
            if let Ok(s) = std::env::var("TRIAL_ROUNDS") {
                scene.look.fibre.chiang.scatterings = s.parse().unwrap();
            }
            let boxed = scene.drawn().boxed();
            let bytes: Vec<u8> =
                boxed.pixels.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes).collect();
            std::fs::write(format!("{out}/{name}.f32"), bytes).unwrap();
            continue;
        }
        let way = match parts[1] {
            "front" => [-0.4, -0.7, -0.6],
            "behind" => [-0.3, -0.5, 0.8],
            "side" => [-1.0, -0.15, -0.1],
            "above" => [0.1, -1.0, -0.05],
            _ => [0.25, 0.6, -0.75],
        };
        let light = Light { position: -Vec3::from(way), ..crate::light::sun() };
        let mut scene = crate::light::sphere(Some(light), 0.0);
        let [eumelanin, pheomelanin] = match parts[0] {
            "white" => [0.0, 0.0],
            "blonde" => [0.3, 0.0],
            "brown" => [0.6, 0.2],
            _ => [8.0, 0.0],
        };
        scene.look.fibre.chiang = Chiang { eumelanin, pheomelanin, ..Chiang::default() };
        if let Ok(s) = std::env::var("TRIAL_ROUNDS") {
            scene.look.fibre.chiang.scatterings = s.parse().unwrap();
        }
        if parts.len() > 2 {
            scene.body = None;
        }
        let boxed = scene.drawn().boxed();
        let bytes: Vec<u8> =
            boxed.pixels.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes).collect();
        std::fs::write(format!("{out}/{name}.f32"), bytes).unwrap();
    }
}
