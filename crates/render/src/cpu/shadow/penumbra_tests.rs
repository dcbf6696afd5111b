//! Rays in lanes against one ray after the other, at every step.

use glam::{Vec2, Vec3};
use strandline_base::Random;

use super::penumbra::{
    BETWEEN, CORNERS, FARTHEST, FIRST_GAP, GOLDEN, LEAST_SIDE, LIFT, OTHER, PLASTIC, STEPS,
};
use super::{ShadowBody, opacity_depth::opacity_depth, opacity_layers::opacity_layers};
use crate::fast_math::exp;
use crate::shadow::{LightView, ShadowMap, Shadows, Window};
use crate::strands::Strands;
use crate::{Light, LightKind, Shadow};

/// A ray: its end in a square of side 1 about 0, and the multiple of its steps' distances.
#[derive(Clone, Copy)]
struct Ray {
    end: Vec2,
    stretch: f32,
}

impl Ray {
    fn new(ray: usize, rays: usize, [place, count]: [usize; 2]) -> Self {
        let part = |number: f32| number - number.floor();
        let across = ((ray * count + place) as f32 + 0.5) / (rays * count) as f32;
        let along = part(ray as f32 * GOLDEN + place as f32 * PLASTIC);
        let stretch = 0.75 + 0.75 * part(ray as f32 * OTHER + place as f32 * GOLDEN);
        Self { end: Vec2::new(across, along) - 0.5, stretch }
    }

    fn gap(&self, step: usize) -> f32 {
        FIRST_GAP * (1_u32 << step) as f32 * self.stretch
    }
}

/// Texels and weights where a ray from a point on the light's plane crosses a map at a step.
fn crossed(map: &ShadowMap, window: &Window, seen: Vec3, ray: Ray, step: usize) -> Vec<(usize, f32)> {
    let LightView { part, .. } = map.view;
    let side = part[0].length().min(part[1].length());
    let gap = ray.gap(step).min(FARTHEST * seen.z);
    let aside = gap / (seen.z * (seen.z - gap).max(1e-3));
    let aside = aside.max(LEAST_SIDE / (side * window.density).max(1e-12));
    let sides = part.map(|side| side * window.density);
    let at = window.texel(seen.truncate()) + (sides[0] * ray.end.x + sides[1] * ray.end.y) * aside;
    let found = map.corners(at).map(|(first, weights)| map.quad(first).into_iter().zip(weights));
    found.into_iter().flatten().collect()
}

/// Share of a ray that a map lets through to a point on its plane, off the skin and on it.
fn share(map: &ShadowMap, lifted: Vec3, seen: Vec3, ray: Ray) -> f32 {
    let mut hidden = 0.0;
    for step in 0..STEPS {
        let before = 2.0 / ray.gap(step);
        let mut hides = 0.0;
        for (texel, weight) in crossed(map, &map.body_window, lifted, ray, step) {
            let gap = lifted.z - map.body_depths[texel];
            let first = (gap - map.body_bias) * map.inverse_softness;
            let reached = if step == 0 { first } else { gap * before - 1.0 };
            let passed = if step + 1 < STEPS { gap * (0.5 * before) - 1.0 } else { 0.0 };
            let counts = if gap > map.body_bias { 1.0 } else { 0.0 };
            hides += counts * (reached.clamp(0.0, 1.0) - passed.clamp(0.0, 1.0)).max(0.0) * weight;
        }
        hidden += hides;
    }
    let mut hairs = 0.0;
    for step in 0..STEPS {
        let near = if step == 0 { 0.0 } else { BETWEEN * ray.gap(step) };
        for (texel, weight) in crossed(map, &map.hair_window, seen, ray, step) {
            let before = |gap: f32| map.crossed_in(texel, seen.z - gap);
            let far = if step + 1 < STEPS { before(BETWEEN * ray.gap(step + 1)) } else { 0.0 };
            hairs += weight * (before(near) - far);
        }
    }
    let open: f32 = 1.0 - f32::min(hidden, 1.0);
    if hairs > 0.0 { open * exp(hairs * map.log_transmission()) } else { open }
}

/// As [`ShadowMap::on_skin`].
fn on_skin(map: &ShadowMap, point: Vec3, normal: Vec3, places: [usize; 2]) -> f32 {
    let seen = map.view.project(point).unwrap();
    let texel = 1.0 / (map.view.scale(seen.z) * map.body_window.density);
    let lifted = map.view.project(point + normal * (LIFT * texel).min(map.body_bias)).unwrap();
    let rays = map.settings.rays_of(places[1]);
    let corner = |end: Vec2| share(map, lifted, seen, Ray { end, stretch: 1.0 });
    let first = corner(Vec2::ZERO);
    if rays > 5 && (first == 0.0 || first == 1.0) && CORNERS.iter().all(|end| corner(*end) == first) {
        return first;
    }
    let each = (0..rays).map(|ray| share(map, lifted, seen, Ray::new(ray, rays, places)));
    each.sum::<f32>() / rays as f32
}

/// A light above a floor with a plate and hair over a part of it.
fn maps(rays: u32) -> Shadows {
    let square = |middle: Vec3, half: f32| {
        [(-half, -half), (half, -half), (half, half), (-half, half)]
            .map(|(x, z)| middle + Vec3::new(x, 0.0, z))
    };
    let positions = [square(Vec3::ZERO, 0.3), square(Vec3::new(0.1, 0.05, 0.0), 0.05)].concat();
    let triangles = [[0, 2, 1], [0, 3, 2], [4, 6, 5], [4, 7, 6]];
    let body = ShadowBody { positions: &positions, triangles: &triangles, roots: &[], cuts: None };
    let mut strands = Strands::default();
    strands.resize(300, 1, 2);
    strands.widths.fill(2e-3);
    for (index, position) in strands.positions.iter_mut().enumerate() {
        let mut random = Random::new(3, index as u64);
        let [x, y, z] = [random.unit(), random.unit(), random.unit()];
        *position = Vec3::new(-0.15 * x, 0.002 + 0.2 * y, 0.3 * z - 0.15);
    }
    let light = Light {
        kind: LightKind::Rectangle,
        position: Vec3::new(0.3, 1.2, 0.4),
        width: 0.8,
        height: 0.4,
        samples: 2,
        ..Light::default()
    };
    let settings = Shadow { map_size: 128, rays, ..Shadow::default() };
    let mut shadows = Shadows::default();
    let lights = crate::lights::at_samples(&[light], &[]);
    opacity_depth(&strands, Some(body), &lights, Vec3::ZERO, &settings, &mut shadows);
    opacity_layers(&strands, &mut shadows);
    shadows
}

#[test]
fn rays_together_and_without_empty_steps_tell_the_bits_of_each_alone() {
    // 16 rays a place, 5 and 3, which fill no lanes.
    for rays in [64, 20, 12] {
        let shadows = maps(rays);
        let mut kinds = [0; 3];
        for index in 0..1500 {
            let mut random = Random::new(8, index);
            let point = Vec3::new(0.5 * random.unit() - 0.25, 0.0, 0.5 * random.unit() - 0.25);
            let place = index as usize % 4;
            let map = shadows.map(place).unwrap();
            let found = map.on_skin(point, Vec3::Y, [place, 4]);
            let expected = on_skin(map, point, Vec3::Y, [place, 4]);
            assert_eq!(found.to_bits(), expected.to_bits(), "{rays} {point}: {found} {expected}");
            kinds[usize::from(found > 0.0) + usize::from(found == 1.0)] += 1;
        }
        assert!(kinds[1] > 100 && kinds[2] > 100, "{kinds:?}");
    }
}

#[test]
fn the_mean_of_the_parts_is_what_all_rays_tell() {
    // 64 and 16 rays a place.
    for (rays, parts) in [(256, 4), (64, 4), (256, 16)] {
        let shadows = maps(rays);
        let (mut soft, mut apart, mut exact) = (0, 0.0_f32, 0);
        for index in 0..400 {
            let mut random = Random::new(9, index);
            let point = Vec3::new(0.5 * random.unit() - 0.25, 0.0, 0.5 * random.unit() - 0.25);
            let place = index as usize % 4;
            let map = shadows.map(place).unwrap();
            let part = |number| map.part_on_skin(point, Vec3::Y, [place, 4], [number, parts]);
            let found: Vec<f32> = (0..parts).map(part).collect();
            let all = map.on_skin(point, Vec3::Y, [place, 4]);
            let off = (found.iter().sum::<f32>() / parts as f32 - all).abs();
            // Five rays that are all plain stand for the others, found up to 0.045 beside these.
            assert!(off < 0.06, "{rays}: {found:?} {all}");
            exact += i32::from(off < 1e-6);
            soft += i32::from(all > 0.01 && all < 0.99);
            apart = found.iter().fold(apart, |apart, part| apart.max((part - all).abs()));
        }
        assert!(soft > 50 && apart > 0.02 && exact > 360, "{soft} soft, {apart}, {exact} exact");
    }
    // 5 rays cannot be parted.
    let shadows = maps(20);
    assert!(!shadows.map(0).unwrap().parts_rays(4, 4));
}
