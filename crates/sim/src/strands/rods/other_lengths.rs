//! Rods of other lengths than at rest: a cut strand keeps the shape of the rest of it.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::hairs::Hairs;
use super::joint::{Joint, Segment};
use super::real::{Real, Vector};
use super::rest::{Former, across, segments};
use super::rod::Node;

/// Strands at rest and with their lengths now, shapes `[block][point]` of lanes.
pub(crate) struct Lengthened<'a> {
    pub points_per_strand: usize,
    /// Positions at rest \[m\].
    pub positions: &'a [Vec3Lanes],
    /// Lengths of segments at rest, and now \[m\].
    pub rest: &'a [Lanes],
    pub now: &'a [Lanes],
    /// Masses of points now \[kg\].
    pub mass: &'a [Lanes],
    /// Load of the rest shape \[m/s^2\]; `None` for a rest shape without moments.
    pub gravity: Option<Vec3>,
    pub hairs: &'a Hairs,
}

impl Lengthened<'_> {
    /// Changes nodes: stiffness follows the lengths; curvatures and twists per length stay. The new rest shape carries the
    /// weight that is left, so that hair without its tips does not spring up.
    pub fn change(&self, nodes: &mut [Node<f32x8>]) {
        let points = self.points_per_strand;
        nodes.par_chunks_mut(points).enumerate().for_each(|(block, nodes)| {
            let range = block * points..(block + 1) * points;
            let (rest, now) = (&self.rest[range.clone()], &self.now[range.clone()]);
            if rest == now {
                return;
            }
            let factors = follow_lengths(nodes, rest, now, &self.mass[range.clone()]);
            let Some(gravity) = self.gravity else { return };
            for lane in (0..LANES).filter(|lane| (0..points).any(|k| rest[k].0[*lane] != now[k].0[*lane])) {
                let former = self.hairs.former(block * LANES + lane);
                carry_weight((gravity, former), &self.positions[range.clone()], now, &factors, lane, nodes);
            }
        });
    }
}

/// Largest growth of bending over inertia where segments are shorter than at rest. The ratio grows with the fourth power
/// of the shortening, and single precision does not carry a factor of 160,000. Only the segments at a cut end, a twentieth
/// as long, are softer than they should be.
const STIFFEST: f64 = 16.0;

/// Gives eight strands segments of other lengths \[m\] than at rest: curvatures and twists per length stay, masses
/// \[kg\] and stiffness follow. Returns the factor of the strains of each joint.
fn follow_lengths(
    nodes: &mut [Node<f32x8>],
    rest: &[Lanes],
    lengths: &[Lanes],
    mass: &[Lanes],
) -> Vec<f32x8> {
    let (zero, one) = (f32x8::ZERO, f32x8::of(1.0));
    let last = nodes.len() - 1;
    // Contribution of a segment to the cells of the joints beside it; that of a rigid one is zero.
    let free: Vec<_> = nodes.iter().map(|node| node.free_angle).collect();
    let turning = |lanes: &[Lanes], index: usize| free[index].choose(f32x8::new(lanes[index].0), zero);
    let mut factors = vec![one; nodes.len()];
    for (index, node) in nodes.iter_mut().enumerate() {
        node.mass = f32x8::new(mass[index].0);
        if index < last {
            let ratio = f32x8::new(lengths[index].0) / f32x8::new(rest[index].0);
            node.length *= ratio;
            node.inertia *= ratio;
            node.stretch *= ratio.or_less(one);
        }
        if index > 0 && index < last {
            let cell = turning(rest, index - 1) + turning(rest, index);
            let now = turning(lengths, index - 1) + turning(lengths, index);
            let factor = cell.choose(now / cell, one);
            let stiffer = (one / factor).or_less(f32x8::of(STIFFEST) * factor * factor * factor);
            node.stiffness = node.stiffness.map(|stiffness| stiffness * stiffer);
            node.rest = node.rest.map(|strain| strain * factor);
            factors[index] = factor;
        }
    }
    factors
}

/// Makes the shape of a strand the equilibrium under the weight that it has now.
fn carry_weight(
    (gravity, former): (Vec3, Former),
    positions: &[Vec3Lanes],
    lengths: &[Lanes],
    factors: &[f32x8],
    lane: usize,
    nodes: &mut [Node<f32x8>],
) {
    let points: Vec<Vector<f64>> = positions.iter().map(|lanes| lanes.get(lane).into()).collect();
    let at_rest = segments(&points, across(&points));
    let number = |lanes: f32x8| f64::from(lanes.to_array()[lane]);
    let (points, segments) =
        shape(points[0], &at_rest, |index| f64::from(lengths[index].0[lane]), |joint| number(factors[joint]));
    let mut rod: Vec<Node<f64>> = nodes.iter().map(|node| node.map(number)).collect();
    former.sag_free(&mut rod, &points, &segments, gravity);
    for (node, one) in nodes.iter_mut().zip(&rod) {
        let set = |lanes: &mut f32x8, number: f64| lanes.as_mut_array()[lane] = number as f32;
        set(&mut node.length, one.length);
        for axis in 0..3 {
            set(&mut node.stiffness[axis], one.stiffness[axis]);
            set(&mut node.rest[axis], one.rest[axis]);
        }
    }
}

/// Points and segments of a strand with the given lengths of segments \[m\] and the strains of `segments` times a factor
/// for each joint.
fn shape(
    root: Vector<f64>,
    segments: &[Segment<f64>],
    length: impl Fn(usize) -> f64,
    factor: impl Fn(usize) -> f64,
) -> (Vec<Vector<f64>>, Vec<Segment<f64>>) {
    let mut shape = vec![Segment { length: length(0), ..segments[0] }];
    for joint in 1..segments.len() {
        let (lower, upper, now) = (&segments[joint - 1], &segments[joint], shape[joint - 1]);
        // Half of the curvature binormal in the section of the segment before: a rotation by its half-angle form.
        let sum = (1.0 + lower.tangent.dot(upper.tangent)).max(1e-3);
        let half = lower.tangent.cross(upper.tangent) * (factor(joint) / sum);
        let half = now.across * half.dot(lower.across) + now.second() * half.dot(lower.second());
        let aside = half.cross(now.tangent);
        let tangent = now.tangent + (aside + half.cross(aside)) * (2.0 / (1.0 + half.dot(half)));
        let [_, _, twist] = Joint::new(lower, upper).strains;
        shape.push(now.moved(tangent * length(joint), twist * factor(joint)));
    }
    let mut points = vec![root];
    for (index, segment) in shape.iter().enumerate() {
        points.push(points[index] + segment.tangent * segment.length);
    }
    (points, shape)
}
