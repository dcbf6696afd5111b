//! Colliders placed in the world for the duration of a step.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use strandline_body::{BodyFrame, Carrier, Collider, CommonCaps, Places, Pose, PosedSkin, Sides};

/// The colliders at the end of a step, and their motion through it.
#[derive(Clone)]
pub struct Obstacles<'a> {
    /// The solids.
    pub colliders: &'a [Collider],
    /// Body at the start of the step.
    pub start: BodyFrame,
    /// Body at the end of the step.
    pub end: BodyFrame,
    /// Length of the step \[s\].
    pub time_step: f32,
    /// The pieces that carry solids, by their number.
    pieces: Vec<Placed>,
    /// For each collider its skin, where that moves by itself.
    skins: Skins,
    /// Planes about the parts of a neck.
    common: Option<CommonCaps>,
}

/// For each collider its skin, where that moves by itself.
pub type Skins = Vec<Option<Arc<PosedSkin>>>;

/// A piece through a step.
#[derive(Clone, Copy)]
struct Placed {
    start: Pose,
    end: Pose,
    piece_from_world: Pose,
}

impl<'a> Obstacles<'a> {
    /// Places colliders for a step of `time_step` \[s\] between two frames of the body.
    pub fn new(colliders: &'a [Collider], start: BodyFrame, end: BodyFrame, time_step: f32) -> Self {
        Self::after(&[], colliders, start, end, time_step)
    }

    /// The same after a step with these skins, which are used again where they stand still.
    pub fn after(
        known: &[Option<Arc<PosedSkin>>],
        colliders: &'a [Collider],
        start: BodyFrame,
        end: BodyFrame,
        time_step: f32,
    ) -> Self {
        let skin = |(index, collider): (usize, &Collider)| {
            let is_known = |known: &&Arc<PosedSkin>| known.is_of(collider, &start, &end);
            match known.get(index).and_then(Option::as_ref).filter(is_known) {
                Some(known) => Some(Arc::clone(known)),
                None => PosedSkin::of(collider, &start, &end).map(Arc::new),
            }
        };
        let skins = colliders.iter().enumerate().map(skin).collect();
        let piece = |collider: &Collider| match collider.carrier {
            Carrier::Piece(piece) | Carrier::Moved(piece) => usize::from(piece) + 1,
            Carrier::World => 0,
        };
        let count = colliders.iter().map(piece).max().unwrap_or(0);
        let place = |piece| {
            let (start, end) = (start.piece(piece), end.piece(piece));
            Placed { start, end, piece_from_world: end.inverse() }
        };
        let pieces: Vec<Placed> = (0..count).map(place).collect();
        let poses = |collider: &Collider| match piece(collider).checked_sub(1) {
            Some(piece) => [pieces[piece].start, pieces[piece].end],
            None => [Pose::IDENTITY; 2],
        };
        let common = CommonCaps::of(colliders, poses);
        Self { colliders, start, end, time_step, pieces, skins, common }
    }

    /// For each collider its skin, where that moves by itself.
    pub fn skins(&self) -> &Skins {
        &self.skins
    }

    /// True where a skin moves by itself.
    pub fn has_moving_skin(&self) -> bool {
        self.skins.iter().any(Option::is_some)
    }

    /// Colliders with their skins.
    pub(super) fn solids(&self) -> impl Iterator<Item = (&Collider, Option<&PosedSkin>)> {
        self.colliders.iter().zip(self.skins.iter().map(Option::as_deref))
    }

    /// Planes about the parts of a neck, where there are such.
    pub(super) fn common(&self) -> Option<&CommonCaps> {
        self.common.as_ref()
    }

    /// The parts of a neck among the colliders, and how far \[m\] a point lies beyond all of them at the end of the step.
    #[inline]
    fn beyond_parts(&self, point: Vec3) -> (Range<usize>, f32) {
        let none = (0..0, f32::NEG_INFINITY);
        self.common.as_ref().map_or(none, |common| (common.parts.clone(), common.beyond(point)))
    }

    /// A point in the space of a collider's carrier.
    #[inline]
    fn local(&self, collider: &Collider, point: Vec3) -> Vec3 {
        match collider.carrier {
            Carrier::World => point,
            Carrier::Piece(piece) | Carrier::Moved(piece) => {
                self.pieces[usize::from(piece)].piece_from_world.point(point)
            }
        }
    }

    /// Signed distance \[m\] to the nearest solid at the end of the step, its unit gradient, and
    /// the solid's index; `None` without colliders. World space.
    pub fn nearest(&self, point: Vec3) -> Option<(f32, Vec3, usize)> {
        let mut nearest: Option<(f32, Vec3, usize)> = None;
        let (parts, beyond) = self.beyond_parts(point);
        for (index, (collider, skin)) in self.solids().enumerate() {
            if parts.contains(&index) && nearest.is_some_and(|(least, ..)| beyond >= least.max(0.0)) {
                continue;
            }
            let local = self.local(collider, point);
            if nearest.is_some_and(|(least, ..)| collider.shape.is_beyond(local, least.max(0.0))) {
                continue;
            }
            let (distance, gradient) = match skin {
                Some(skin) => skin.distance_and_gradient(local),
                None => collider.shape.distance_and_gradient(local),
            };
            if nearest.is_none_or(|(least, ..)| distance.total_cmp(&least).is_lt()) {
                nearest = Some((distance, gradient, index));
            }
        }
        nearest.map(|(distance, gradient, index)| match self.colliders[index].carrier {
            Carrier::World => (distance, gradient, index),
            Carrier::Piece(piece) | Carrier::Moved(piece) => {
                (distance, self.pieces[usize::from(piece)].end.direction(gradient), index)
            }
        })
    }

    /// Lower bound \[m\] of the distance of all solids from a point at the end of the step, 0 where it may be inside
    /// one; quicker than [`Self::nearest`]. World space. `before` is the triangle of a skin near the last point, for
    /// points one beside the other.
    pub fn at_least(&self, point: Vec3, before: &mut u32) -> f32 {
        self.at_least_or(point, before, 0.0)
    }

    /// As [`Self::at_least`]; 0 or the bound where the bound is at most `enough` \[m\].
    pub fn at_least_or(&self, point: Vec3, before: &mut u32, enough: f32) -> f32 {
        let mut least = f32::INFINITY;
        let (parts, beyond) = self.beyond_parts(point);
        for (index, (collider, skin)) in self.solids().enumerate() {
            if parts.contains(&index) && beyond >= least {
                continue;
            }
            let local = self.local(collider, point);
            let found = match skin {
                Some(skin) => {
                    let (found, triangle) = skin.at_least_about(local, *before, enough);
                    *before = triangle;
                    found
                }
                None if collider.shape.is_beyond(local, least) => continue,
                None => collider.shape.distance_at_least(local),
            };
            least = least.min(found);
        }
        least
    }

    /// Signed distance \[m\] to the nearest solid at the end of the step, infinite without solids: that of
    /// [`Self::nearest`]. World space. `before` is as in [`Self::at_least`].
    pub fn distance(&self, point: Vec3, before: &mut u32) -> f32 {
        let mut nearest = f32::INFINITY;
        let (parts, beyond) = self.beyond_parts(point);
        for (index, (collider, skin)) in self.solids().enumerate() {
            if parts.contains(&index) && beyond >= nearest.max(0.0) {
                continue;
            }
            let local = self.local(collider, point);
            let distance = match skin {
                Some(skin) => {
                    let found = skin.nearest(local, *before);
                    *before = found.triangle;
                    found.distance
                }
                None if collider.shape.is_beyond(local, nearest.max(0.0)) => continue,
                None => collider.shape.distance(local),
            };
            nearest = nearest.min(distance);
        }
        nearest
    }

    /// True where a skin that moves by itself is the only solid.
    pub fn are_one_moving_skin(&self) -> bool {
        matches!(&self.skins[..], [Some(_)])
    }

    /// The sides of places on a line at the end of the step, world space, where a skin that moves by itself is the only
    /// solid and has no hole there.
    pub fn sides_along(&self, places: Places) -> Option<Sides> {
        let [collider] = self.colliders else { return None };
        let skin = self.skins[0].as_deref()?;
        let step = self.local(collider, places.first + places.step) - self.local(collider, places.first);
        skin.sides_along(&Places { first: self.local(collider, places.first), step, ..places })
    }

    /// Mean velocity \[m/s\] over the step of the material of the nearest solid that ends at `point`, `None` without
    /// solids. Solids with one carrier need no search for the nearest. Of a skin that moves by itself a triangle tells it that is at
    /// most a quarter farther than the nearest. `before` is as in [`Self::at_least`].
    pub fn nearest_velocity(&self, point: Vec3, before: &mut u32) -> Option<Vec3> {
        let first = self.colliders.first()?;
        let together = self.colliders.iter().all(|collider| collider.carrier == first.carrier);
        let nearest = if together { 0 } else { self.nearest(point)?.2 };
        Some(self.velocity(nearest, point, before, false))
    }

    /// The same at a point near which `before` is a triangle, as after [`Self::distance`].
    pub fn velocity_there(&self, point: Vec3, before: &mut u32) -> Option<Vec3> {
        if self.colliders.len() != 1 {
            return self.nearest_velocity(point, before);
        }
        Some(self.velocity(0, point, before, true))
    }

    /// The same at a point of a skin that moves by itself, the only solid: `before` is a triangle about as near as `enough` \[m\], or
    /// a nearer one is searched for. Where the skin about the point stands still it moves with its carrier, without a search.
    pub fn velocity_within(&self, point: Vec3, before: &mut u32, enough: f32) -> Option<Vec3> {
        if !self.is_still_about(point, *before) {
            self.at_least_or(point, before, enough);
        }
        self.velocity_there(point, before)
    }

    /// True where a skin that moves by itself is the only solid and stands still about a point in the space of its carrier.
    fn is_still_about(&self, point: Vec3, before: u32) -> bool {
        match (self.colliders, &self.skins[..]) {
            ([collider], [Some(skin)]) => skin.is_still_about(self.local(collider, point), before),
            _ => false,
        }
    }

    /// Mean velocity \[m/s\] over the step of the material of a collider that ends at `point`.
    /// `before` is a triangle near the point already where `is_near`.
    fn velocity(&self, collider: usize, point: Vec3, before: &mut u32, is_near: bool) -> Vec3 {
        match self.colliders[collider].carrier {
            Carrier::World => Vec3::ZERO,
            Carrier::Piece(piece) | Carrier::Moved(piece) => {
                let Placed { start, piece_from_world, .. } = self.pieces[usize::from(piece)];
                let local = piece_from_world.point(point);
                let shift = self.skins[collider].as_ref().map_or(Vec3::ZERO, |skin| {
                    if skin.is_still_about(local, *before) {
                        return Vec3::ZERO;
                    }
                    if !is_near {
                        *before = skin.triangle_about(local, *before);
                    }
                    skin.shift(*before, local)
                });
                (point - start.point(local - shift)) / self.time_step
            }
        }
    }
}
