//! Deep opacity maps against exact counts of the strands that a ray crosses.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use strandline_body::BodyFrame;
use strandline_checks::{On, law};
use strandline_gpu::Gpu;
use strandline_groom::{Groom, Guides, Style, StyleSettings};
use strandline_render::cpu::{ShadowBody, opacity_depth, opacity_layers};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, FrameInput, LevelOfDetail, Light, LightKind, Look, PictureSettings, Shadow,
};
use strandline_render::{Shadows, Strands};

use crate::grooms::Random;

/// The direction in which the light of the reference travels.
const TRAVELS: Vec3 = Vec3::new(-0.39801, -0.69653, -0.59702);

fn sun(travels: Vec3) -> Light {
    Light { kind: LightKind::Directional, position: -travels, target: Vec3::ZERO, ..Light::default() }
}

/// Strands of one number of points as the stages take them.
pub fn strands(lines: &[Vec<Vec3>], diameter: f32) -> Strands {
    let points_per_strand = lines[0].len();
    let mut strands = Strands::default();
    strands.resize(lines.len(), 1, points_per_strand);
    strands.positions = lines.concat();
    strands.widths.fill(diameter);
    strands
}

fn shadows(strands: &Strands, light: &Light, settings: &Shadow) -> Shadows {
    let mut shadows = Shadows::default();
    opacity_depth(strands, None, std::slice::from_ref(light), Vec3::ZERO, settings, &mut shadows);
    opacity_layers(strands, &mut shadows);
    shadows
}

/// As [`shadows`] with the usual settings, on a backend.
fn shadows_on(on: &On, strands: &Strands, light: &Light) -> Shadows {
    match on {
        On::Cpu => shadows(strands, light, &Shadow::default()),
        On::Gpu(gpu) => {
            shadows_in(&mut renderer(gpu), strands, light, &Look { follow_strands: 1, ..Look::thesis() })
        }
    }
}

/// A renderer of any guides: strands take their place.
pub fn renderer(gpu: &Gpu) -> GpuRenderer {
    GpuRenderer::new(gpu, &guides(), None, &PictureSettings::sized(16, 16)).unwrap()
}

fn guides() -> Guides {
    let groom = StyleSettings { strand_count: 8, ..StyleSettings::new(Style::Pixie) }.grow().unwrap();
    Guides::resample(&groom, 4).unwrap()
}

/// Shadows of strands in a renderer.
pub fn shadows_in(renderer: &mut GpuRenderer, strands: &Strands, light: &Light, look: &Look) -> Shadows {
    let guides = guides();
    let input = FrameInput {
        positions: guides.positions(),
        body: &BodyFrame::REST,
        camera: &Camera::front(),
        look,
        body_look: &BodyLook::default(),
        lights: std::slice::from_ref(light),
        level_of_detail: &LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() },
    };
    renderer.shadows_of(strands, &input).unwrap()
}

/// Accuracy of a map at points whose light is 0.7 to the power of the crossings.
#[derive(Debug)]
struct Accuracy {
    /// Mean of the error.
    bias: f64,
    /// Mean of its size.
    error: f64,
    /// Correlation of the optical depth with the crossings.
    correlation: f64,
}

fn accuracy(shadows: &Shadows, points: &[Vec3], crossings: &[u32]) -> Accuracy {
    let map = shadows.map(0).unwrap();
    let count = points.len() as f64;
    let errors: Vec<f64> = points
        .iter()
        .zip(crossings)
        .map(|(&point, &crossings)| f64::from(map.transmittance(point)) - 0.7f64.powi(crossings as i32))
        .collect();
    let depths: Vec<f64> = points.iter().map(|&point| f64::from(map.crossings(point))).collect();
    let counts: Vec<f64> = crossings.iter().map(|&crossings| f64::from(crossings)).collect();
    Accuracy {
        bias: errors.iter().sum::<f64>() / count,
        error: errors.iter().map(|error| error.abs()).sum::<f64>() / count,
        correlation: correlation(&depths, &counts),
    }
}

fn correlation(first: &[f64], second: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (first_mean, second_mean) = (mean(first), mean(second));
    let product = |one: &[f64], one_mean: f64, other: &[f64], other_mean: f64| -> f64 {
        one.iter().zip(other).map(|(one, other)| (one - one_mean) * (other - other_mean)).sum()
    };
    product(first, first_mean, second, second_mean)
        / (product(first, first_mean, first, first_mean) * product(second, second_mean, second, second_mean))
            .sqrt()
}

impl Accuracy {
    /// The bounds of the reference: three layers, maps of 512 x 512.
    fn sound(&self) -> bool {
        self.bias.abs() <= 0.06 && self.error <= 0.15 && self.correlation >= 0.78
    }
}

/// A uniform cubic B-spline through tripled end points, four segments to a span.
pub fn spline(controls: &[Vec3]) -> Vec<Vec3> {
    let (first, last) = (controls[0], controls[controls.len() - 1]);
    let mut points = vec![first, first];
    points.extend(controls);
    points.extend([last, last]);
    let mut line = Vec::new();
    for (span, window) in points.windows(4).enumerate() {
        for step in 0..if span + 4 == points.len() { 5 } else { 4 } {
            let t = step as f32 / 4.0;
            let r = 1.0 - t;
            let weights = [
                r * r * r,
                3.0 * t * t * t - 6.0 * t * t + 4.0,
                3.0 * r * r * r - 6.0 * r * r + 4.0,
                t * t * t,
            ];
            line.push(window.iter().zip(weights).map(|(&point, weight)| point * (weight / 6.0)).sum());
        }
    }
    line
}

law! {
    fn maps_tell_the_crossings_of_the_reference_groom(on) {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("pictures/reference");
        let groom = Groom::load(folder.join("shadow_groom.hair")).unwrap();
        let lines: Vec<_> = (0..groom.strand_count()).map(|strand| spline(groom.strand(strand))).collect();
        let strands = strands(&lines, groom.widths.at(0, 0));
        let table = std::fs::read_to_string(folder.join("shadow_queries.csv")).unwrap();
        let (mut points, mut crossings) = (Vec::new(), Vec::new());
        for line in table.lines().skip(1) {
            let numbers: Vec<f32> = line.split(',').map(|number| number.parse().unwrap()).collect();
            points.push(Vec3::new(numbers[0], numbers[1], numbers[2]));
            crossings.push(numbers[3] as u32);
        }
        assert_eq!((lines.len(), points.len()), (4000, 3000));
        let accuracy_of = |travels| accuracy(&shadows_on(on, &strands, &sun(travels)), &points, &crossings);
        let found = accuracy_of(TRAVELS);
        assert!(found.sound(), "{found:?}");
        let wrong = accuracy_of(-TRAVELS);
        assert!(!wrong.sound(), "light from the wrong side must be seen: {wrong:?}");
    }
}

/// Strands that hang about a ball of 9 cm, each 0.4 mm thick.
pub fn mop(strand_count: usize) -> Vec<Vec<Vec3>> {
    let mut random = Random(3);
    let strand = |_| {
        let height = random.between(0.1, 1.0);
        let turn = random.unit() * std::f32::consts::TAU;
        let flat = (1.0f32 - height * height).sqrt();
        let normal = Vec3::new(flat * turn.cos(), height, flat * turn.sin());
        let lift = random.between(0.0, 0.5);
        let mut point = normal * random.between(0.09, 0.1);
        let mut line = vec![point];
        for step in 0..12 {
            let share = step as f32 / 12.0;
            let out = Vec3::new(normal.x, 0.0, normal.z) * (1.0 - share);
            point += (out * (0.5 + lift) + Vec3::NEG_Y * (0.2 + share)).normalize() * 0.016;
            line.push(point);
        }
        line
    };
    (0..strand_count).map(strand).collect()
}

/// Strands, as tubes, that a ray from a point crosses, counted one by one in double precision.
fn exact_crossings(lines: &[Vec<Vec3>], radius: f64, point: Vec3, to_light: Vec3) -> u32 {
    let (origin, ray) = (point.as_dvec3(), to_light.as_dvec3().normalize());
    let near = |pair: &[Vec3]| ray_distance(origin, ray, pair[0].as_dvec3(), pair[1].as_dvec3()) < radius;
    lines.iter().filter(|line| line.windows(2).any(near)).count() as u32
}

/// Distance between a ray of unit direction and a segment.
fn ray_distance(origin: DVec3, ray: DVec3, start: DVec3, end: DVec3) -> f64 {
    let along = end - start;
    let from = start - origin;
    let across = along - ray * along.dot(ray);
    let share = if across.length_squared() > 1e-18 {
        (-(from - ray * from.dot(ray)).dot(across) / across.length_squared()).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let nearest = from + along * share;
    let distance = nearest.dot(ray).max(0.0);
    (nearest - ray * distance).length()
}

#[test]
fn maps_tell_exact_crossings() {
    let lines = mop(8000);
    let diameter = 4e-4;
    let strands = strands(&lines, diameter);
    let mut random = Random(5);
    let points: Vec<Vec3> = (0..800)
        .map(|_| {
            let line = &lines[(random.unit() * 8000.0) as usize];
            line[(random.unit() * 12.0) as usize]
                + Vec3::new(random.unit(), random.unit(), random.unit()) * 0.01
        })
        .collect();
    let crossings: Vec<u32> = points
        .iter()
        .map(|&point| exact_crossings(&lines, 0.5 * f64::from(diameter), point, -TRAVELS))
        .collect();
    let mean = crossings.iter().sum::<u32>() as f64 / 800.0;
    assert!(mean > 2.0 && mean < 20.0, "the case must be neither empty nor solid: {mean}");
    let found = accuracy(&shadows(&strands, &sun(TRAVELS), &Shadow::default()), &points, &crossings);
    println!("{found:?} at a mean of {mean} crossings");
    assert!(found.sound(), "{found:?}");
    let one_layer = Shadow { layers: [2.0, 3.0, 4.0], ..Shadow::default() };
    let wrong = accuracy(&shadows(&strands, &sun(TRAVELS), &one_layer), &points, &crossings);
    assert!(!wrong.sound(), "layers far too thick must be seen: {wrong:?}");
}

#[test]
fn crossings_do_not_depend_on_map_size_or_segments() {
    // A sheet of parallel strands: width over spacing is the share of light that meets one.
    let sheet = |segments: usize| -> Vec<Vec<Vec3>> {
        (0..2000)
            .map(|strand| {
                let x = strand as f32 * 1e-4;
                (0..=segments).map(|point| Vec3::new(x, 0.0, point as f32 * 0.2 / segments as f32)).collect()
            })
            .collect()
    };
    let mut random = Random(9);
    let behind: Vec<Vec3> =
        (0..2000).map(|_| Vec3::new(random.between(0.01, 0.19), -0.3, random.between(0.01, 0.19))).collect();
    for (size, segments) in [(128, 1), (512, 1), (512, 20), (512, 63), (1024, 7)] {
        let strands = strands(&sheet(segments), 5e-5);
        let settings = Shadow { map_size: size, ..Shadow::default() };
        let shadows = shadows(&strands, &sun(Vec3::NEG_Y), &settings);
        let map = shadows.map(0).unwrap();
        let mean = behind.iter().map(|&point| map.crossings(point)).sum::<f32>() / behind.len() as f32;
        // Texels near each other hold up to a third more or less hair; over 2,000 places that leaves 1 %.
        assert!((mean - 0.5).abs() < 0.015 * 0.5, "{size} texels, {segments} segments: {mean}");
    }
}

#[test]
fn maps_hold_for_any_number_of_threads() {
    let strands = strands(&mop(2000), 4e-4);
    let lights = Light::three_point(Vec3::ZERO);
    let in_pool = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut shadows = Shadows::default();
            opacity_depth(&strands, None, &lights, Vec3::ZERO, &Shadow::default(), &mut shadows);
            opacity_layers(&strands, &mut shadows);
            let maps: Vec<_> = (0..2).map(|light| shadows.map(light).unwrap()).collect();
            let at =
                |point: &Vec3| maps.iter().map(|map| map.transmittance(*point).to_bits()).collect::<Vec<_>>();
            assert!(shadows.map(2).is_none());
            strands.positions.iter().flat_map(at).collect::<Vec<_>>()
        })
    };
    assert_eq!(in_pool(1), in_pool(5));
}

#[test]
fn a_body_shadows_what_lies_behind_it() {
    let strands = strands(&mop(10), 4e-4);
    let corners = [
        Vec3::new(-0.1, 0.0, -0.1),
        Vec3::new(0.1, 0.0, -0.1),
        Vec3::new(0.1, 0.0, 0.1),
        Vec3::new(-0.1, 0.0, 0.1),
    ];
    let body = ShadowBody { positions: &corners, triangles: &[[0, 1, 2], [0, 2, 3]], roots: &[], cuts: None };
    for light in [sun(Vec3::NEG_Y), Light { position: Vec3::new(0.0, 1.0, 0.0), ..Light::default() }] {
        let mut shadows = Shadows::default();
        opacity_depth(&strands, Some(body), &[light], Vec3::ZERO, &Shadow::default(), &mut shadows);
        opacity_layers(&strands, &mut shadows);
        let map = shadows.map(0).unwrap();
        assert_eq!(map.body_visibility(Vec3::new(0.03, -0.05, 0.02)), 0.0);
        assert_eq!(map.body_visibility(Vec3::new(0.03, 0.05, 0.02)), 1.0);
        // On the surface itself the bias keeps it lit.
        assert_eq!(map.body_visibility(Vec3::new(0.03, 0.0, 0.02)), 1.0);
        assert_eq!(map.body_visibility(Vec3::new(0.2, -0.05, 0.02)), 1.0);
    }
}
