//! The crown of a head of grown hair in the default look, with a soft box before it and with one behind it.
//!
//! The *crown* is covered by hair to at least half and lies less than 8 cm below the top of the head: all visible hair of
//! the head above the brow. Its *rim* is the part within 1 cm of the picture's empty part. Luminance is
//! that of linear light, before exposure and tone map, of the covered part of a pixel.
//!
//! A lighting artist asks for 0.5 of the front-lit crown in the rim of brown hair, 1 in that of blonde hair, and a 99th
//! percentile of 6 medians in a soft box. A light behind makes a rim of 5.2 times the front-lit crown in brown hair
//! and 3.0 in blonde. The ring in a soft box depends on the style and on the side; here it is 9.7.

use std::sync::Arc;

use glam::Vec3;
use strandline_body::{BodyFrame, Mannequin, Mesh};
use strandline_checks::{On, law};
use strandline_groom::{Guides, Style, StyleSettings};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, FrameInput, Layers, LevelOfDetail, Light, Look, PictureSettings, Preset, Renderer,
};

use crate::linear::{Linear, channel};

/// Width and height of pictures of the crown \[pixel\]: the rim has 175 pixels.
const SIZE: usize = 192;
/// Distance of the crown's lower edge from the top of the head \[m\].
const CROWN: f32 = 0.08;
/// Breadth of the rim \[m\].
const RIM: f32 = 0.01;

/// A built-in style as a picture shows it before any simulation.
pub(crate) struct Head {
    guides: Guides,
    mesh: Mesh,
    camera: Camera,
    /// Width and height of its pictures \[pixel\].
    size: usize,
}

impl Head {
    fn new() -> Self {
        Self::of(2_000, SIZE)
    }

    /// A head with a number of guides, in pictures of a width and height \[pixel\].
    pub(crate) fn of(strand_count: usize, size: usize) -> Self {
        Self::without(0, strand_count, 16, size)
    }

    /// The same head without the last few of its guides, which have so many points.
    pub(crate) fn without(count: usize, strand_count: usize, points: usize, size: usize) -> Self {
        let groom = StyleSettings { strand_count, ..StyleSettings::new(Style::Long) }.grow().unwrap();
        let groom = groom.kept(|strand| strand < strand_count - count);
        Self {
            guides: Guides::resample(&groom, points).unwrap(),
            mesh: Mannequin::new().mesh(),
            camera: Camera::front(),
            size,
        }
    }

    /// The picture with one light.
    fn lit(&self, on: &On, preset: Preset, light: Light) -> Layers {
        self.lit_by(on, preset, &[light])
    }

    /// The picture with some lights.
    pub(crate) fn lit_by(&self, on: &On, preset: Preset, lights: &[Light]) -> Layers {
        let settings = PictureSettings {
            transparent: true,
            layers: true,
            ..PictureSettings::sized(self.size as u32, self.size as u32)
        };
        let mut look = Look::named(preset);
        // On a software adapter each takes part of a second of processors: four leave blonde hair its rim.
        look.fibre.chiang.scatterings = on.short(look.fibre.chiang.scatterings, 4);
        let input = FrameInput {
            positions: self.guides.positions(),
            body: &BodyFrame::REST,
            camera: &self.camera,
            look: &look,
            body_look: &BodyLook::default(),
            lights,
            level_of_detail: &LevelOfDetail::default(),
        };
        let body = Some(&self.mesh);
        let (_, report) = match on {
            On::Cpu => Renderer::new(&self.guides, body, &settings).unwrap().draw(&input).unwrap(),
            On::Gpu(gpu) => {
                GpuRenderer::new(gpu, &self.guides, body, &settings).unwrap().draw(&input).unwrap()
            }
        };
        Arc::unwrap_or_clone(report.layers.unwrap())
    }

    /// The pixels of the crown.
    pub(crate) fn crown(&self, layers: &Layers) -> Vec<bool> {
        let top = self.mesh.positions.iter().map(|point| point.y).fold(f32::MIN, f32::max);
        let [mask, depth] = ["mask.hair", "depth.Z"].map(|name| channel(layers, name));
        let world_from_view = self.camera.view_from_world().inverse();
        let size = self.size;
        let slope = 2.0 / (size as f32 * self.camera.focal());
        let middle = |at: usize| at as f32 + 0.5 - 0.5 * size as f32;
        let height = |at: usize| {
            let (x, y) = (slope * middle(at % size), -slope * middle(at / size));
            world_from_view.transform_point3(depth[at] * Vec3::new(x, y, -1.0)).y
        };
        (0..size * size).map(|at| mask[at] >= 0.5 && height(at) > top - CROWN).collect()
    }

    /// The pixels of its rim.
    fn rim(&self, layers: &Layers, crown: &[bool]) -> Vec<bool> {
        let distance = self.camera.position.distance(self.camera.target);
        let size = self.size;
        let reach = (RIM * 0.5 * size as f32 * self.camera.focal() / distance).round() as i32;
        let alpha = channel(layers, "A");
        let empty = |x: i32, y: i32| {
            let inside = (0..size as i32).contains(&x) && (0..size as i32).contains(&y);
            inside && alpha[y as usize * size + x as usize] < 0.01
        };
        let offsets = || (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y)));
        let near = |at: usize| {
            let (x, y) = ((at % size) as i32, (at / size) as i32);
            offsets().any(|(right, down)| {
                right * right + down * down <= reach * reach && empty(x + right, y + down)
            })
        };
        (0..size * size).map(|at| crown[at] && near(at)).collect()
    }
}

/// Luminances of some pixels, the darkest first.
fn luminances(layers: &Layers, mask: &[bool]) -> Vec<f32> {
    let alpha = channel(layers, "A");
    let of = |(at, light): (usize, &Vec3)| light.dot(Vec3::new(0.2126, 0.7152, 0.0722)) / alpha[at];
    let pixels = Linear::of(layers).pixels;
    let mut found: Vec<f32> = pixels.iter().enumerate().filter(|(at, _)| mask[*at]).map(of).collect();
    found.sort_by(f32::total_cmp);
    assert!(found.len() > 150, "{} pixels", found.len());
    found
}

fn quantile(sorted: &[f32], share: f32) -> f32 {
    sorted[((sorted.len() - 1) as f32 * share) as usize]
}

/// A soft box of the studio's size and power before the head, and the same one behind it.
fn boxes() -> [Light; 2] {
    let [front, ..] = Light::studio(Camera::front().target);
    let away = front.position - front.target;
    [front, Light { position: front.target + away * Vec3::new(1.0, 1.0, -1.0), ..front }]
}

/// Median luminance of the rim lit from behind over that of the crown lit from the front, and the 99th percentile over
/// the median of that.
fn shown(on: &On, preset: Preset) -> [f32; 2] {
    let head = Head::new();
    let [front, back] = boxes().map(|light| head.lit(on, preset, light));
    let crown = head.crown(&front);
    let rim = head.rim(&front, &crown);
    for (layers, name) in [(&front, "front"), (&back, "back")] {
        Linear::of(layers).save(&format!("crown_{preset:?}_{name}"), 1.0);
    }
    let [crown, rim] = [luminances(&front, &crown), luminances(&back, &rim)];
    [quantile(&rim, 0.5), quantile(&crown, 0.99)].map(|light| light / quantile(&crown, 0.5))
}

law! {
    long fn brown_hair_glows_from_behind_and_has_a_ring_in_a_soft_box(on) {
        let [glow, ring] = shown(on, Preset::Brown);
        // 0.5 is asked for; 1.8 is left where light does not go through fibres.
        assert!(glow >= 3.0, "{glow}");
        // 3.8 is left where the surfaces of fibres are dull.
        assert!(ring >= 6.0, "{ring}");
    }
}

law! {
    long fn blonde_hair_is_brighter_from_behind_than_from_the_front(on) {
        let [glow, _] = shown(on, Preset::Blonde);
        // 1 is asked for; 1.4 is left where light does not go through fibres.
        assert!(glow >= 2.0, "{glow}");
    }
}
