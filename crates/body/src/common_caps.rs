//! Planes about all parts of a bent neck together: a point beyond them asks no part.

use std::ops::Range;

use glam::Vec3;

use crate::{Caps, Collider, Pose};

/// Planes about the parts of a neck that lie one upon the other, in a step.
#[derive(Clone, Debug)]
pub struct CommonCaps {
    /// Indices of the parts among the colliders.
    pub parts: Range<usize>,
    /// The planes, in the space that `from_world` leads to.
    pub caps: Caps,
    /// Space of the part in the middle at the end of the step.
    pub from_world: Pose,
    /// A place amid the parts at the start of the step, world space \[m\].
    pub middle: Vec3,
    /// Way of what rests on a part through the step: at most this \[m\] at `middle`.
    pub way: f32,
    /// The most that the way grows by each metre from `middle`.
    pub turn: f32,
}

impl CommonCaps {
    /// The planes about the parts among colliders whose planes bound them on all sides; `None` where fewer than two such parts
    /// follow each other. `poses` gives the transforms of a collider at the start and the end of a step, `world_from_carrier`.
    pub fn of(colliders: &[Collider], poses: impl Fn(&Collider) -> [Pose; 2]) -> Option<Self> {
        let bounded = |collider: &Collider| collider.shape.caps().filter(|caps| caps.is_bounded()).copied();
        let first = colliders.iter().position(|collider| bounded(collider).is_some())?;
        let parts: Vec<(Caps, [Pose; 2])> = colliders[first..]
            .iter()
            .map_while(|collider| Some((bounded(collider)?, poses(collider))))
            .collect();
        if parts.len() < 2 {
            return None;
        }
        let [_, end] = parts[parts.len() / 2].1;
        let from_world = end.inverse();
        let corners = parts
            .iter()
            .flat_map(|(caps, [_, end])| caps.corners().map(|corner| from_world.point(end.point(corner))));
        let caps = Caps::around(corners);
        let middle = {
            let (caps, [start, _]) = &parts[parts.len() / 2];
            start.point(caps.corners().iter().sum::<Vec3>() / caps.corners().len() as f32)
        };
        let (mut way, mut turn) = (0.0_f32, 0.0_f32);
        for (_, [start, end]) in &parts {
            let moved = start.motion_to(end);
            way = way.max(moved.point(middle).distance(middle));
            // A chord of a rotation by an angle is twice its half's sine.
            turn = turn.max(2.0 * moved.rotation.xyz().length().min(1.0));
        }
        // Rounding of poses and corners.
        Some(Self {
            parts: first..first + parts.len(),
            caps,
            from_world,
            middle,
            way: way + 1e-5,
            turn: turn + 1e-5,
        })
    }

    /// Lower bound \[m\] of the distance of a point \[m\], world space, from all parts; below 0 between all planes.
    #[inline]
    pub fn beyond(&self, point: Vec3) -> f32 {
        self.caps.beyond(self.from_world.point(point))
    }
}
