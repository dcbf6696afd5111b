use glam::{Quat, Vec3};
use strandline_base::math;

use crate::{
    Error,
    body::{Motion, Pose},
    scene::MotionSection,
};

/// Pose of a head at every time: a motion about a pivot, and a turn added to it.
#[derive(Clone, Debug)]
pub struct HeadMotion {
    motion: Motion,
    pivot: Vec3,
    turn: Quat,
}

impl HeadMotion {
    /// The motion of a section about a pivot \[m\], head space.
    ///
    /// # Errors
    /// Keyframes that are missing, not finite or not in the order of their times.
    pub fn new(section: &MotionSection, pivot: Vec3) -> Result<Self, Error> {
        let turn = math::pitch_yaw_roll(section.rotation);
        Ok(Self { motion: section.motion()?, pivot, turn })
    }

    /// A head that rests.
    pub(crate) fn still() -> Self {
        Self { motion: Motion::Still, pivot: Vec3::ZERO, turn: Quat::IDENTITY }
    }

    /// The pose of the head at a time \[s\].
    pub fn pose(&self, time: f64) -> Pose {
        let pose = self.motion.pose(time, self.pivot);
        let rotation = pose.rotation * self.turn;
        Pose { rotation, translation: pose.point(self.pivot) - rotation * self.pivot }
    }

    /// Point about which the head turns \[m\], head space.
    pub fn pivot(&self) -> Vec3 {
        self.pivot
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::MotionName;

    #[test]
    fn the_turn_goes_about_the_pivot_and_moves_with_the_head() {
        let pivot = Vec3::new(0.0, -0.1, 0.02);
        let still = MotionSection { name: MotionName::Still, ..MotionSection::default() };
        let turned = MotionSection { rotation: Vec3::new(0.0, 90.0, 0.0), ..still.clone() };
        let head = HeadMotion::new(&turned, pivot).unwrap();
        assert!(head.pose(1.0).point(pivot).distance(pivot) < 1e-6);
        let ahead = head.pose(1.0).point(pivot + Vec3::Z);
        assert!(ahead.distance(pivot + Vec3::X) < 1e-5, "{ahead}");
        let nods = MotionSection { name: MotionName::Nod, ..turned };
        let pose = HeadMotion::new(&nods, pivot).unwrap().pose(0.4);
        let plain = HeadMotion::new(&MotionSection { name: MotionName::Nod, ..still }, pivot).unwrap();
        let expected = plain.pose(0.4).point(pivot + Vec3::X);
        assert!(pose.point(pivot + Vec3::Z).distance(expected) < 1e-5);
    }
}
