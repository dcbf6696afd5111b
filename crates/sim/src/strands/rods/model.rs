//! Rods of a whole groom, compiled for blocks of eight strands.

use glam::Vec3;
use rayon::prelude::*;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::hairs::Hairs;
use super::material::{Section, nodes};
use super::real::{Real, Vector};
use super::rest;
use super::rod::Node;
use super::settings::Rest;
use crate::Solver;

/// The rods of a solver: it does not change while time passes.
#[derive(Clone)]
pub struct Rods {
    /// Shape `[block][point]`.
    pub(crate) nodes: Vec<Node<f32x8>>,
    /// First axis of each segment's section at rest, head space, shape `[block][point]` of lanes.
    pub(crate) sections: Vec<Vec3Lanes>,
    /// Strands that had to be stiffer for their shape to be stable.
    pub stiffened: usize,
    /// How many times stiffer the stiffest of them is; 1 with none.
    pub stiffest: f32,
}

impl Rods {
    /// Compiles the rods of a solver: gravity is the load that its rest shape carries, unless it is to
    /// sag.
    pub(crate) fn new(solver: &Solver, hairs: &Hairs, rest: Rest) -> Self {
        let points = solver.points_per_strand;
        let gravity = solver.settings.gravity;
        let blocks: Vec<Block> = solver
            .positions
            .par_chunks(points)
            .zip(solver.inverse_mass.par_chunks(points))
            .enumerate()
            .map(|(block, (positions, inverse_mass))| {
                let live = solver.strand_count.saturating_sub(block * LANES).clamp(1, LANES);
                let mass = &solver.rest.mass[block * points..(block + 1) * points];
                let section = |lane: usize| hairs.section(block * LANES + lane);
                Block::new(positions, inverse_mass, mass, live, section, rest, gravity)
            })
            .collect();
        let stiffening = || blocks.iter().flat_map(|block| block.stiffening).filter(|times| *times > 1.0);
        Self {
            stiffened: stiffening().count(),
            stiffest: stiffening().fold(1.0, f64::max) as f32,
            nodes: blocks.iter().flat_map(|block| block.nodes.iter().copied()).collect(),
            sections: blocks.iter().flat_map(|block| block.sections.iter().copied()).collect(),
        }
    }
}

/// Most that bending may pull harder at a point beside its inertia where segments are shorter than at rest: with
/// the length of a segment it goes as its fourth power, and single precision carries no 160,000 times. Only what is
/// left of the segments of a cut end, which are a twentieth as long, is softer than it should be.
const STIFFEST: f64 = 16.0;

/// The nodes of eight strands whose segments have other lengths \[m\] than at rest: curvatures and twists per
/// length stay, masses \[kg\] and stiffness follow.
pub(crate) fn with_lengths(
    nodes: &[Node<f32x8>],
    rest: &[Lanes],
    lengths: &[Lanes],
    mass: &[Lanes],
    scaled: &mut Vec<Node<f32x8>>,
) {
    scaled.clear();
    let zero = f32x8::ZERO;
    let last = nodes.len() - 1;
    // What a segment gives to the cells of the joints beside it; rigid ones give nothing.
    let turning =
        |lanes: &[Lanes], index: usize| nodes[index].free_angle.choose(f32x8::new(lanes[index].0), zero);
    for (index, node) in nodes.iter().enumerate() {
        let mut node = *node;
        node.mass = f32x8::new(mass[index].0);
        if index < last {
            let ratio = f32x8::new(lengths[index].0) / f32x8::new(rest[index].0);
            node.length *= ratio;
            node.inertia *= ratio;
            node.stretch *= ratio.or_less(f32x8::of(1.0));
        }
        if index > 0 && index < last {
            let cell = turning(rest, index - 1) + turning(rest, index);
            let now = turning(lengths, index - 1) + turning(lengths, index);
            let factor = cell.choose(now / cell, f32x8::of(1.0));
            let stiffer = (f32x8::of(1.0) / factor).or_less(f32x8::of(STIFFEST) * factor * factor * factor);
            node.stiffness = node.stiffness.map(|stiffness| stiffness * stiffer);
            node.rest = node.rest.map(|strain| strain * factor);
        }
        scaled.push(node);
    }
}

/// The rods of eight strands.
struct Block {
    nodes: Vec<Node<f32x8>>,
    sections: Vec<Vec3Lanes>,
    /// How many times stiffer each strand is; 1 in empty lanes.
    stiffening: [f64; LANES],
}

impl Block {
    fn new(
        positions: &[Vec3Lanes],
        inverse_mass: &[Lanes],
        mass: &[Lanes],
        live: usize,
        section: impl Fn(usize) -> Section,
        rest: Rest,
        gravity: Vec3,
    ) -> Self {
        let count = positions.len();
        let mut stiffening = [1.0; LANES];
        let mut sections = vec![Vec3Lanes::splat(Vec3::X); count];
        let mut strands = Vec::with_capacity(LANES);
        for lane in 0..LANES {
            // Lanes beyond the last strand move with it.
            let lane_of = lane.min(live - 1);
            let points: Vec<Vector<f64>> = positions.iter().map(|lanes| double(lanes.get(lane_of))).collect();
            let mut rod = nodes(&points, &section(lane_of), |point| inverse_mass[point].0[lane_of] == 0.0);
            for (node, mass) in rod.iter_mut().zip(mass) {
                node.mass = f64::from(mass.0[lane_of]);
            }
            let segments = rest::segments(&points, across(&points));
            match rest {
                Rest::Unstressed => rest::unstressed(&mut rod, &segments),
                Rest::SagFree => {
                    let forces: Vec<_> = rod.iter().map(|node| double(gravity) * node.mass).collect();
                    let times = rest::sag_free(&mut rod, &points, &segments, &forces);
                    if lane < live {
                        stiffening[lane] = times;
                    }
                }
            }
            for (sections, segment) in sections.iter_mut().zip(&segments) {
                let [x, y, z] = segment.across.array().map(|value| value as f32);
                sections.set(lane, Vec3::new(x, y, z));
            }
            strands.push(rod);
        }
        let nodes = (0..count).map(|point| gathered(&strands, point)).collect();
        Self { nodes, sections, stiffening }
    }
}

fn double(vector: Vec3) -> Vector<f64> {
    Vector::new(f64::from(vector.x), f64::from(vector.y), f64::from(vector.z))
}

/// A direction across the first segment, the same for strands that begin alike.
fn across(points: &[Vector<f64>]) -> Vector<f64> {
    let [x, y, z] = (points[1] - points[0]).array().map(f64::abs);
    if x <= y && x <= z {
        Vector::new(1.0, 0.0, 0.0)
    } else if y <= z {
        Vector::new(0.0, 1.0, 0.0)
    } else {
        Vector::new(0.0, 0.0, 1.0)
    }
}

fn gathered(strands: &[Vec<Node<f64>>], point: usize) -> Node<f32x8> {
    let lanes = |number: &dyn Fn(&Node<f64>) -> f64| {
        let numbers: [f32; LANES] = std::array::from_fn(|lane| number(&strands[lane][point]) as f32);
        f32x8::from(numbers)
    };
    Node {
        mass: lanes(&|node| node.mass),
        inertia: lanes(&|node| node.inertia),
        free: lanes(&|node| node.free),
        free_angle: lanes(&|node| node.free_angle),
        length: lanes(&|node| node.length),
        stretch: lanes(&|node| node.stretch),
        stiffness: std::array::from_fn(|axis| lanes(&|node| node.stiffness[axis])),
        rest: std::array::from_fn(|axis| lanes(&|node| node.rest[axis])),
    }
}
