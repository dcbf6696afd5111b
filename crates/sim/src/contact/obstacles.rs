//! Colliders placed in the world for the duration of a step.

use glam::Vec3;
use strandline_body::{Carrier, Collider, Pose};

/// The colliders at the end of a step, and how they got there.
#[derive(Clone, Copy)]
pub struct Obstacles<'a> {
    /// The solids.
    pub colliders: &'a [Collider],
    /// Pose of the head at the start of the step.
    pub start: Pose,
    /// Pose of the head at the end of the step.
    pub end: Pose,
    /// Length of the step \[s\].
    pub time_step: f32,
}

impl Obstacles<'_> {
    /// Signed distance \[m\] to the nearest solid at the end of the step, its unit gradient, and
    /// the solid's index; `None` without colliders. World space; who asks often finds `head_from_world` once.
    pub fn nearest(&self, point: Vec3, head_from_world: &Pose) -> Option<(f32, Vec3, usize)> {
        self.colliders
            .iter()
            .enumerate()
            .map(|(index, collider)| match collider.carrier {
                Carrier::World => {
                    let (distance, gradient) = collider.shape.distance_and_gradient(point);
                    (distance, gradient, index)
                }
                Carrier::Head => {
                    let (distance, gradient) =
                        collider.shape.distance_and_gradient(head_from_world.point(point));
                    (distance, self.end.direction(gradient), index)
                }
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Signed distance \[m\] to the nearest solid at the end of the step, infinite without solids: that of
    /// [`Self::nearest`]. World space.
    pub fn distance(&self, point: Vec3, head_from_world: &Pose) -> f32 {
        let distances = self.colliders.iter().map(|collider| match collider.carrier {
            Carrier::World => collider.shape.distance(point),
            Carrier::Head => collider.shape.distance(head_from_world.point(point)),
        });
        distances.fold(f32::INFINITY, f32::min)
    }

    /// Mean velocity \[m/s\] over the step of the material of the nearest solid that ends at `point`, none without
    /// solids. Where all are carried by one thing it need not be known which is the nearest.
    pub fn nearest_velocity(&self, point: Vec3, head_from_world: &Pose) -> Option<Vec3> {
        let first = self.colliders.first()?;
        let together = self.colliders.iter().all(|collider| collider.carrier == first.carrier);
        let nearest = if together { 0 } else { self.nearest(point, head_from_world)?.2 };
        Some(self.velocity(nearest, point, head_from_world))
    }

    /// How far \[m\] all solids are from a point at the end of the step at least, 0 where it may be inside one; quicker
    /// than [`Self::nearest`]. World space.
    pub fn at_least(&self, point: Vec3, head_from_world: &Pose) -> f32 {
        let least = self.colliders.iter().map(|collider| match collider.carrier {
            Carrier::World => collider.shape.distance_at_least(point),
            Carrier::Head => collider.shape.distance_at_least(head_from_world.point(point)),
        });
        least.fold(f32::INFINITY, f32::min)
    }

    /// Mean velocity \[m/s\] over the step of the material of a collider that ends at `point`.
    pub fn velocity(&self, collider: usize, point: Vec3, head_from_world: &Pose) -> Vec3 {
        match self.colliders[collider].carrier {
            Carrier::World => Vec3::ZERO,
            Carrier::Head => (point - self.start.point(head_from_world.point(point))) / self.time_step,
        }
    }
}
