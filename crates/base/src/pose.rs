use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::math;

/// A rigid transform. Name a value by its two spaces: `world_from_head`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Rotation, unit quaternion.
    pub rotation: Quat,
    /// Translation \[m\], applied after the rotation.
    pub translation: Vec3,
}

impl Pose {
    /// The identity.
    pub const IDENTITY: Self = Self { rotation: Quat::IDENTITY, translation: Vec3::ZERO };

    /// A rotation about a fixed point \[m\].
    pub fn rotation_about(pivot: Vec3, rotation: Quat) -> Self {
        Self { rotation, translation: pivot - rotation * pivot }
    }

    /// Carries a point \[m\].
    #[inline]
    pub fn point(&self, point: Vec3) -> Vec3 {
        self.rotation * point + self.translation
    }

    /// Carries a direction; lengths are kept.
    #[inline]
    pub fn direction(&self, direction: Vec3) -> Vec3 {
        self.rotation * direction
    }

    /// The inverse.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// The pose after a motion in the space that it leads to.
    #[inline]
    pub fn carried_by(&self, motion: &Self) -> Self {
        Self { rotation: motion.rotation * self.rotation, translation: motion.point(self.translation) }
    }

    /// The motion from this pose to another, in the space that both lead to.
    pub fn motion_to(&self, end: &Self) -> Self {
        let back = self.inverse();
        Self { rotation: end.rotation * back.rotation, translation: end.point(back.translation) }
    }

    /// One of `count` equal parts of the way to `end`, counted from 0: the pose at its end, and the motion through it,
    /// which is the identity between equal poses.
    pub fn part_of_way(&self, end: &Self, part: u32, count: u32) -> (Self, Self) {
        let pose = |part: u32| self.toward(end, part as f32 / count as f32);
        let (before, after) = (pose(part), pose(part + 1));
        (after, if before == after { Self::IDENTITY } else { before.motion_to(&after) })
    }

    /// The pose on the way to `end`: linear in translation, spherical in rotation;
    /// `share` is 0 here and 1 at `end`. Between equal poses the result is exact.
    pub fn toward(&self, end: &Self, share: f32) -> Self {
        if self == end {
            return *self;
        }
        Self {
            rotation: math::slerp(self.rotation, end.rotation, share),
            translation: self.translation.lerp(end.translation, share),
        }
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_way_lead_to_its_end() {
        let start = Pose::rotation_about(Vec3::X, Quat::from_rotation_y(0.7));
        let end = Pose { translation: Vec3::Z, ..Pose::rotation_about(Vec3::Y, Quat::from_rotation_x(0.4)) };
        let point = Vec3::new(0.3, 0.2, 0.9);
        let goes = (0..5).fold(start.point(point), |at, part| start.part_of_way(&end, part, 5).1.point(at));
        // Each of the five parts rounds the turn of a point a metre away by up to 4e-7 m.
        assert!(goes.distance(end.point(point)) < 2e-6);
        assert!(start.motion_to(&end).point(start.point(point)).distance(end.point(point)) < 1e-6);
        assert_eq!(start.part_of_way(&end, 4, 5).0.translation, end.translation);
        assert_eq!(start.part_of_way(&start, 1, 5), (start, Pose::IDENTITY));
    }

    #[test]
    fn the_inverse_undoes() {
        let pose = Pose::rotation_about(Vec3::new(0.1, 1.0, -0.2), Quat::from_rotation_y(0.7));
        let point = Vec3::new(0.3, 0.2, 0.9);
        assert!((pose.inverse().point(pose.point(point)) - point).length() < 1e-6);
        assert!((pose.point(Vec3::new(0.1, 1.0, -0.2)) - Vec3::new(0.1, 1.0, -0.2)).length() < 1e-6);
    }
}
