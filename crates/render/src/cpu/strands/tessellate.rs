//! `tessellate`: a smooth curve through each guide's points, with a frame along it.
//!
//! The curve is a uniform cubic B-spline [Chen2011 §3.1, appendix C]. Its control points are the
//! guide's points, each moved out of its bend by a sixth of the second difference: the
//! quasi-interpolant that gives cubics back exactly [deBoor2001 chapter XII]. With the points themselves as
//! control points the curve would cut every bend, by 5 mm where points 5 cm apart lie on a skull, and
//! run inside the head. At each end one more point continues the polygon (2 P0 - P1), so that
//! the curve starts and ends at the guide's ends.

use glam::{Quat, Vec3};
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::Vec3x8;
use strandline_groom::{Guides, LANES, LaneSet, Vec3Lanes, block_count};
use wide::f32x8;

use crate::DetailLevel;
use crate::strands::curve::{Tap, skin_axes, taps};
use crate::strands::roots::RootTurn;

/// The drawn guides ([`DetailLevel::drawn_lanes`]) as smooth curves, all of the same number of points, root first.
///
/// Shapes are `[block][point]` of lanes, one guide a lane.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// Number of guides.
    pub guide_count: usize,
    /// Points on each curve, one more than its segments.
    pub points_per_curve: usize,
    /// Parameter of each point, 0 at the root to 1 at the tip, shape `[point]`.
    pub parameters: Vec<f32>,
    /// Positions \[m\], world space.
    pub positions: Vec<Vec3Lanes>,
    /// Unit tangents, root to tip, world space.
    pub tangents: Vec<Vec3Lanes>,
    /// Unit vectors across the curve that turn as little as they can along it, world space.
    pub normals: Vec<Vec3Lanes>,
    taps: Vec<Tap>,
}

impl Curves {
    /// Position, tangent and normal of one point.
    pub fn point(&self, guide: usize, point: usize) -> [Vec3; 3] {
        let index = guide / LANES * self.points_per_curve + point;
        let lane = guide % LANES;
        [&self.positions, &self.tangents, &self.normals].map(|values| values[index].get(lane))
    }

    fn resize(&mut self, guides: &Guides, level: &DetailLevel) {
        self.guide_count = level.drawn_lanes().count_of(guides.strand_count());
        self.points_per_curve = level.segment_count(guides.points_per_strand()) + 1;
        self.taps.clear();
        self.parameters.clear();
        for (tap, parameter) in taps(guides.points_per_strand(), level) {
            self.taps.push(tap);
            self.parameters.push(parameter);
        }
        let size = block_count(self.guide_count) * self.points_per_curve;
        self.positions.resize(size, Vec3Lanes::default());
        self.tangents.resize(size, Vec3Lanes::default());
        self.normals.resize(size, Vec3Lanes::default());
    }
}

/// Draws a smooth curve through every guide that is drawn.
///
/// `positions` are the points of those \[m\] in world space, shape `[block][point]` of lanes;
/// `guides` gives the number of all and the skin normals at the roots, which `turns` takes into the world.
pub fn tessellate(
    positions: &[Vec3Lanes],
    guides: &Guides,
    turns: &impl RootTurn,
    level: &DetailLevel,
    out: &mut Curves,
) {
    let points_per_strand = guides.points_per_strand();
    out.resize(guides, level);
    assert_eq!(positions.len(), block_count(out.guide_count) * points_per_strand);
    let (count, drawn) = (out.points_per_curve, (level.drawn_lanes(), out.guide_count));
    let taps = &out.taps;
    out.positions
        .par_chunks_mut(count)
        .zip_eq(out.tangents.par_chunks_mut(count))
        .zip_eq(out.normals.par_chunks_mut(count))
        .zip_eq(positions.par_chunks(points_per_strand))
        .enumerate()
        .for_each(|(block, (((positions, tangents), normals), points))| {
            spline(points, taps, positions, tangents);
            normals[0] = root_axes(guides, drawn, turns, block, &tangents[0]);
            carry_frame(positions, tangents, normals);
        });
}

/// Positions and unit tangents of a block's curves.
fn spline(points: &[Vec3Lanes], taps: &[Tap], positions: &mut [Vec3Lanes], tangents: &mut [Vec3Lanes]) {
    let last = points.len() - 1;
    let point = |index: usize| Vec3x8::load(&points[index]);
    let bent = |index: usize| {
        if index == 0 || index == last {
            return point(index);
        }
        let second_difference = point(index - 1) - point(index) * f32x8::splat(2.0) + point(index + 1);
        point(index) - second_difference * f32x8::splat(1.0 / 6.0)
    };
    let control = |index: usize| match index {
        0 => bent(0) * f32x8::splat(2.0) - bent(1),
        _ if index == last + 2 => bent(last) * f32x8::splat(2.0) - bent(last - 1),
        _ => bent(index - 1),
    };
    // Coincident points take the tangent of the point before.
    let mut fallback = Vec3x8::splat(Vec3::Y);
    for ((tap, position), tangent) in taps.iter().zip(positions).zip(tangents) {
        let mut point = Vec3x8::splat(Vec3::ZERO);
        let mut direction = Vec3x8::splat(Vec3::ZERO);
        for offset in 0..4 {
            let control = control(tap.first + offset);
            point += control * f32x8::splat(tap.position[offset]);
            direction += control * f32x8::splat(tap.tangent[offset]);
        }
        fallback = direction.normalize_or(fallback);
        point.store(position);
        fallback.store(tangent);
    }
}

/// An axis of each root's frame, across its tangent: an axis in the skin, turned the way that takes
/// the skin normal to the tangent. It is fixed to the skin and never spins about a moving strand.
fn root_axes(
    guides: &Guides,
    (lanes, guide_count): (LaneSet, usize),
    turns: &impl RootTurn,
    block: usize,
    tangents: &Vec3Lanes,
) -> Vec3Lanes {
    let mut axes = Vec3Lanes::default();
    for lane in 0..LANES {
        let guide = lanes.strand((block * LANES + lane).min(guide_count - 1));
        let [normal, axis, _] = skin_frame(guides.root_normals()[guide], turns.turn(guide));
        axes.set(lane, turn_along(normal, tangents.get(lane), axis));
    }
    axes
}

/// The skin's frame at a root in world space: its normal and two axes in the skin, right-handed.
pub(crate) fn skin_frame(root_normal: Vec3, turn: Quat) -> [Vec3; 3] {
    let [first, second] = skin_axes(root_normal);
    [root_normal, first, second].map(|axis| turn * axis)
}

/// Turns `vector` by the least turn that takes the unit vector `from` to the unit vector `to`.
pub(crate) fn turn_along(from: Vec3, to: Vec3, vector: Vec3) -> Vec3 {
    // A strand that grows straight into the skin has no least turn; any turn will do.
    let cosine = from.dot(to).max(-0.999);
    let axis = from.cross(to);
    let turned = vector * cosine + axis.cross(vector) + axis * (axis.dot(vector) / (1.0 + cosine));
    (turned - to * turned.dot(to)).normalize_or(to.any_orthonormal_vector())
}

/// Carries the first normal along the curves without a twist, by two reflections a point [Wang2008 table 1].
fn carry_frame(positions: &[Vec3Lanes], tangents: &[Vec3Lanes], normals: &mut [Vec3Lanes]) {
    let two = f32x8::splat(2.0);
    // Smaller squares are rounding; dividing by this instead reflects by nothing.
    let least = f32x8::splat(1e-18);
    for point in 1..positions.len() {
        let tangent = Vec3x8::load(&tangents[point - 1]);
        let normal = Vec3x8::load(&normals[point - 1]);
        let chord = Vec3x8::load(&positions[point]) - Vec3x8::load(&positions[point - 1]);
        let scale = two / chord.dot(chord).max(least);
        let left_normal = normal - chord * (scale * chord.dot(normal));
        let left_tangent = tangent - chord * (scale * chord.dot(tangent));
        let next = Vec3x8::load(&tangents[point]);
        let turn = next - left_tangent;
        let carried = left_normal - turn * (two / turn.dot(turn).max(least) * turn.dot(left_normal));
        let across = carried - next * carried.dot(next);
        across.normalize_or(normal).store(&mut normals[point]);
    }
}
