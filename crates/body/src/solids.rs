//! Solids that drawn strands stay out of.

use std::sync::Arc;

use glam::Vec3;

use crate::{Carrier, Collider, Pose};

/// Solids, and how far \[m\] strands stay away from each.
#[derive(Clone, Debug, Default)]
pub struct Solids(Arc<[(Collider, f32)]>);

impl Solids {
    /// Solids in the space of their carrier.
    pub fn new(solids: impl IntoIterator<Item = (Collider, f32)>) -> Self {
        Self(solids.into_iter().collect())
    }

    /// The solids, and how far \[m\] strands stay away from each.
    pub fn all(&self) -> &[(Collider, f32)] {
        &self.0
    }

    /// The solids as the head has them.
    pub fn placed(&self, world_from_head: Pose) -> PlacedSolids<'_> {
        PlacedSolids { solids: &self.0, world_from_head, head_from_world: world_from_head.inverse() }
    }
}

/// Solids, some of them carried by a head.
#[derive(Clone, Copy, Debug)]
pub struct PlacedSolids<'a> {
    solids: &'a [(Collider, f32)],
    world_from_head: Pose,
    head_from_world: Pose,
}

impl PlacedSolids<'_> {
    /// True without solids.
    pub fn is_empty(&self) -> bool {
        self.solids.is_empty()
    }

    /// Signed distance \[m\] of a point \[m\], world space, to the nearest solid, less how far strands stay away from
    /// it, and its unit gradient.
    pub fn at(&self, point: Vec3) -> (f32, Vec3) {
        let in_head = self.head_from_world.point(point);
        let start = (f32::INFINITY, Vec3::Y, Carrier::World);
        let (distance, gradient, carrier) = self.solids.iter().fold(start, |best, (solid, away)| {
            let place = if solid.carrier == Carrier::Head { in_head } else { point };
            let (distance, gradient) = solid.shape.distance_and_gradient(place);
            if distance - away < best.0 { (distance - away, gradient, solid.carrier) } else { best }
        });
        let turned =
            if carrier == Carrier::Head { self.world_from_head.direction(gradient) } else { gradient };
        (distance, turned)
    }

    /// No more than that distance, and 0 where the point may be inside: quick.
    pub fn at_least(&self, point: Vec3) -> f32 {
        let in_head = self.head_from_world.point(point);
        let least = self.solids.iter().map(|(solid, away)| {
            let place = if solid.carrier == Carrier::Head { in_head } else { point };
            solid.shape.distance_at_least(place) - away
        });
        least.fold(f32::INFINITY, f32::min)
    }
}
