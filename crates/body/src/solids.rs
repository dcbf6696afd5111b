//! Solids that drawn strands stay out of.

use std::sync::Arc;

use glam::Vec3;

use crate::{BodyFrame, Carrier, Collider, Pose, PosedSkin};

/// Solids, each with the distance \[m\] that strands keep from it.
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

    /// True for these colliders in this order, each with the distance that drawn strands keep from its shape.
    pub fn are(&self, colliders: &[Collider]) -> bool {
        let is_same = |((solid, kept), collider): (&(Collider, f32), &Collider)| {
            solid.carrier == collider.carrier
                && solid.shape.is_same(&collider.shape)
                && *kept == collider.shape.clearance()
        };
        self.0.len() == colliders.len() && self.0.iter().zip(colliders).all(is_same)
    }

    /// The solids at a time: a frame of the body, or the pose of a rigid head.
    pub fn placed(&self, body: impl Into<BodyFrame>) -> PlacedSolids<'_> {
        let body = body.into();
        let piece = |(solid, _): &(Collider, f32)| match solid.carrier {
            Carrier::Piece(piece) | Carrier::Moved(piece) => usize::from(piece) + 1,
            Carrier::World => 0,
        };
        let count = self.0.iter().map(piece).max().unwrap_or(0);
        let place = |piece| {
            let world_from_piece = body.piece(piece);
            [world_from_piece, world_from_piece.inverse()]
        };
        let posed = self.0.iter().map(|(solid, _)| PosedSkin::of(solid, &body, &body)).collect();
        PlacedSolids { solids: &self.0, posed, pieces: (0..count).map(place).collect() }
    }
}

/// Solids at a time.
#[derive(Clone, Debug)]
pub struct PlacedSolids<'a> {
    solids: &'a [(Collider, f32)],
    /// Skins that move by themselves.
    posed: Vec<Option<PosedSkin>>,
    /// Transform and inverse of each piece that carries solids.
    pieces: Vec<[Pose; 2]>,
}

impl PlacedSolids<'_> {
    /// True without solids.
    pub fn is_empty(&self) -> bool {
        self.solids.is_empty()
    }

    /// Signed distance \[m\] of a point \[m\], world space, to the nearest solid, less how far strands stay away from
    /// it, and its unit gradient.
    pub fn at(&self, point: Vec3) -> (f32, Vec3) {
        let start = (f32::INFINITY, Vec3::Y, Carrier::World);
        let solids = self.solids.iter().zip(&self.posed);
        let (distance, gradient, carrier) = solids.fold(start, |best, ((solid, away), posed)| {
            let local = self.local(solid.carrier, point);
            let (distance, gradient) = match posed {
                Some(skin) => skin.distance_and_gradient(local),
                None if solid.shape.is_beyond(local, (best.0 + away).max(0.0)) => return best,
                None => solid.shape.distance_and_gradient(local),
            };
            if distance - away < best.0 { (distance - away, gradient, solid.carrier) } else { best }
        });
        let turned = match carrier {
            Carrier::Piece(piece) | Carrier::Moved(piece) => {
                self.pieces[usize::from(piece)][0].direction(gradient)
            }
            Carrier::World => gradient,
        };
        (distance, turned)
    }

    /// A point \[m\] in the space of a carrier.
    fn local(&self, carrier: Carrier, point: Vec3) -> Vec3 {
        match carrier {
            Carrier::Piece(piece) | Carrier::Moved(piece) => self.pieces[usize::from(piece)][1].point(point),
            Carrier::World => point,
        }
    }

    /// No more than that distance, and 0 where the point may be inside: quick.
    pub fn at_least(&self, point: Vec3) -> f32 {
        let least = self.solids.iter().zip(&self.posed).map(|((solid, away), posed)| {
            let local = self.local(solid.carrier, point);
            let least = match posed {
                Some(skin) => skin.at_least(local),
                None => solid.shape.distance_at_least(local),
            };
            least - away
        });
        least.fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;

    #[test]
    fn other_solids_and_other_clearances_are_not_the_same() {
        let solid =
            |x: f32, carrier| Collider::new(Shape::sphere(Vec3::X * x, 0.1).unwrap(), carrier, 0.3).unwrap();
        let (head, world) = (solid(0.0, Carrier::HEAD), solid(0.5, Carrier::World));
        let solids = Solids::new([(head.clone(), 0.0), (world.clone(), 0.0)]);
        assert!(solids.are(&[head.clone(), world.clone()]));
        assert!(!solids.are(&[world.clone(), head.clone()]) && !solids.are(std::slice::from_ref(&head)));
        assert!(!solids.are(&[solid(0.0, Carrier::Piece(1)), world.clone()]));
        assert!(!solids.are(&[solid(0.1, Carrier::HEAD), world.clone()]));
        assert!(!Solids::new([(head.clone(), 0.001), (world.clone(), 0.0)]).are(&[head, world]));
    }
}
