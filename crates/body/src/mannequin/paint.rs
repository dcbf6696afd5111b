//! Colours of the skin by place, as factors of the body's colour.

use glam::{Vec2, Vec3};

use super::shape::BustShape;

/// Factors, linear RGB: red of the lips, of cheeks, nose and ears, of the corners of the eye; brows; lashes; hollows.
const LIPS: Vec3 = Vec3::new(0.86, 0.58, 0.58);
const FLUSH: Vec3 = Vec3::new(1.05, 0.86, 0.84);
const RIM: Vec3 = Vec3::new(0.92, 0.66, 0.64);
const BROWS: Vec3 = Vec3::new(0.16, 0.13, 0.115);
const LASHES: Vec3 = Vec3::new(0.10, 0.085, 0.08);
const HOLLOW: Vec3 = Vec3::new(0.26, 0.15, 0.14);
/// Places that are flushed: centre \[m\] on the side of positive x, radius \[m\], and share.
const FLUSHED: [(Vec3, f32, f32); 2] =
    [(Vec3::new(0.044, -0.046, 0.080), 0.024, 0.75), (Vec3::new(0.0, -0.048, 0.112), 0.015, 0.7)];
/// The same of an ear, and how far from the middle \[m\] it begins and stands off the head: skin beside it has none.
const EAR_FLUSH: (Vec3, f32, f32) = (Vec3::new(0.086, -0.030, -0.010), 0.036, 0.9);
const EAR_BASE: [f32; 2] = [0.077, 0.086];
/// Bottom of the ear's hollow \[m\].
const CONCHA: Vec3 = Vec3::new(0.0815, -0.0370, -0.0020);
/// Middle line of a brow, from its inner end: x and y \[m\]; and its greatest half width.
const BROW: [Vec2; 5] = [
    Vec2::new(0.0125, -0.0005),
    Vec2::new(0.0220, 0.0030),
    Vec2::new(0.0330, 0.0058),
    Vec2::new(0.0430, 0.0050),
    Vec2::new(0.0520, 0.0000),
];
const BROW_WIDTH: f32 = 0.0042;
/// The mouth: half of its width, height of its line in the middle \[m\].
pub(super) const MOUTH: [f32; 2] = [0.0255, -0.0775];

/// Factor of the skin's colour at a place on it \[m\], linear RGB.
pub(super) fn factor(shape: &BustShape, point: Vec3) -> Vec3 {
    let half = Vec3::new(point.x.abs(), point.y, point.z);
    let mut color = Vec3::splat(1.0 + 0.05 * mottled(point * 90.0) + 0.04 * mottled(point * 260.0));
    for (center, radius, share) in FLUSHED {
        let near = 1.0 - smooth(half.distance(center), 0.2 * radius, radius);
        color *= Vec3::ONE.lerp(FLUSH, near * share);
    }
    let (ear, radius, share) = EAR_FLUSH;
    let near = 1.0 - smooth(half.distance(ear), 0.2 * radius, radius);
    color *= Vec3::ONE.lerp(FLUSH, near * share * smooth(half.x, EAR_BASE[0], EAR_BASE[1]));
    color *= Vec3::ONE.lerp(HOLLOW, 0.55 * (1.0 - smooth(half.distance(CONCHA), 0.0030, 0.0095)));
    if point.z < 0.05 {
        return color;
    }
    color *= Vec3::ONE.lerp(LIPS, lips(half));
    let nostril = half.distance(super::proportions::NOSTRIL);
    color *= Vec3::ONE.lerp(HOLLOW, 1.0 - smooth(nostril, 0.0026, 0.0050));
    color *= Vec3::ONE.lerp(BROWS, 0.8 * brow(half, point.x.signum()));
    let eye = &shape.eye;
    if half.distance(eye.center) < 1.6 * eye.radius {
        let (into, _) = eye.opening(half);
        let above = if half.y > eye.center.y { 1.0 } else { 0.45 };
        color *= Vec3::ONE.lerp(RIM, 1.0 - smooth(into.abs(), 0.0, 0.0035));
        color *= Vec3::ONE.lerp(LASHES, above * (1.0 - smooth((into + 0.0002).abs(), 0.0003, 0.0013)));
    }
    color
}

/// Share of red of the lips.
fn lips(half: Vec3) -> f32 {
    let [width, middle] = MOUTH;
    let across = half.x / width;
    if across >= 1.0 || (half.y - middle).abs() > 0.02 {
        return 0.0;
    }
    let arch = 1.0 - across * across;
    let line = middle - 2.5 * half.x * half.x;
    // The bow dips in the middle of the upper lip.
    let bow = 0.0078 * arch - 0.0016 * (1.0 - smooth(half.x, 0.0, 0.006));
    let edge = if half.y > line { bow - (half.y - line) } else { 0.0095 * arch.sqrt() - (line - half.y) };
    smooth(edge, -0.0004, 0.0016)
}

/// Share of hair of a brow.
fn brow(half: Vec3, side: f32) -> f32 {
    let place = half.truncate();
    let mut nearest = (f32::MAX, 0.0);
    for (index, ends) in BROW.windows(2).enumerate() {
        let way = ends[1] - ends[0];
        let along = ((place - ends[0]).dot(way) / way.length_squared()).clamp(0.0, 1.0);
        let off = place.distance(ends[0] + way * along);
        if off < nearest.0 {
            nearest = (off, (index as f32 + along) / (BROW.len() - 1) as f32);
        }
    }
    let (off, along) = nearest;
    let width =
        BROW_WIDTH * (0.62 + 0.38 * smooth(along, 0.0, 0.30)) * (1.0 - 0.72 * smooth(along, 0.45, 1.0));
    // Streaks along hairs that rise outward.
    let streak =
        Vec3::new(1100.0 * (0.8 * half.x - 0.6 * half.y), 220.0 * (0.6 * half.x + 0.8 * half.y), side);
    let ragged = 0.68 + 0.32 * mottled(streak);
    // Few hairs at the inner end, and a tail that fades.
    let inner = smooth(half.x, BROW[0].x - 0.0030, BROW[0].x + 0.0085);
    let dense = inner * (1.0 - 0.6 * smooth(along, 0.6, 1.0));
    ragged * dense * (1.0 - smooth(off, 0.15 * width, 1.45 * width))
}

/// Smooth noise over the lattice of whole numbers, -1 to 1.
fn mottled(place: Vec3) -> f32 {
    let (cell, share) = (place.floor(), place - place.floor());
    let share = share * share * (Vec3::splat(3.0) - 2.0 * share);
    let mut sum = 0.0;
    for corner in 0..8_u32 {
        let step = Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32);
        let weights = share * step + (Vec3::ONE - share) * (Vec3::ONE - step);
        sum += weights.element_product() * at_corner(cell + step);
    }
    sum
}

/// Random number of a corner of the lattice, -1 to 1.
fn at_corner(corner: Vec3) -> f32 {
    let mut bits = 0x9e37_79b9_u32;
    for part in corner.to_array() {
        bits = (bits ^ (part as i32 as u32)).wrapping_mul(0x85eb_ca6b);
        bits ^= bits >> 15;
    }
    (bits & 0xffff) as f32 / 32767.5 - 1.0
}

/// From 0 at one value to 1 at a higher one, level at both ends.
pub(super) fn smooth(value: f32, from: f32, to: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
