//! The eyeballs as solids of their own: drawn in the openings of the lids, with colours by place.

use std::f32::consts::{PI, TAU};

use glam::{Vec3, Vec4};
use strandline_base::math;

use super::eye::Eye;
use super::paint::smooth;

/// Radius \[m\] of the iris's rim and of the pupil.
const IRIS: f32 = 0.0059;
const PUPIL: f32 = 0.0019;
/// Height \[m\] of the cornea over the ball.
const CORNEA: f32 = 0.0010;
/// The drawn ball is this much \[m\] larger than the skin's.
const OVER: f32 = 0.0003;
/// Divisions around the axis of sight, and from the pupil to the back.
const TURNS: usize = 96;
const RINGS: usize = 64;
/// Linear RGB: white of the eye, its red corners, iris from pupil to rim, and the ring about it.
const WHITE: Vec3 = Vec3::new(0.62, 0.56, 0.52);
const CORNER: Vec3 = Vec3::new(0.42, 0.20, 0.17);
const IRIS_INNER: Vec3 = Vec3::new(0.165, 0.085, 0.032);
const IRIS_OUTER: Vec3 = Vec3::new(0.095, 0.052, 0.026);
const RING: Vec3 = Vec3::new(0.020, 0.014, 0.011);
const BLACK: Vec3 = Vec3::new(0.003, 0.003, 0.003);

/// A ball: positions \[m\], unit normals, colours, triangles. The side is 1 or -1.
pub(super) struct Eyeball {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) colors: Vec<Vec4>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The eyeball of one side, 1 or -1 along x.
pub(super) fn eyeball(eye: &Eye, side: f32) -> Eyeball {
    let mut ball = Eyeball { positions: vec![], normals: vec![], colors: vec![], triangles: vec![] };
    for ring in 0..=RINGS {
        let turns = if ring == 0 || ring == RINGS { 1 } else { TURNS };
        for turn in 0..turns {
            let around = turn as f32 / TURNS as f32 * TAU;
            let (offset, normal) = surface(eye, angle(ring), around);
            let point = eye.center + offset;
            ball.positions.push(point * Vec3::new(side, 1.0, 1.0));
            ball.normals.push(normal * Vec3::new(side, 1.0, 1.0));
            ball.colors.push(color(eye, point, around).extend(1.0));
        }
    }
    let at = |ring: usize, turn: usize| match ring {
        0 => 0,
        RINGS => (1 + (RINGS - 1) * TURNS) as u32,
        _ => (1 + (ring - 1) * TURNS + turn % TURNS) as u32,
    };
    let mut push = |corners: [u32; 3]| {
        let [a, b, c] = corners;
        ball.triangles.push(if side > 0.0 { [a, b, c] } else { [a, c, b] });
    };
    for turn in 0..TURNS {
        push([at(0, 0), at(1, turn), at(1, turn + 1)]);
        push([at(RINGS, 0), at(RINGS - 1, turn + 1), at(RINGS - 1, turn)]);
        for ring in 1..RINGS - 1 {
            push([at(ring, turn), at(ring + 1, turn), at(ring, turn + 1)]);
            push([at(ring, turn + 1), at(ring + 1, turn), at(ring + 1, turn + 1)]);
        }
    }
    ball
}

/// Angle \[rad\] of a ring from the axis of sight: a third of all rings lie within the iris.
fn angle(ring: usize) -> f32 {
    let share = ring as f32 / RINGS as f32;
    PI * math::powf(share, 1.6)
}

/// Offset \[m\] from the centre and unit normal of a place of the ball.
fn surface(eye: &Eye, angle: f32, around: f32) -> (Vec3, Vec3) {
    let (sine, cosine) = math::sin_cos(angle);
    let (up, right) = math::sin_cos(around);
    let direction = Vec3::new(sine * right, sine * up, cosine);
    let radius = eye.radius + OVER;
    let off = radius * sine / (1.1 * IRIS);
    let inside = if cosine > 0.0 { (1.0 - off * off).max(0.0) } else { 0.0 };
    // The cornea rises from the white without a step.
    let height = CORNEA * inside * inside;
    let slope = -4.0 * CORNEA * inside * off / (1.1 * IRIS);
    let outward = Vec3::new(right, up, 0.0);
    let normal = (direction - (outward - direction * sine) * slope).normalize_or(direction);
    (direction * (radius + height), normal)
}

/// Colour of a place of the eye, linear RGB; darker under the upper lid, whose lashes shade it.
fn color(eye: &Eye, point: Vec3, around: f32) -> Vec3 {
    let offset = point - eye.center;
    if offset.z <= 0.0 {
        return WHITE;
    }
    let off = offset.truncate().length();
    let corner = smooth(off, 0.6 * eye.half_width, eye.half_width);
    let white = WHITE.lerp(CORNER, corner);
    let iris = IRIS_INNER.lerp(IRIS_OUTER, smooth(off, 0.45 * IRIS, IRIS)) * fibres(around, off);
    let iris = iris.lerp(RING, smooth(off, 0.80 * IRIS, 0.97 * IRIS));
    let eye_color = BLACK.lerp(iris, smooth(off, PUPIL - 0.00015, PUPIL + 0.00025));
    let all = eye_color.lerp(white, smooth(off, IRIS - 0.0003, IRIS + 0.0005));
    let (into, _) = eye.opening(point);
    let lid = if offset.y > 0.0 { 0.55 } else { 0.85 };
    all * (lid + (1.0 - lid) * smooth(into, -0.0005, 0.0028))
}

/// Brightness of the fibres of the iris, about 1.
fn fibres(around: f32, off: f32) -> f32 {
    let wave = |count: f32, phase: f32| math::sin_cos(around * count + phase + 400.0 * off).0;
    1.0 + 0.16 * wave(23.0, 0.4) + 0.12 * wave(37.0, 2.1) + 0.10 * wave(11.0, 4.0)
}
