//! Planes that points remember of the solids, in the space of what carries these.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::{Rigid, Vec3x8, load, splat};
use strandline_body::{Carrier, Collider, Pose, PosedSkin, Shape};
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use super::obstacles::Obstacles;

/// Depth \[m\] in a skin that moves by itself out of which a look brings a point at most: the way of a longer path is
/// followed, so that only a part of the skin that passes through another has points deeper, which it must not throw.
pub(super) const MOST_DEPTH: f32 = 5e-3;

/// The planes of all points, shape `[block]`.
#[derive(Clone, Debug)]
pub struct Contacts {
    pub blocks: Vec<Vec<Plane>>,
}

/// Contact planes kept by the points of one index in a block, in the space of their carrier.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub(super) anchor: Vec3Lanes,
    pub(super) normal: Vec3Lanes,
    pub(super) distance: Lanes,
    pub(super) friction: Lanes,
}

impl Plane {
    /// An unknown plane: its point may be anywhere, inside or outside.
    const UNKNOWN: Self = Self {
        anchor: Vec3Lanes { x: [1e9; LANES], y: [1e9; LANES], z: [1e9; LANES] },
        normal: Vec3Lanes { x: [0.0; LANES], y: [1.0; LANES], z: [0.0; LANES] },
        distance: Lanes([f32::NEG_INFINITY; LANES]),
        friction: Lanes([0.0; LANES]),
    };
    /// Numbers for each strand.
    const NUMBERS: usize = 8;

    /// A rider without a triangle.
    const ON_FOOT: Self = Self {
        anchor: Vec3Lanes { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES] },
        distance: Lanes([0.0; LANES]),
        friction: Lanes([f32::from_bits(PosedSkin::UNKNOWN); LANES]),
        ..Self::UNKNOWN
    };

    /// Makes the plane of a lane unknown.
    pub(super) fn forget(&mut self, lane: usize) {
        self.anchor.set(lane, Vec3::splat(1e9));
        self.distance.0[lane] = f32::NEG_INFINITY;
    }

    fn numbers(&self) -> [[f32; LANES]; Self::NUMBERS] {
        let Self { anchor, normal, distance, friction } = self;
        [anchor.x, anchor.y, anchor.z, normal.x, normal.y, normal.z, distance.0, friction.0]
    }

    fn of_numbers(numbers: &[f32]) -> Self {
        let part = |index: usize| std::array::from_fn(|lane| numbers[index * LANES + lane]);
        let vector = |first: usize| Vec3Lanes { x: part(first), y: part(first + 1), z: part(first + 2) };
        Self { anchor: vector(0), normal: vector(3), distance: Lanes(part(6)), friction: Lanes(part(7)) }
    }
}

impl Contacts {
    /// Unknown planes for a number of blocks; the order of a block is `[carrier][point]`, and behind them a rider for each
    /// point where a collider is a skin.
    pub fn new(colliders: &[Collider], block_count: usize, points: usize) -> Self {
        let mut block = vec![Plane::UNKNOWN; carriers(colliders).len() * points];
        if colliders.iter().any(|collider| matches!(collider.shape, Shape::Skin(_))) {
            block.resize(block.len() + points, Plane::ON_FOOT);
        }
        Self { blocks: vec![block; block_count] }
    }

    /// Compares the bits of all planes.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let same = |(one, other): (&Plane, &Plane)| {
            bytemuck::bytes_of(&one.numbers()) == bytemuck::bytes_of(&other.numbers())
        };
        let blocks = self.blocks.par_iter().zip(&other.blocks).with_min_len(64);
        self.blocks.len() == other.blocks.len()
            && blocks.all(|(one, other)| one.len() == other.len() && one.iter().zip(other).all(same))
    }

    /// Numbers of a plane for each strand.
    pub fn numbers_per_plane(&self) -> usize {
        Plane::NUMBERS
    }

    /// The numbers of all planes, shape `[block][plane][number]` of lanes.
    pub fn numbers(&self) -> Vec<f32> {
        self.blocks.iter().flatten().flat_map(Plane::numbers).flatten().collect()
    }

    /// Takes over the numbers of all planes, of that shape.
    pub fn set_numbers(&mut self, numbers: &[f32]) {
        let planes = self.blocks.iter_mut().flatten();
        for (plane, numbers) in planes.zip(numbers.chunks_exact(Plane::NUMBERS * LANES)) {
            *plane = Plane::of_numbers(numbers);
        }
    }
}

impl Contacts {
    /// Lower bounds \[m\] of the distances of all solids from points at `positions` \[m\] at the end of a step, as their planes
    /// tell, shape `[block][point]` of lanes; negative infinity where a plane is unknown, or of a point deeper than a look says.
    pub fn heights(&self, obstacles: &Obstacles, positions: &[Vec3Lanes], points: usize) -> Vec<Lanes> {
        let inverse = |carrier| match carrier {
            Carrier::Piece(piece) | Carrier::Moved(piece) => obstacles.end.piece(piece.into()).inverse(),
            Carrier::World => Pose::IDENTITY,
        };
        let from_world: Vec<Rigid> =
            carriers(obstacles.colliders).into_iter().map(|carrier| Rigid::new(&inverse(carrier))).collect();
        let mut heights = vec![Lanes([f32::INFINITY; LANES]); positions.len()];
        let blocks = heights.par_chunks_mut(points).zip(positions.par_chunks(points)).zip(&self.blocks);
        blocks.with_min_len(16).for_each(|((heights, positions), planes)| {
            for (planes, from_world) in planes.chunks(points).zip(&from_world) {
                for ((height, position), plane) in heights.iter_mut().zip(positions).zip(planes) {
                    let local = from_world.points(Vec3x8::load(position));
                    let distance = load(&plane.distance);
                    let is_known = distance.simd_gt(splat(-MOST_DEPTH));
                    let known = is_known.bitselect(distance, splat(f32::NEG_INFINITY));
                    let least = known - (local - Vec3x8::load(&plane.anchor)).length();
                    height.0 = load(height).fast_min(least).to_array();
                }
            }
        });
        heights
    }
}

/// The carriers of colliders, each once: pieces of the body in their order, then the world.
pub(crate) fn carriers(colliders: &[Collider]) -> Vec<Carrier> {
    let mut carriers: Vec<Carrier> = colliders.iter().map(|collider| collider.carrier).collect();
    carriers.sort_unstable();
    carriers.dedup();
    carriers
}

/// The rider of a plane, which is stored as a plane.
pub(super) struct Rider<'a>(pub &'a mut Plane);

impl Rider<'_> {
    /// Triangle of a lane.
    pub fn triangle(&self, lane: usize) -> u32 {
        self.0.friction.0[lane].to_bits()
    }

    /// Sets the triangle of a lane and the way \[m\] of its material through the step, carrier space.
    pub fn set(&mut self, lane: usize, triangle: u32, moved: Vec3) {
        self.0.friction.0[lane] = f32::from_bits(triangle);
        self.0.distance.0[lane] = 0.0;
        self.0.anchor.set(lane, moved);
    }
}
