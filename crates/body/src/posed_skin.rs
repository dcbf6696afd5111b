//! The skin of a body through a step: the tree refitted to its end, and the search for the nearest place.

use std::sync::Arc;

use glam::{Mat3, Vec3, Vec3A};
use strandline_base::par::{self, prelude::*};
use strandline_base::{LANES, Vec3Lanes};

use crate::local_shifts::LocalShifts;
use crate::nearest_corner::{Feature, nearest_on, nearest_shares};
use crate::skin_box::SkinBox;
use crate::skin_solid::{NONE, SkinSolid};
use crate::{BodyFrame, Carrier, Collider, Shape};

/// Most waiting nodes: one for each halving of 2^32 triangles, and one more.
pub(crate) const DEPTH: usize = 40;
/// Distance \[m\] below which the way to the nearest place has no direction.
const TOUCHING: f32 = 1e-5;
/// Share of the distance that the quick search may be off, and the lower bound that it leaves.
const QUICK: f32 = 0.64;
const AT_LEAST: f32 = 0.8;
/// Way \[m\] of a skin through a step below which it stands still for what lies about it.
const STILL: f32 = 1e-6;

/// A skin at the start and at the end of a step.
#[derive(Clone, Debug)]
pub struct PosedSkin {
    pub(crate) solid: Arc<SkinSolid>,
    /// Skins that it was made of.
    made_of: [Option<Arc<[Vec3]>>; 2],
    pub(crate) start: Vec<Vec3>,
    pub(crate) end: Vec<Vec3>,
    /// Box of each node at the end.
    pub(crate) boxes: Vec<SkinBox>,
    most_shift: f32,
    /// Ways of triangles by their place; none where nothing moves.
    shifts: Option<LocalShifts>,
    /// Mean way \[m\] of the corners of each triangle; empty where nothing moves.
    drifts: Vec<Vec3>,
    /// Side of the triangles that is outside at the end: 1 the front, -1 the back.
    pub(crate) facing: f32,
    /// True where the step turns the skin inside out, or back.
    turns_over: bool,
}

/// The nearest place of a skin.
#[derive(Clone, Copy, Debug)]
pub struct SkinPlace {
    /// Signed distance \[m\].
    pub distance: f32,
    /// Its unit gradient.
    pub normal: Vec3,
    /// Index of the triangle: the next search begins there.
    pub triangle: u32,
}

/// The rigid motion of a triangle and its neighbourhood through the step.
#[derive(Clone, Copy, Debug)]
pub struct TriangleMotion {
    start: Vec3,
    end: Vec3,
    turn: Mat3,
    /// Greatest distance \[m\] of a corner from where the motion has it.
    pub error: f32,
}

impl TriangleMotion {
    /// A place of the start carried to the end.
    pub fn point(&self, point: Vec3) -> Vec3 {
        self.end + self.turn * (point - self.start)
    }

    /// A direction of the start carried to the end.
    pub fn direction(&self, direction: Vec3) -> Vec3 {
        (self.turn * direction).normalize_or(direction)
    }
}

impl PosedSkin {
    /// A triangle for a first search.
    pub const UNKNOWN: u32 = NONE;

    /// A skin through a step; `None` where it rides the head from start to end. Skins of smaller meshes are ignored, and
    /// vertices behind those of the solid, such as the ones of bands about hair, left out.
    pub fn new(solid: &Arc<SkinSolid>, skins: [Option<&Arc<[Vec3]>>; 2]) -> Option<Self> {
        let skins = skins.map(|skin| skin.filter(|skin| skin.len() >= solid.vertex_count));
        if skins.iter().all(Option::is_none) {
            return None;
        }
        let positions =
            |skin: Option<&Arc<[Vec3]>>| solid.positions(skin.map(|skin| &skin[..solid.vertex_count]));
        let (start, end) = par::join(|| positions(skins[0]), || positions(skins[1]));
        let pairs = start.par_iter().zip(&end).with_min_len(4096);
        let squares: Vec<f32> = pairs.map(|(start, end)| start.distance_squared(*end)).collect();
        let most_shift = squares.iter().copied().fold(0.0, f32::max).sqrt();
        let made_of = skins.map(|skin| skin.cloned());
        let moves = most_shift > 0.0;
        let boxes_and_shifts = || {
            let boxes = solid.boxes_about(&end);
            let leaves = |part: usize| solid.shifts_of_leaves(part, &boxes, &squares);
            let shifts =
                if moves { LocalShifts::new(boxes[0].corners(), solid.part_count(), leaves) } else { None };
            (boxes, shifts)
        };
        let drift = |corners: &[u32; 3]| {
            let way = |corner: &u32| end[*corner as usize] - start[*corner as usize];
            corners.iter().map(way).sum::<Vec3>() / 3.0
        };
        let drifts_and_facings = || {
            let triangles = if moves { &solid.triangles[..] } else { &[] };
            let drifts = triangles.par_iter().with_min_len(2048).map(drift).collect();
            (drifts, solid.facings([&end, &start], most_shift))
        };
        let ((boxes, shifts), (drifts, [facing, before])) = par::join(boxes_and_shifts, drifts_and_facings);
        let turns_over = facing != before;
        let solid = Arc::clone(solid);
        Some(Self { solid, made_of, start, end, boxes, most_shift, shifts, drifts, facing, turns_over })
    }

    /// The skin of a collider that the head carries, through a step between two frames of the body; `None` for other
    /// colliders, and where the skin rides the head from start to end.
    pub fn of(collider: &Collider, start: &BodyFrame, end: &BodyFrame) -> Option<Self> {
        match &collider.shape {
            Shape::Skin(solid) if collider.carrier == Carrier::HEAD => {
                Self::new(solid, [start.skin(), end.skin()])
            }
            _ => None,
        }
    }

    /// True for a skin made of the same lists in memory.
    pub fn is_of(&self, collider: &Collider, start: &BodyFrame, end: &BodyFrame) -> bool {
        let Shape::Skin(solid) = &collider.shape else { return false };
        let skins = [start.skin(), end.skin()];
        let same = |known: &Option<Arc<[Vec3]>>, skin: Option<&Arc<[Vec3]>>| match (known, skin) {
            (Some(known), Some(skin)) => Arc::ptr_eq(known, skin),
            (known, skin) => known.is_none() && skin.is_none(),
        };
        Arc::ptr_eq(&self.solid, solid)
            && self.made_of.iter().zip(skins).all(|(known, skin)| same(known, skin))
    }

    /// Most way \[m\] of a vertex through the step, head space.
    pub fn most_shift(&self) -> f32 {
        self.most_shift
    }

    /// The most \[m\] that the skin that ends within 6 cm of a point has moved through the step, head space.
    pub fn shift_about(&self, point: Vec3) -> f32 {
        self.shifts.as_ref().map_or(self.most_shift, |shifts| shifts.about(point))
    }

    /// The same for eight points.
    pub fn shifts_about(&self, points: &Vec3Lanes) -> [f32; LANES] {
        self.shifts.as_ref().map_or([self.most_shift; LANES], |shifts| shifts.about_lanes(points))
    }

    /// Lower bound \[m\] of the distance at the end of a point that was at least `distance` \[m\] from the skin at the start, by
    /// its [`Self::shift_about`] \[m\].
    pub fn at_least_after(&self, distance: f32, shift: f32) -> f32 {
        let near = distance - shift;
        // Skin that ends within the reach of the ways about a point has moved no more than these.
        let reach = self.shifts.as_ref().map_or(f32::INFINITY, LocalShifts::reach);
        near.min(reach.max(distance - self.most_shift))
    }

    pub(crate) fn corners(&self, positions: &[Vec3], triangle: u32) -> [Vec3; 3] {
        self.solid.triangles[triangle as usize].map(|corner| positions[corner as usize])
    }

    /// The place nearest to a point \[m\] at the end of the step, head space. The search begins at a triangle that was
    /// nearest before.
    pub fn nearest(&self, point: Vec3, before: u32) -> SkinPlace {
        let (triangle, squared) = self.search(point, before, 1.0);
        self.seen(point, triangle, squared.sqrt())
    }

    /// The same; farther than `far` \[m\] outside a lower bound of the distance, no less than 0.8 of it, and the gradient at
    /// about the nearest place.
    pub fn near(&self, point: Vec3, before: u32, far: f32) -> SkinPlace {
        let square = far * far;
        if self.square_from(before, point).is_some_and(|squared| squared <= square) {
            return self.nearest(point, before);
        }
        let (triangle, squared) = self.search(point, before, QUICK);
        if squared > square {
            let found = self.seen(point, triangle, squared.sqrt());
            if found.distance > 0.0 {
                return SkinPlace { distance: AT_LEAST * found.distance, ..found };
            }
        }
        self.nearest(point, triangle)
    }

    /// Signed distance \[m\] and unit gradient at a point \[m\] at the end of the step, head space.
    pub fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        let SkinPlace { distance, normal, .. } = self.nearest(point, Self::UNKNOWN);
        (distance, normal)
    }

    /// Lower bound \[m\] of the distance of a point at the end, 0 where it may be inside.
    pub fn at_least(&self, point: Vec3) -> f32 {
        self.at_least_about(point, NONE, 0.0).0
    }

    /// As [`Self::at_least`], by a search that begins at the triangle `before`; also returns the triangle it ended at. The bound
    /// is 0, without a search, where `before` alone brings it to `enough` \[m\] or less.
    pub fn at_least_about(&self, point: Vec3, before: u32, enough: f32) -> (f32, u32) {
        if enough > 0.0
            && self.square_from(before, point).is_some_and(|squared| AT_LEAST * squared.sqrt() <= enough)
        {
            return (0.0, before);
        }
        let (triangle, squared) = self.search(point, before, QUICK);
        (AT_LEAST * self.seen(point, triangle, squared.sqrt()).distance.max(0.0), triangle)
    }

    /// A triangle at most a quarter farther from a point \[m\] at the end of the step than the nearest one. The search begins at
    /// `before`.
    pub fn triangle_about(&self, point: Vec3, before: u32) -> u32 {
        self.search(point, before, QUICK).0
    }

    /// Squared distance \[m^2\] of a point \[m\] from a triangle at the end of the step; `None` of an unknown one.
    fn square_from(&self, triangle: u32, point: Vec3) -> Option<f32> {
        let is_known = (triangle as usize) < self.solid.triangles.len();
        is_known.then(|| point.distance_squared(nearest_on(self.corners(&self.end, triangle), point).0))
    }

    /// True where the skin nearest to a point \[m\] at the end of the step, head space, stands still through the step, as the
    /// ways about the point and the distance of any triangle show, such as `before`. No search is made.
    pub fn is_still_about(&self, point: Vec3, before: u32) -> bool {
        // Skin within the reach of the ways about a point has moved no more than these.
        self.shifts.as_ref().map_or(self.most_shift == 0.0, |shifts| {
            let within = shifts.reach() * shifts.reach();
            shifts.about(point) < STILL
                && self.square_from(before, point).is_some_and(|squared| squared < within)
        })
    }

    /// The nearest triangle, and its squared distance; nodes are left out whose squared distance is more than `slack`
    /// times that of the best.
    fn search(&self, point: Vec3, before: u32, slack: f32) -> (u32, f32) {
        let wide = Vec3A::from(point);
        let from_box = |index: u32| {
            let [min, max] = self.boxes[index as usize].corners();
            wide.distance_squared(wide.max(min).min(max))
        };
        let from_triangle = |index: u32| {
            let place = nearest_on(self.corners(&self.end, index), point).0;
            point.distance_squared(place)
        };
        let first = if (before as usize) < self.solid.triangles.len() { before } else { 0 };
        let mut best = (first, from_triangle(first));
        let mut waiting = [(0.0_f32, 0_u32); DEPTH];
        let (mut count, mut looks) = (1, 1);
        while count > 0 {
            count -= 1;
            let (squared, index) = waiting[count];
            if squared >= slack * best.1 {
                continue;
            }
            let node = self.boxes[index as usize];
            if node.right() == 0 {
                looks += node.triangles().len() as u64;
                for triangle in node.triangles() {
                    let squared = from_triangle(triangle);
                    if squared < best.1 {
                        best = (triangle, squared);
                    }
                }
                continue;
            }
            let children = [index + 1, node.right()].map(|child| (from_box(child), child));
            let [near, far] =
                if children[0].0 <= children[1].0 { children } else { [children[1], children[0]] };
            for child in [far, near] {
                if child.0 < slack * best.1 {
                    waiting[count] = child;
                    count += 1;
                }
            }
        }
        self.solid.tally.searches.add(1);
        self.solid.tally.looks.add(looks);
        best
    }

    /// Signed distance and gradient about a nearest triangle.
    fn seen(&self, point: Vec3, triangle: u32, away: f32) -> SkinPlace {
        let (place, feature) = nearest_on(self.corners(&self.end, triangle), point);
        let outward = self.outward(triangle, feature) * self.facing;
        let is_inside =
            outward.dot(point - place) < 0.0 && !self.is_before_a_fold(point, triangle, feature, place);
        let side = if is_inside { -1.0 } else { 1.0 };
        let is_face = matches!(feature, Feature::Face);
        let normal = if is_face || away < TOUCHING { outward } else { (point - place) * (side / away) };
        SkinPlace { distance: side * away, normal: normal.normalize_or(Vec3::Y), triangle }
    }

    /// Corners of a triangle at the end of the step, from the one that coincides with `vertex` on.
    pub(crate) fn corners_from(&self, triangle: u32, vertex: u32) -> [Vec3; 3] {
        let (at, first) = (self.solid.triangles[triangle as usize], self.solid.welded[vertex as usize]);
        let own = at.iter().position(|corner| self.solid.welded[*corner as usize] == first).unwrap_or(0);
        let corners = self.corners(&self.end, triangle);
        [own, (own + 1) % 3, (own + 2) % 3].map(|corner| corners[corner])
    }

    /// Direction that leads out of the skin at a part of a triangle \[Baerentzen2005\].
    fn outward(&self, triangle: u32, feature: Feature) -> Vec3 {
        let normal = |index: u32| {
            let [a, b, c] = self.corners(&self.end, index);
            (b - a).cross(c - a).normalize_or_zero()
        };
        match feature {
            Feature::Face => normal(triangle),
            Feature::Edge(edge) => match self.solid.across[triangle as usize][edge] {
                NONE => normal(triangle),
                other => normal(triangle) + normal(other),
            },
            Feature::Corner(corner) => {
                let vertex = self.solid.triangles[triangle as usize][corner];
                let part = |index: &u32| {
                    let [here, next, last] = self.corners_from(*index, vertex);
                    let angle = (next - here).angle_between(last - here);
                    if angle.is_finite() { normal(*index) * angle } else { Vec3::ZERO }
                };
                self.solid.around(vertex).iter().map(part).sum()
            }
        }
    }

    /// Way \[m\] through the step of the material of a triangle that ends nearest to a point \[m\].
    pub fn shift(&self, triangle: u32, point: Vec3) -> Vec3 {
        if triangle as usize >= self.solid.triangles.len() {
            return Vec3::ZERO;
        }
        let corners = self.corners(&self.end, triangle);
        let shares = shares(corners, point);
        at_shares(corners, shares) - at_shares(self.corners(&self.start, triangle), shares)
    }

    /// Mean way \[m\] of the corners of a triangle through the step; none of an unknown one.
    pub fn drift(&self, triangle: u32) -> Vec3 {
        self.drifts.get(triangle as usize).copied().unwrap_or_default()
    }

    /// Motion of a triangle about its place nearest to a point of the start \[m\]; `None` where it has no area, and in a step
    /// that turns the skin inside out.
    pub fn motion(&self, triangle: u32, point: Vec3) -> Option<TriangleMotion> {
        if triangle as usize >= self.solid.triangles.len() || self.turns_over {
            return None;
        }
        let [start, end] = [&self.start, &self.end].map(|positions| self.corners(positions, triangle));
        let turn = axes(end)? * axes(start)?.transpose();
        let shares = shares(start, point);
        let motion =
            TriangleMotion { start: at_shares(start, shares), end: at_shares(end, shares), turn, error: 0.0 };
        let errors = start.iter().zip(end).map(|(start, end)| motion.point(*start).distance_squared(end));
        Some(TriangleMotion { error: errors.fold(0.0, f32::max).sqrt(), ..motion })
    }
}

/// First edge, normal and the direction across both; `None` without an area.
fn axes([a, b, c]: [Vec3; 3]) -> Option<Mat3> {
    let normal = (b - a).cross(c - a).try_normalize()?;
    let along = (b - a).try_normalize()?;
    Some(Mat3::from_cols(along, normal, along.cross(normal)))
}

/// Shares of the corners in the place of a triangle that is nearest to a point.
fn shares(corners: [Vec3; 3], point: Vec3) -> Vec3 {
    let (_, [to_b, to_c]) = nearest_shares(corners, point);
    let shares = Vec3::new(1.0 - to_b - to_c, to_b, to_c);
    if shares.is_finite() { shares } else { Vec3::X }
}

fn at_shares([a, b, c]: [Vec3; 3], shares: Vec3) -> Vec3 {
    a * shares.x + b * shares.y + c * shares.z
}
