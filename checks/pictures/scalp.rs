//! The scalp through hair, and hair at its roots, of built-in styles at rest from 1 m.
//!
//! *Haired* is the scalp more than 12 mm from its border, but for 10 mm about a parting. A *root pixel* shows hair within
//! 15 mm of its root. The *crown* lies less than 8 cm below the top of the hair. Luminance is that of linear light of the
//! hair in a pixel: the skin is black. With STRANDLINE_KEEP the pixels that count are drawn in red.

use std::sync::Arc;

use glam::Vec3;
use strandline::{Backend, Hair, Prepared, Scene};
use strandline_body::{Mannequin, SignedDistance};
use strandline_checks::in_full;
use strandline_groom::{LANES, Style};
use strandline_render::fibre::FibreModel;
use strandline_render::{BodyLook, Camera, Layers, Light, Look, PictureSettings};

use crate::linear::{Linear, channel};

/// Width and height of a picture \[pixel\].
const SIZE: usize = 160;
/// Distance from the border of the scalp \[m\] within which hair is thin, and half the breadth of a parting \[m\].
const THIN: f32 = 0.012;
const PARTING: f32 = 0.010;
/// Length of hair from its root \[m\] of root pixels.
const ROOT: f32 = 0.015;
/// Distance \[m\] of hair beyond the roots from those that it lies beside, and light of bright roots over its brightest
/// tenth.
const BESIDE: f32 = 0.03;
const OVER: f32 = 1.2;
/// Share of a pixel that hair covers from which skin behind it adds nothing that counts.
const ALONE: f32 = 0.995;
/// Depth of the crown \[m\].
const CROWN: f32 = 0.08;

/// A style at rest.
struct Head {
    hair: Hair,
    roots: Vec<Vec3>,
    scene: Scene,
}

impl Head {
    fn new(style: Style) -> Self {
        Self::of(style, Scene::demo().style.strand_count)
    }

    /// With a number of guides.
    fn of(style: Style, strand_count: usize) -> Self {
        let mut scene = Scene::demo();
        scene.style.strand_count = strand_count;
        scene.set_style(style);
        scene.level_of_detail.by_pixel = false;
        scene.picture = PictureSettings {
            transparent: true,
            layers: true,
            ..PictureSettings::sized(SIZE as u32, SIZE as u32)
        };
        let prepared = Prepared::new(&scene).unwrap();
        let (scene, all) =
            (prepared.scene.clone(), prepared.bound.as_ref().map(|bound| bound.strands().clone()));
        let all = all.unwrap_or_else(|| prepared.guides.clone());
        let points = all.points_per_strand();
        let root = |strand: usize| all.positions()[strand / LANES * points].get(strand % LANES);
        let roots = (0..all.strand_count()).map(root).collect();
        Self { hair: Hair::from_prepared(prepared, Backend::Cpu).unwrap(), roots, scene }
    }

    fn seen(&mut self, camera: &Camera, look: &Look, lights: &[Light]) -> Layers {
        self.hair.set_lights(lights.to_vec()).unwrap();
        let (_, report) = self.hair.picture_with_report(camera, look).unwrap();
        Arc::unwrap_or_clone(report.layers.unwrap())
    }
}

/// Place of a pixel at a distance along the view \[m\], world space.
fn place(camera: &Camera, pixel: usize, depth: f32) -> Vec3 {
    let slope = 2.0 / (SIZE as f32 * camera.focal());
    let middle = |at: usize| at as f32 + 0.5 - 0.5 * SIZE as f32;
    let (x, y) = (slope * middle(pixel % SIZE), -slope * middle(pixel / SIZE));
    camera.view_from_world().inverse().transform_point3(depth * Vec3::new(x, y, -1.0))
}

/// Views of a head from 1 m: about it, and from above.
fn views(count: usize) -> Vec<Camera> {
    let around = (0..count).map(|view| std::f32::consts::TAU * view as f32 / count as f32);
    let around = around.map(|angle| Vec3::new(angle.sin(), 0.25, angle.cos()));
    let view = |way: Vec3| Camera { position: way.normalize(), target: Vec3::ZERO, ..Camera::front() };
    around.chain([Vec3::new(0.0, 1.0, 0.3)]).map(view).collect()
}

/// Pixels of the haired scalp, and the share of them that no hair covers.
fn bare(head: &mut Head, mannequin: &Mannequin, camera: &Camera) -> (f32, f32) {
    let light = Light { shadow: false, ..Light::three_point(Vec3::ZERO)[2] };
    // Coverage does not depend on light, which takes this fibre a hundredth of the time.
    let mut look = head.scene.look.clone();
    look.fibre.model = FibreModel::Scheuermann;
    let layers = head.seen(camera, &look, &[light]);
    let covered = channel(&layers, "mask.hair");
    let scalp = mannequin.scalp();
    // Hair that is combed back or from the whorl has no parting.
    let parted = head.scene.style.style.is_parted();
    let (mut haired, mut open) = (0.0, 0.0);
    let mut shown = Linear::of(&layers);
    for (pixel, share) in covered.iter().enumerate() {
        let start = place(camera, pixel, 0.5);
        let way = (start - camera.position).normalize();
        let mut passed = 0.0;
        let skin = (0..64).find_map(|_| {
            let point = start + way * passed;
            let distance = mannequin.distance(point);
            passed += 0.8 * distance;
            (distance < 3e-4).then_some(point)
        });
        let Some(skin) = skin.filter(|skin| scalp.contains(*skin) && scalp.depth(*skin) > THIN) else {
            continue;
        };
        if parted && (skin.x - head.scene.style.parting).abs() < PARTING && skin.y > 0.03 {
            continue;
        }
        haired += 1.0;
        open += 1.0 - share;
        shown.pixels[pixel] = shown.pixels[pixel].lerp(Vec3::X, 0.9 * (1.0 - share));
    }
    let from = camera.position;
    shown.save(
        &format!("bare_{}_{:.1}_{:.1}_{:.1}", head.scene.style.style.name(), from.x, from.y, from.z),
        1.0,
    );
    (haired, open)
}

/// Styles whose hair covers the head.
fn full(style: &Style) -> bool {
    !style.is_of_face() && *style != Style::Buzz
}

#[test]
fn no_scalp_is_seen_through_hair_from_a_metre() {
    let mannequin = Mannequin::new();
    let styles: Vec<Style> = if in_full() {
        Style::ALL.into_iter().filter(full).collect()
    } else {
        vec![Style::Bob, Style::Pixie]
    };
    let mut failed = Vec::new();
    for style in styles {
        let mut head = Head::new(style);
        let (mut haired, mut open, mut worst) = (0.0, 0.0, 0.0_f32);
        for camera in views(if in_full() { 8 } else { 2 }) {
            let (all, bare) = bare(&mut head, &mannequin, &camera);
            assert!(all > 300.0, "{all} pixels");
            (haired, open, worst) = (haired + all, open + bare, worst.max(bare / all));
        }
        let share = open / haired;
        println!("{}: {:.2} % bare, {:.2} % in the worst view", style.name(), 100.0 * share, 100.0 * worst);
        failed.extend((worst > 0.02).then_some((style, share, worst)));
    }
    assert!(failed.is_empty(), "{failed:?}");
    // Hair that stands for a tenth of the strands shows the scalp.
    let mut thin = Head::new(Style::Bob);
    thin.scene.look.width_scale = 0.1;
    let (all, open) = bare(&mut thin, &mannequin, &views(2)[1]);
    assert!(open / all > 0.02, "the comparison can fail: {}", open / all);
}

/// Skin that sends no light to the eye: between hairs of a parting lit skin is ten times as bright as brown hair.
const BLACK: BodyLook = BodyLook {
    materials: false,
    color: Vec3::ZERO,
    wrap: 0.0,
    softness: 0.0,
    oil: 0.0,
    specular: 0.0,
    roughness: 0.5,
    scalp: 0.0,
};

/// Pixels of hair, those of its roots, and of these the ones that are brighter than three medians of the crown
/// and than hair beyond the roots beside them.
fn bright(head: &mut Head, skin: BodyLook, camera: &Camera, lights: &[Light]) -> [usize; 3] {
    head.hair.set_body_look(skin).unwrap();
    let look = head.scene.look.clone();
    let layers = head.seen(camera, &look, lights);
    let [mask, depth, id] = ["mask.hair", "depth.Z", "strand.id"].map(|name| channel(&layers, name));
    let follow = head.scene.look.follow_strands as usize;
    let light = Linear::of(&layers).pixels;
    let luminance =
        |pixel: usize| light[pixel].dot(Vec3::new(0.2126, 0.7152, 0.0722)) / mask[pixel].max(1e-3);
    let hair: Vec<(usize, Vec3)> = (0..SIZE * SIZE)
        .filter(|pixel| mask[*pixel] >= 0.5)
        .map(|pixel| (pixel, place(camera, pixel, depth[pixel])))
        .collect();
    let top = hair.iter().map(|(_, place)| place.y).fold(f32::MIN, f32::max);
    let crown = hair.iter().filter(|(_, place)| place.y > top - CROWN);
    let mut crown: Vec<f32> = crown.map(|(pixel, _)| luminance(*pixel)).collect();
    crown.sort_by(f32::total_cmp);
    let median = crown[crown.len() / 2];
    let is_root = |pixel: usize, place: Vec3| {
        let strand = id[pixel] as usize;
        strand > 0 && head.roots[(strand - 1) / follow].distance(place) < ROOT
    };
    let mut roots: Vec<(usize, Vec3)> =
        hair.iter().copied().filter(|(pixel, at)| is_root(*pixel, *at)).collect();
    let all = roots.len();
    // A highlight of smooth hair runs on beyond the roots; a comb of bright roots ends with them.
    let beyond: Vec<(Vec3, f32)> = hair
        .iter()
        .filter(|(pixel, at)| !is_root(*pixel, *at))
        .map(|(pixel, at)| (*at, luminance(*pixel)))
        .collect();
    let brightest_beside = |place: Vec3| {
        let near = beyond.iter().filter(|(other, _)| other.distance(place) < BESIDE);
        let mut near: Vec<f32> = near.map(|(_, light)| *light).collect();
        near.sort_by(f32::total_cmp);
        near.get(near.len() * 9 / 10).copied().unwrap_or(median)
    };
    roots.retain(|(pixel, at)| {
        let light = luminance(*pixel);
        light > 3.0 * median && light > OVER * brightest_beside(*at)
    });
    let from = camera.position;
    let name = format!("{}_{:.1}_{:.1}_{:.1}", head.scene.style.style.name(), from.x, from.y, from.z);
    let mut shown = Linear::of(&layers);
    shown.save(&format!("light_{name}"), 1.0);
    roots.iter().for_each(|(pixel, _)| shown.pixels[*pixel] = Vec3::X);
    shown.save(&format!("roots_{name}"), 1.0);
    [hair.len(), all, roots.len()]
}

#[test]
fn bright_roots_are_counted_beside_the_crown() {
    let panel =
        |x: f32, y: f32, z: f32| vec![Light { position: Vec3::new(x, y, z), ..Light::studio(Vec3::ZERO)[0] }];
    let lights = [
        panel(-0.9, 1.1, 1.35),
        panel(0.3, 0.9, -1.4),
        panel(0.0, 1.7, 0.1),
        Light::studio(Vec3::ZERO).to_vec(),
        Light::three_point(Vec3::ZERO).to_vec(),
    ];
    let six = [Style::Bob, Style::Long, Style::Wavy, Style::Curly, Style::Pixie, Style::Ponytail];
    let (styles, lights, view_count) =
        if in_full() { (&six[..], &lights[..], 7) } else { (&six[..1], &lights[2..3], 1) };
    let mut shares = Vec::new();
    for style in styles {
        let mut head = Head::new(*style);
        let (mut hair, mut roots, mut any) = (0, 0, 0);
        for camera in views(view_count) {
            for lights in lights {
                let found = bright(&mut head, BLACK, &camera, lights);
                (hair, any, roots) = (hair + found[0], any + found[1], roots + found[2]);
            }
        }
        assert!(any > 0, "no root is seen at all");
        println!("{}: {roots} of {hair} pixels are bright roots, of {any} of roots", style.name());
        shares.push((*style, roots as f32 / hair as f32));
    }
    // 1.7 % were seen of a bob with a light above it; path tracing has no fewer (heads.rs). Over all views and lights it is
    // at most .28 %.
    let most = if in_full() { 0.004 } else { 0.02 };
    assert!(shares.iter().all(|(_, share)| *share <= most), "{shares:?}");
    // Lit skin between the hairs of a parting counts as roots that are too bright.
    let [hair, _, roots] =
        bright(&mut Head::new(Style::Bob), BodyLook::default(), &views(1)[1], &panel(0.0, 1.7, 0.1));
    assert!(roots as f32 > 0.01 * hair as f32, "the comparison can fail: {roots} of {hair}");
}

#[test]
fn skin_among_roots_lights_hair_as_dark_as_it_is_drawn() {
    // Combed back over a lit forehead, seen from 45 cm.
    let mut head = Head::of(Style::Ponytail, 500);
    let from = 0.45 * Vec3::new(0.0, 1.0, 0.5).normalize();
    let camera = Camera { position: from, target: Vec3::new(0.0, 0.05, 0.0), ..Camera::front() };
    let (look, lights) = (head.scene.look.clone(), Light::studio(Vec3::ZERO));
    let mut light = |scalp: f32| {
        head.hair.set_body_look(BodyLook { scalp, ..BodyLook::default() }).unwrap();
        let layers = head.seen(&camera, &look, &lights);
        let [mask, depth, id] = ["mask.hair", "depth.Z", "strand.id"].map(|name| channel(&layers, name));
        let root = |pixel: usize| head.roots[(id[pixel] as usize - 1) / look.follow_strands as usize];
        let is_root = |pixel: &usize| {
            mask[*pixel] >= ALONE && root(*pixel).distance(place(&camera, *pixel, depth[*pixel])) < ROOT
        };
        let pixels = Linear::of(&layers).pixels;
        let found: Vec<f32> = (0..SIZE * SIZE).filter(is_root).map(|pixel| pixels[pixel].x).collect();
        assert!(found.len() > 100, "{} pixels of roots", found.len());
        found.iter().sum::<f32>() / found.len() as f32
    };
    let [bare, dark] = [0.0, 1.0].map(&mut light);
    println!("{bare} {dark}");
    assert!(dark < 0.9 * bare, "{dark} on a scalp of the colour of hair, {bare} on bare skin");
}
