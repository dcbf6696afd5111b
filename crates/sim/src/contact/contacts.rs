//! Contact planes: the solids as half spaces, one for each point near them.
//!
//! Signed-distance lookups are expensive, so each point remembers the last one, in the space that
//! carries the solid: its place (the anchor), the distance and the normal. A distance is never more
//! than the true one, which changes no faster than the point moves. So a point far from all solids
//! needs no look-up for many steps, and hair that rests on a moving head needs none.
//!
//! A point that moves far in a step is followed along its path, so that it meets the near side of a
//! solid in between.

use glam::Vec3;
use strandline_body::{BodyFrame, Carrier, Collider, Pose};
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::obstacles::Obstacles;
use super::way::{Seen, met};
use strandline_base::vec3x8::{Rigid, Vec3x8, load, splat};

/// Precision of a look-up of the solids.
#[derive(Clone, Copy)]
pub struct Care {
    /// Distance \[m\] that a point may move before its plane is renewed; on a ball of radius r the plane is then wrong
    /// by the square of this distance over 2 r.
    pub stale: f32,
    /// Distance \[m\] beyond its margin within which a point gets a plane.
    pub near: f32,
}

impl Care {
    /// For the rounds when an exact look follows: wrong by 0.3 mm on a skull.
    pub const ROUGH: Self = Self { stale: 8e-3, near: 5e-3 };
    /// For the rounds when nothing follows.
    pub const ROUNDS: Self = Self { stale: 1e-3, near: 1e-2 };
    /// For the places where points stay: wrong by 1 um on a skull, by 0.03 mm on the tip of a nose.
    pub const EXACT: Self = Self { stale: 5e-4, near: 0.0 };
    /// For positions that were just moved onto their plane.
    pub const ANEW: Self = Self { stale: 0.0, near: 0.0 };
}

/// The planes of all points, shape `[block]`.
#[derive(Clone, Debug)]
pub struct Contacts {
    pub blocks: Vec<Vec<Plane>>,
}

/// Points of the same index, for a look-up of the solids.
#[derive(Clone, Copy)]
pub struct Query {
    /// Positions \[m\].
    pub position: Vec3x8,
    /// Positions at the beginning of the step \[m\], for a look along the path; `None` looks up the positions
    /// alone.
    pub start: Option<Vec3x8>,
    /// Distance \[m\] that they keep.
    pub margin: f32x8,
    /// Mask of the lanes that may move.
    pub free: f32x8,
    /// Precision of the look-up.
    pub care: Care,
    /// Part of the step.
    pub part: u32,
}

/// Contact planes kept by the points of one index in a block, in the space of their carrier.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    anchor: Vec3Lanes,
    normal: Vec3Lanes,
    distance: Lanes,
    friction: Lanes,
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
    /// Unknown planes for a number of blocks; the order of a block is `[carrier][point]`.
    pub fn new(colliders: &[Collider], block_count: usize, points: usize) -> Self {
        Self { blocks: vec![vec![Plane::UNKNOWN; carriers(colliders).len() * points]; block_count] }
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

/// The carriers of colliders, each once: pieces of the body in their order, then the world.
pub(crate) fn carriers(colliders: &[Collider]) -> Vec<Carrier> {
    let mut carriers: Vec<Carrier> = colliders.iter().map(|collider| collider.carrier).collect();
    carriers.sort_unstable();
    carriers.dedup();
    carriers
}

/// Transform of a carrier, `world_from_carrier`.
fn pose(frame: &BodyFrame, carrier: Carrier) -> Pose {
    match carrier {
        Carrier::Piece(piece) => frame.piece(piece.into()),
        Carrier::World => Pose::IDENTITY,
    }
}

/// The solids of a step, grouped by carrier.
pub struct Solids<'a> {
    groups: Vec<Group<'a>>,
    obstacles: &'a Obstacles<'a>,
    points: usize,
}

struct Group<'a> {
    colliders: Vec<&'a Collider>,
    carrier_from_world: Rigid,
    world_from_carrier: Rigid,
    /// Carries what rests on the solid from the start to the end of the step.
    end_from_start: Rigid,
    /// Carries it through each part of the step; empty for a step in one.
    part_moves: Vec<Rigid>,
}

impl<'a> Solids<'a> {
    /// Places the colliders for a step of strands with a number of points.
    pub fn new(obstacles: &'a Obstacles<'a>, points: usize) -> Self {
        let group = |carrier| {
            let [start, end] = [&obstacles.start, &obstacles.end].map(|frame| pose(frame, carrier));
            let moved = if carrier == Carrier::World { Pose::IDENTITY } else { start.motion_to(&end) };
            Group {
                colliders: obstacles.colliders.iter().filter(|c| c.carrier == carrier).collect(),
                carrier_from_world: Rigid::new(&end.inverse()),
                world_from_carrier: Rigid::new(&end),
                end_from_start: Rigid::new(&moved),
                part_moves: Vec::new(),
            }
        };
        let groups = carriers(obstacles.colliders).into_iter().map(group).collect();
        Self { groups, obstacles, points }
    }

    /// Places the colliders for a step in a number of parts.
    pub fn in_parts(obstacles: &'a Obstacles<'a>, points: usize, parts: u32) -> Self {
        let mut solids = Self::new(obstacles, points);
        for (group, carrier) in solids.groups.iter_mut().zip(carriers(obstacles.colliders)) {
            let [start, end] = [&obstacles.start, &obstacles.end].map(|frame| pose(frame, carrier));
            let moves = (0..parts).map(|part| Rigid::of_axes(&start.part_of_way(&end, part, parts).1));
            group.part_moves = moves.collect();
        }
        solids
    }

    /// True without solids.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// Solid near the points of one index; `None` if no free lane is near one.
    pub fn touch(&self, planes: &mut [Plane], point: usize, query: Query) -> Option<Touch> {
        let Query { position, start, margin, free, care, part } = query;
        let mut touch: Option<Touch> = None;
        for (group, planes) in self.groups.iter().zip(planes.chunks_mut(self.points)) {
            let plane = &mut planes[point];
            let stuck = start.map(|start| group.end_from_start.points(start));
            let look = group.refresh(plane, position, stuck, margin + splat(care.near), care.stale);
            let near = look.near & free;
            if !near.any() {
                continue;
            }
            let normal = Vec3x8::load(&plane.normal);
            let anchor = group.world_from_carrier.points(Vec3x8::load(&plane.anchor));
            let normal = group.world_from_carrier.directions(normal);
            let offset = normal.dot(anchor) - load(&plane.distance) + margin;
            let found = Touch {
                normal,
                offset: near.bitselect(offset, splat(f32::NEG_INFINITY)),
                friction: load(&plane.friction),
                stuck: match (start, group.part_moves.get(part as usize)) {
                    (Some(start), Some(moved)) => moved.points(start),
                    _ => stuck.unwrap_or(position),
                },
                place: anchor.or(look.blocked & near, position),
            };
            touch = Some(touch.map_or(found, |other| other.nearer(&found, position)));
        }
        touch
    }

    /// Depth \[m\] of points of one index inside the solids, 0 outside, for the lanes in `counted`. It looks distances up
    /// again, so that it also finds what the remembered planes may have missed.
    pub fn depth(&self, position: Vec3x8, counted: impl Fn(usize) -> bool) -> f32 {
        let mut deepest = 0.0_f32;
        for group in &self.groups {
            let mut local = Vec3Lanes::default();
            group.carrier_from_world.points(position).store(&mut local);
            for point in (0..LANES).filter(|lane| counted(*lane)).map(|lane| local.get(lane)) {
                // A lower bound shows that most points are outside; the surface is not searched for those.
                let near =
                    group.colliders.iter().filter(|collider| collider.shape.distance_at_least(point) <= 0.0);
                let distances = near.map(|collider| collider.shape.distance(point));
                deepest = distances.fold(deepest, |deepest, distance| deepest.max(-distance));
            }
        }
        deepest
    }

    /// Signed distance \[m\] to the nearest solid and its unit gradient, world space, looked up again.
    pub fn nearest(&self, point: Vec3) -> (f32, Vec3) {
        self.obstacles
            .nearest(point)
            .map_or((f32::INFINITY, Vec3::Y), |(distance, gradient, _)| (distance, gradient))
    }
}

/// Masks of lanes after a look.
struct Look {
    /// Lanes that may be nearer than the requested distance.
    near: f32x8,
    /// Lanes whose point a solid stops on its path.
    blocked: f32x8,
}

impl Group<'_> {
    /// Renews planes that are out of date, for points that matter only within `reach` \[m\] of a solid.
    ///
    /// `stuck` are the positions of points that stick to the solid, where their paths begin.
    fn refresh(
        &self,
        plane: &mut Plane,
        position: Vec3x8,
        stuck: Option<Vec3x8>,
        reach: f32x8,
        stale: f32,
    ) -> Look {
        let local = self.carrier_from_world.points(position);
        let moved = (local - Vec3x8::load(&plane.anchor)).length();
        let near = (load(&plane.distance) - moved).simd_le(reach);
        let stale = (near & moved.simd_gt(splat(stale))).to_bitmask();
        if stale == 0 {
            return Look { near, blocked: splat(0.0) };
        }
        let mut blocked = [0.0; LANES];
        let (mut here, mut from) = (Vec3Lanes::default(), Vec3Lanes::default());
        local.store(&mut here);
        stuck.map_or(local, |stuck| self.carrier_from_world.points(stuck)).store(&mut from);
        for lane in (0..LANES).filter(|lane| stale & (1 << lane) != 0) {
            let seen = met(from.get(lane), here.get(lane), |point| self.nearest(point));
            if seen.is_before(here.get(lane)) {
                blocked[lane] = f32::from_bits(u32::MAX);
            }
            let Seen { place, distance, normal, friction } = seen;
            plane.anchor.set(lane, place);
            plane.normal.set(lane, normal);
            plane.distance.0[lane] = distance;
            plane.friction.0[lane] = friction;
        }
        let moved = (local - Vec3x8::load(&plane.anchor)).length();
        Look { near: (load(&plane.distance) - moved).simd_le(reach), blocked: f32x8::from(blocked) }
    }

    fn nearest(&self, point: Vec3) -> Seen {
        let mut nearest = Seen { place: point, distance: f32::INFINITY, normal: Vec3::Y, friction: 0.0 };
        for collider in &self.colliders {
            let (distance, normal) = collider.shape.distance_and_gradient(point);
            if distance < nearest.distance {
                nearest = Seen { distance, normal, friction: collider.friction, ..nearest };
            }
        }
        nearest
    }
}

/// A half space for the points of one index, world space.
#[derive(Clone, Copy)]
pub struct Touch {
    /// Unit normal, out of the solid.
    pub normal: Vec3x8,
    /// Points stay where normal . x is at least this \[m\].
    pub offset: f32x8,
    /// Coulomb friction coefficient.
    pub friction: f32x8,
    /// Positions of points that stuck to the solid \[m\].
    pub stuck: Vec3x8,
    /// Positions after the look-up: unchanged, or where a solid stopped the points on their path \[m\].
    pub place: Vec3x8,
}

impl Touch {
    /// Height \[m\] above the plane.
    #[inline(always)]
    pub fn height(&self, position: Vec3x8) -> f32x8 {
        self.normal.dot(position) - self.offset
    }

    /// Distance \[m\] that friction may move points back in this step [Macklin2014 eq. 24]. It follows from the depth of
    /// the prediction alone, so that the number of rounds does not change it.
    #[inline(always)]
    pub fn friction_of(&self, predicted: Vec3x8) -> f32x8 {
        self.friction * (-self.height(predicted)).fast_max(splat(0.0))
    }

    /// Pushes points out of the solid and takes back their slip, up to the `left` \[m\] of friction. Friction holds until
    /// the step ends, even where a round has lifted the point a little.
    #[inline(always)]
    pub fn resolve(&self, position: Vec3x8, left: &mut f32x8) -> Vec3x8 {
        let height = self.height(position);
        if !(height.simd_lt(splat(0.0)) | left.simd_gt(splat(0.0))).any() {
            return position;
        }
        let out = position - self.normal * height.fast_min(splat(0.0));
        let slip = out - self.stuck;
        let slip = slip - self.normal * self.normal.dot(slip);
        let size = slip.length();
        let taken = left.fast_min(size);
        *left -= taken;
        out - slip * (taken / size)
    }

    #[inline(always)]
    fn nearer(&self, other: &Self, position: Vec3x8) -> Self {
        self.or(self.height(position).simd_lt(other.height(position)), other)
    }

    /// This where the mask is set, else `other`.
    #[inline(always)]
    pub fn or(&self, mask: f32x8, other: &Self) -> Self {
        Self {
            normal: self.normal.or(mask, other.normal),
            offset: mask.bitselect(self.offset, other.offset),
            friction: mask.bitselect(self.friction, other.friction),
            stuck: self.stuck.or(mask, other.stuck),
            place: self.place.or(mask, other.place),
        }
    }

    /// This, without a touch where the mask is set.
    pub fn except(&self, mask: f32x8) -> Self {
        Self { offset: mask.bitselect(splat(f32::NEG_INFINITY), self.offset), ..*self }
    }
}
