//! Hair of the face: beard and brows, short strands about roots of their own, and lashes.

use glam::{Vec2, Vec3};
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_body::{Random, Root, SignedDistance};

use super::comb::smooth;
use super::lashes;
use super::skin::Skin;
use super::strand::{CLEARANCE, Strand};
use super::{Style, StyleSettings};

/// Places that are tried for each root at most.
const TRIALS: usize = 400;
/// Middle of the jaw \[m\], from which roots of a beard are seen.
const JAW: Vec3 = Vec3::new(0.0, -0.060, 0.010);
/// Inner and outer end of a brow on the side of positive x, half its breadth, and the height of its arch \[m\].
const BROW: ([Vec2; 2], f32, f32) = ([Vec2::new(0.013, 0.000), Vec2::new(0.052, 0.001)], 0.0042, 0.0065);
/// Share of the length of a brow along which it grows dense: times .35 in the middle of its breadth, 1.35 at its edges.
const BROW_BEGINS: f32 = 0.22;

/// Height \[m\] by which the border of a beard on the cheek is uneven.
const UNEVEN: f32 = 0.0016;

/// Grows strands of the face.
pub(super) fn strands(settings: &StyleSettings, skin: &Skin, count: usize) -> Vec<Strand> {
    let strand = |index: usize| match settings.style {
        Style::Lashes => lashes::strand(settings, skin, index),
        _ => strand(settings, skin, index),
    };
    (0..count).into_par_iter().map(strand).collect()
}

/// One strand: along the skin as its style combs it, a little off it.
fn strand(settings: &StyleSettings, skin: &Skin, index: usize) -> Strand {
    let (root, thin) = root(settings, skin, index);
    let mut random = Random::new(settings.seed, 12_000_000_000 + index as u64);
    let shorter = settings.length_variation * random.unit();
    let length = settings.length * (1.0 - shorter) * (0.5 + 0.5 * thin);
    let side = root.position.x.signum();
    let wanted = match settings.style {
        Style::Brows => {
            let along = ((root.position.x.abs() - 0.013) / 0.039).clamp(0.0, 1.0);
            Vec3::new(side * (0.35 + along), 1.1 * (1.0 - along) - 0.25, -0.2)
        }
        _ => Vec3::new(0.25 * root.position.x / 0.06, -1.0, 0.15),
    };
    let jitter = Vec3::new(random.signed(), random.signed(), random.signed());
    let flow = wanted.normalize_or(Vec3::NEG_Y) + settings.noise / settings.length * 2.0 * jitter;
    let (curl, phase) = (settings.curl_radius, std::f32::consts::TAU * random.unit());
    let lift = settings.volume * (0.4 + 0.6 * random.unit()) / settings.length;
    let last = settings.points() - 1;
    let step = length / last as f32;
    let across = flow.cross(root.normal).normalize_or(Vec3::X);
    let mut points = vec![root.position];
    let mut point = root.position;
    let mut above = skin.mannequin().distance_and_gradient(point);
    for index in 1..=last {
        let out = above.1;
        let share = index as f32 / last as f32;
        let along = (flow - out * flow.dot(out)).normalize_or(flow);
        let way = along + out * lift * (1.4 - share);
        let angle = phase + std::f32::consts::TAU * share * length / settings.curl_length;
        let turn = curl * std::f32::consts::TAU / settings.curl_length;
        let curled = turn * (math::cos(angle) * across - math::sin(angle) * out);
        let next = point + (way + curled).normalize_or(way) * step;
        (point, above) = skin.led_outside(next, 0.6 * CLEARANCE);
        points.push(point);
    }
    Strand { root, side, points }
}

/// A root in the region of the style, and the thickness of the hair there, 0 to 1.
fn root(settings: &StyleSettings, skin: &Skin, index: usize) -> (Root, f32) {
    let mut random = Random::new(settings.seed, 11_000_000_000 + index as u64);
    let mut found = (Root { position: JAW, normal: Vec3::Z, uv: Vec2::ZERO }, 0.0);
    for _ in 0..TRIALS {
        let [first, second, chance, side] = std::array::from_fn(|_| random.unit());
        let side = if side < 0.5 { -1.0 } else { 1.0 };
        let mut across = (0.0, 0.0);
        let (start, way) = match settings.style {
            Style::Brows => {
                let ([inner, outer], breadth, arch) = BROW;
                let middle = inner.lerp(outer, first) + Vec2::Y * arch * math::sin(2.2 * first);
                let aside = breadth * (2.0 * second - 1.0) * (1.0 - 0.75 * first * first);
                across = (first, 2.0 * second - 1.0);
                (Vec3::new(side * middle.x, middle.y + aside, 0.16), Vec3::NEG_Z)
            }
            _ => {
                let (sine, cosine) = math::sin_cos(side * 1.55 * first);
                let (rise, flat) = math::sin_cos(1.55 * second - 1.05);
                let out = Vec3::new(sine * flat, rise, cosine * flat);
                (JAW + 0.2 * out, -out)
            }
        };
        let Some(position) = skin.first_along(start, way) else { continue };
        let (position, normal) = skin.mannequin().nearest_skin(position);
        let thick = match settings.style {
            Style::Brows => browed(across),
            _ => bearded(position, normal),
        };
        let uv = Vec2::new(0.5 + 2.0 * position.x, 0.5 + 2.0 * position.y).clamp(Vec2::ZERO, Vec2::ONE);
        found = (Root { position, normal, uv }, thick);
        if thick > chance {
            break;
        }
    }
    found
}

/// Density of a brow at a share of its length from the inner end on and of half its breadth, 0 to 1. The inner end is round
/// and thin, and so are both edges.
fn browed((along, aside): (f32, f32)) -> f32 {
    let [begins, edge] = [BROW_BEGINS * (0.35 + aside * aside), aside.abs()];
    smooth(0.0, begins, along) * smooth(1.1, 0.6, edge)
}

/// Density of a beard at a place of the face \[m\], 0 to 1.
fn bearded(place: Vec3, normal: Vec3) -> f32 {
    let aside = place.x.abs();
    // From below the nose over the corner of the mouth and the cheek to the ear; no two centimetres of it are alike.
    let cheek = smooth(0.030, 0.068, aside);
    let uneven =
        math::sin(310.0 * place.x + 170.0 * place.z) + 0.6 * math::sin(730.0 * place.x - 520.0 * place.z);
    let upper = if aside < 0.028 { -0.0605 } else { -0.066 + 0.040 * cheek } + UNEVEN * cheek * uneven;
    let lips = Vec2::new(place.x / 0.026, (place.y + 0.0785) / 0.0085).length();
    let free = smooth(0.9, 1.25, lips);
    let above_neck = smooth(-0.136, -0.114, place.y) * smooth(-0.97, -0.80, normal.y);
    let before_ear = smooth(-0.004, 0.024, place.z);
    // Hair hides skin long before it is dense: most of the border is thin.
    let border = smooth(upper + 0.004 + 0.008 * cheek, upper - 0.010 - 0.006 * cheek, place.y)
        * above_neck
        * before_ear;
    border * border * free
}
