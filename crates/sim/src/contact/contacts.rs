//! Contact planes: the solids as half spaces, one for each point near them.
//!
//! Signed-distance lookups are expensive, so each point remembers the last one, in the space that
//! carries the solid: its place (the anchor), the distance and the normal. A distance is never more
//! than the true one, which changes no faster than the point moves. So a point far from all solids
//! needs no look-up for many steps, and hair that rests on a moving head needs none.
//!
//! A point that moves far in a step is followed along its path, so that it meets the near side of a
//! solid in between.

use std::cell::Cell;

use glam::Vec3;
use strandline_body::{BodyFrame, Caps, Carrier, Collider, Pose, PosedSkin};
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use super::obstacles::Obstacles;
use super::parts::{Parts, beyond};
use super::planes::{MOST_DEPTH, Plane, Rider, carriers};
use super::touch::Touch;
use super::way::{LookUp, met};
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

/// Transform of a carrier, `world_from_carrier`.
fn pose(frame: &BodyFrame, carrier: Carrier) -> Pose {
    match carrier {
        Carrier::Piece(piece) | Carrier::Moved(piece) => frame.piece(piece.into()),
        Carrier::World => Pose::IDENTITY,
    }
}

/// The solids of a step, grouped by carrier.
pub struct Solids<'a> {
    groups: Vec<Group<'a>>,
    obstacles: &'a Obstacles<'a>,
    /// The parts of a neck among the groups.
    parts: Option<Parts<'a>>,
    points: usize,
}

pub(super) struct Group<'a> {
    colliders: Vec<(&'a Collider, Option<&'a PosedSkin>)>,
    /// The skin among them that moves by itself.
    skin: Option<&'a PosedSkin>,
    /// Planes between which a part of the bust lies, where it is the only one.
    caps: Option<Caps>,
    pub(super) carrier_from_world: Rigid,
    pub(super) world_from_carrier: Rigid,
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
            let solids = obstacles.solids().filter(|(collider, _)| collider.carrier == carrier);
            let colliders: Vec<_> = solids.collect();
            Group {
                skin: colliders.iter().find_map(|(_, skin)| *skin),
                caps: match &colliders[..] {
                    [(part, None)] => part.shape.caps().copied(),
                    _ => None,
                },
                colliders,
                carrier_from_world: Rigid::new(&end.inverse()),
                world_from_carrier: Rigid::new(&end),
                end_from_start: Rigid::new(&moved),
                part_moves: Vec::new(),
            }
        };
        let groups: Vec<Group> = carriers(obstacles.colliders).into_iter().map(group).collect();
        let parts = obstacles.common().and_then(|common| {
            let is_part = |caps: &Caps| caps.is_bounded();
            let first = groups.iter().position(|group| group.caps.as_ref().is_some_and(is_part))?;
            let caps: Vec<Caps> =
                groups[first..].iter().map_while(|group| group.caps.filter(is_part)).collect();
            Some(Parts::new(common, first, &caps))
        });
        Self { groups, obstacles, parts, points }
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

    /// Points of a strand.
    pub(super) fn points(&self) -> usize {
        self.points
    }

    /// Number of carriers.
    pub(super) fn carrier_count(&self) -> usize {
        self.groups.len()
    }

    /// Skins that move by themselves, each with the place of its carrier.
    pub(super) fn skins(&self) -> impl Iterator<Item = (usize, &'a PosedSkin)> {
        self.groups.iter().enumerate().filter_map(|(index, group)| Some((index, group.skin?)))
    }

    /// The groups at which points of one index look, in their order: see [`Parts::order`].
    #[inline(always)]
    fn order(&self, position: Vec3x8, start: Option<Vec3x8>, reach: f32x8) -> impl Iterator<Item = usize> {
        let count = self.groups.len();
        let (around, [from, below]) = match &self.parts {
            Some(parts) => (parts.groups.clone(), parts.order(position, start, reach)),
            None => (count..count, [0..0, 0..0]),
        };
        (0..around.start).chain(from).chain(below).chain(around.end..count)
    }

    /// The solid nearest to the points of one index; `None` if no free lane is near a solid.
    pub fn touch(&self, planes: &mut [Plane], point: usize, query: Query) -> Option<Touch> {
        let Query { position, start, margin, free, care, part } = query;
        let mut touch: Option<Touch> = None;
        let (planes, riders) = planes.split_at_mut(self.groups.len() * self.points);
        let widest = margin + splat(care.near);
        for number in self.order(position, start, widest) {
            let group = &self.groups[number];
            // A part that is farther than the plane of another solid does not count.
            let reach = match &touch {
                Some(nearest) if group.caps.is_some() => widest.fast_min(nearest.height(position) + margin),
                _ => widest,
            };
            if group.is_beyond(position, start, reach) {
                continue;
            }
            let plane = &mut planes[number * self.points + point];
            let mut rider = riders.get_mut(point).filter(|_| group.skin.is_some());
            let look = group.refresh(plane, rider.as_deref_mut(), &query, reach);
            let near = look.near & free;
            if !near.any() {
                continue;
            }
            let along = group.along(rider.as_deref());
            let stuck = start.map(|start| group.stuck(start, along));
            let normal = Vec3x8::load(&plane.normal);
            let anchor = group.world_from_carrier.points(Vec3x8::load(&plane.anchor));
            let normal = group.world_from_carrier.directions(normal);
            let offset = normal.dot(anchor) - load(&plane.distance) + margin;
            let found = Touch {
                normal,
                offset: near.bitselect(offset, splat(f32::NEG_INFINITY)),
                friction: load(&plane.friction),
                stuck: match (start, group.part_moves.get(part as usize)) {
                    (Some(start), Some(moved)) => {
                        let share = splat(1.0 / group.part_moves.len() as f32);
                        along.map_or(moved.points(start), |along| moved.points(start) + along * share)
                    }
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
    /// On a skin that moves by itself the planes of points tell which are outside for certain.
    pub fn depth(
        &self,
        position: Vec3x8,
        (planes, index): (&[Plane], usize),
        counted: impl Fn(usize) -> bool,
    ) -> f32 {
        let mut deepest = 0.0_f32;
        for number in self.order(position, None, splat(0.0)) {
            let group = &self.groups[number];
            if group.skin.is_some() {
                let plane = &planes[number * self.points + index];
                let rider = planes.get(self.groups.len() * self.points + index);
                deepest = deepest.max(group.depth_on(position, plane, rider, &counted));
                continue;
            }
            let place = group.carrier_from_world.points(position);
            let between =
                group.caps.map_or(u32::MAX, |caps| beyond(&caps, place).simd_le(splat(0.0)).to_bitmask());
            if between == 0 {
                continue;
            }
            let mut local = Vec3Lanes::default();
            place.store(&mut local);
            let is_looked_at = |lane: &usize| between & (1 << lane) != 0 && counted(*lane);
            for point in (0..LANES).filter(is_looked_at).map(|lane| local.get(lane)) {
                // A lower bound shows that most points are outside; the surface is not searched for those.
                let near = group
                    .colliders
                    .iter()
                    .filter(|(collider, _)| collider.shape.distance_at_least(point) <= 0.0);
                let distances = near.map(|(collider, _)| collider.shape.distance(point));
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

/// Depth \[m\] in a skin, and distance \[m\] from it, that a look finds exactly.
pub(super) struct Exact {
    pub depth: f32,
    pub distance: f32,
}

/// Distance \[m\] from a skin beyond which a bound serves points that keep a margin \[m\]: 0.8 of it is more than what a plane may be
/// behind, and its reach.
fn bounded_beyond(margin: f32) -> f32 {
    1.25 * (Care::ROUGH.stale + Care::ROUGH.near + margin)
}

/// Masks of lanes after a look.
struct Look {
    /// Lanes that may be nearer than the requested distance.
    near: f32x8,
    /// Lanes whose point a solid stops on its path.
    blocked: f32x8,
}

impl Group<'_> {
    /// True where the planes of a part of the bust tell that no point of one index comes within `reach` \[m\] of it, nor
    /// from `start` \[m\] through it: at its end it is farther from the part than its way is long.
    #[inline(always)]
    fn is_beyond(&self, position: Vec3x8, start: Option<Vec3x8>, reach: f32x8) -> bool {
        let Some(caps) = self.caps else { return false };
        let beyond = beyond(&caps, self.carrier_from_world.points(position));
        if !beyond.simd_gt(reach).all() {
            return false;
        }
        let way = start.map_or(splat(0.0), |start| (position - self.end_from_start.points(start)).length());
        beyond.simd_gt(way).all()
    }

    /// Positions \[m\] of points that lay at `start` \[m\] and stuck to the solid, whose material moves `along` beside its
    /// carrier.
    #[inline(always)]
    fn stuck(&self, start: Vec3x8, along: Option<Vec3x8>) -> Vec3x8 {
        let carried = self.end_from_start.points(start);
        along.map_or(carried, |along| carried + along)
    }

    /// Renews planes that are out of date, for points that matter only within `reach` \[m\] of a solid.
    ///
    /// Paths begin where points that lay at the start of the query and stuck to the solid are.
    fn refresh(&self, plane: &mut Plane, mut rider: Option<&mut Plane>, query: &Query, reach: f32x8) -> Look {
        let Query { position, start, margin, care, .. } = *query;
        let local = self.carrier_from_world.points(position);
        let moved = (local - Vec3x8::load(&plane.anchor)).length();
        let near = (load(&plane.distance) - moved).simd_le(reach);
        let stale = (near & moved.simd_gt(splat(care.stale))).to_bitmask();
        if stale == 0 {
            return Look { near, blocked: splat(0.0) };
        }
        let mut blocked = [0.0; LANES];
        let (mut here, mut from) = (Vec3Lanes::default(), Vec3Lanes::default());
        local.store(&mut here);
        let stuck = start.map(|start| self.stuck(start, self.along(rider.as_deref())));
        stuck.map_or(local, |stuck| self.carrier_from_world.points(stuck)).store(&mut from);
        for lane in (0..LANES).filter(|lane| stale & (1 << lane) != 0) {
            let triangle =
                Cell::new(rider.as_mut().map_or(PosedSkin::UNKNOWN, |rider| Rider(rider).triangle(lane)));
            let exact = Exact { depth: MOST_DEPTH, distance: bounded_beyond(margin.to_array()[lane]) };
            let seen = met(from.get(lane), here.get(lane), |point| self.nearest(point, &triangle, &exact));
            if seen.is_before(here.get(lane)) {
                blocked[lane] = f32::from_bits(u32::MAX);
            }
            let LookUp { place, distance, normal, friction } = seen;
            plane.anchor.set(lane, place);
            plane.normal.set(lane, normal);
            plane.distance.0[lane] = distance;
            plane.friction.0[lane] = friction;
            if let (Some(rider), Some(skin)) = (rider.as_mut(), self.skin) {
                Rider(rider).set(lane, triangle.get(), skin.shift(triangle.get(), place));
            }
        }
        let moved = (local - Vec3x8::load(&plane.anchor)).length();
        Look { near: (load(&plane.distance) - moved).simd_le(reach), blocked: f32x8::from(blocked) }
    }

    /// Depth \[m\] of a point in the solids, carrier space; the search on a skin begins at a triangle near it.
    pub(super) fn deepest(&self, point: Vec3, triangle: u32) -> f32 {
        let depth = |(collider, skin): &(&Collider, Option<&PosedSkin>)| match skin {
            Some(skin) => skin.depth(point, triangle),
            None => -collider.shape.distance(point),
        };
        self.colliders.iter().map(depth).fold(0.0, f32::max)
    }

    /// The nearest solid, and a triangle of a skin for the next look. Points deeper in a skin, or farther from it, than is
    /// exact have a bound of their distance.
    pub(super) fn nearest(&self, point: Vec3, triangle: &Cell<u32>, exact: &Exact) -> LookUp {
        let mut nearest = LookUp { place: point, distance: f32::INFINITY, normal: Vec3::Y, friction: 0.0 };
        for (collider, skin) in &self.colliders {
            let (distance, normal) = match skin {
                Some(skin) => {
                    let found = skin.near(point, triangle.get(), exact.distance);
                    triangle.set(found.triangle);
                    (found.distance.max(-exact.depth), found.normal)
                }
                None => collider.shape.distance_and_gradient(point),
            };
            if distance < nearest.distance {
                nearest = LookUp { distance, normal, friction: collider.friction, ..nearest };
            }
        }
        nearest
    }
}
