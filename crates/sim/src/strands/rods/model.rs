//! Rods of a whole groom, compiled for blocks of eight strands.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::hairs::{Hairs, Traits};
use super::material::{Section, nodes};
use super::real::Vector;
use super::rest::{self, Former};
use super::rod::Node;
use super::settings::Rest;

/// Strands at rest as rods are compiled from them, shapes `[block][point]` of lanes.
pub(crate) struct RodsAtRest<'a> {
    pub strand_count: usize,
    pub points_per_strand: usize,
    /// Places \[m\], head space.
    pub positions: &'a [Vec3Lanes],
    /// 1 over the mass \[1/kg\], 0 for a rooted point.
    pub inverse_mass: &'a [Lanes],
    /// \[kg\].
    pub mass: &'a [Lanes],
    /// True if strands have masses of their own, from which the number of their hairs follows.
    pub weighed: bool,
    /// \[m/s^2\].
    pub gravity: Vec3,
}

/// The rods of a groom: they do not change while time passes.
#[derive(Clone)]
pub struct Rods {
    /// Shape `[block][point]`.
    pub(crate) nodes: Vec<Node<f32x8>>,
    /// First axis of each segment's section at rest, head space, shape `[block][point]` of lanes.
    pub(crate) sections: Vec<Vec3Lanes>,
    /// Shape `[block][lane]`.
    pub(crate) traits: Vec<Traits>,
    /// Strands that had to be stiffer for their shape to be stable.
    pub stiffened: usize,
    /// Stiffening of the stiffest of them; 1 without any.
    pub stiffest: f32,
    /// Tells these rods from others that were compiled.
    pub(crate) key: Arc<()>,
}

impl Rods {
    /// Compiles rods: gravity is the load that their rest shape carries, unless it is to sag.
    pub(crate) fn new(strands: &RodsAtRest, hairs: &Hairs, rest: Rest) -> Self {
        let points = strands.points_per_strand;
        let blocks: Vec<Block> = strands
            .positions
            .par_chunks(points)
            .zip(strands.inverse_mass.par_chunks(points))
            .enumerate()
            .map(|(block, (positions, inverse_mass))| {
                let live = strands.strand_count.saturating_sub(block * LANES).clamp(1, LANES);
                let mass = &strands.mass[block * points..(block + 1) * points];
                let made_of = |lane: usize| {
                    let strand = block * LANES + lane;
                    (hairs.section(strand), hairs.former(strand))
                };
                let mut block =
                    Block::new(positions, inverse_mass, mass, live, made_of, rest, strands.gravity);
                if !strands.weighed {
                    block.heavier = [1.0; LANES];
                }
                block
            })
            .collect();
        // Lanes beyond the last strand move with it.
        let last = strands.strand_count.saturating_sub(1);
        let stiffening = || blocks.iter().flat_map(|block| block.stiffening).filter(|times| *times > 1.0);
        Self {
            stiffened: stiffening().count(),
            stiffest: stiffening().fold(1.0, f64::max) as f32,
            key: Arc::default(),
            traits: (0..blocks.len() * LANES)
                .map(|lane| {
                    let (strand, traits) = (lane.min(last), hairs.traits(lane.min(last)));
                    let heavier = blocks[strand / LANES].heavier[strand % LANES];
                    Traits { hairs: traits.hairs * heavier, ..traits }
                })
                .collect(),
            nodes: blocks.iter().flat_map(|block| block.nodes.iter().copied()).collect(),
            sections: blocks.iter().flat_map(|block| block.sections.iter().copied()).collect(),
        }
    }
}

/// The rods of eight strands.
struct Block {
    nodes: Vec<Node<f32x8>>,
    sections: Vec<Vec3Lanes>,
    /// Stiffening of each strand; 1 in empty lanes.
    stiffening: [f64; LANES],
    /// Mass of each strand over that of its material.
    heavier: [f32; LANES],
}

impl Block {
    fn new(
        positions: &[Vec3Lanes],
        inverse_mass: &[Lanes],
        mass: &[Lanes],
        live: usize,
        made_of: impl Fn(usize) -> (Section, Former),
        rest: Rest,
        gravity: Vec3,
    ) -> Self {
        let count = positions.len();
        let (mut stiffening, mut heavier) = ([1.0; LANES], [1.0; LANES]);
        let mut sections = vec![Vec3Lanes::splat(Vec3::X); count];
        let mut strands = Vec::with_capacity(LANES);
        for lane in 0..LANES {
            // Lanes beyond the last strand move with it.
            let lane_of = lane.min(live - 1);
            let points: Vec<Vector<f64>> = positions.iter().map(|lanes| lanes.get(lane_of).into()).collect();
            let (section, former) = made_of(lane_of);
            let mut rod = nodes(&points, &section, |point| inverse_mass[point].0[lane_of] == 0.0);
            let of_material: f64 = rod.iter().map(|node| node.mass).sum();
            for (node, mass) in rod.iter_mut().zip(mass) {
                node.mass = f64::from(mass.0[lane_of]);
            }
            heavier[lane] = (rod.iter().map(|node| node.mass).sum::<f64>() / of_material) as f32;
            let segments = rest::segments(&points, rest::across(&points));
            match rest {
                Rest::Unstressed => rest::unstressed(&mut rod, &segments),
                Rest::SagFree | Rest::Dry => {
                    let times = former.sag_free(&mut rod, &points, &segments, gravity);
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
        Self { nodes, sections, stiffening, heavier }
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
