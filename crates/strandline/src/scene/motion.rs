use glam::Vec3;
use strandline_base::math;
use strandline_base::{choices, settings};

use crate::{
    Error,
    body::{Interpolation, Keyframe, Motion},
};

choices! {
    /// The name of a motion.
    pub enum MotionName as "motion.name" {
        /// The head rests.
        Still = "still",
        /// "No".
        Shake = "shake",
        /// "Yes".
        Nod = "nod",
        /// A slow look to both sides.
        Turn = "turn",
        /// The poses of `[[motion.keyframes]]`.
        Keyframes = "keyframes",
    }
    default Shake
}

settings! {
    /// A pose at a time, as a person writes it.
    pub struct KeyframeSection: Copy {
        /// Time; each later than the one before.
        time: f64 = 0.0, in [-1e6, 1e6] "s";
        /// Angles about the pivot: pitch (about x), yaw (about y), roll (about z), applied in the order roll, pitch,
        /// yaw; each angle is a curve of its own, so 720 degrees are two turns.
        rotation: Vec3 = Vec3::ZERO, in [-36_000.0, 36_000.0] "degrees", slider [-180.0, 180.0];
        /// Displacement of the pivot.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// The way to the next pose; without it that of `motion.interpolation`.
        interpolation: Option<Interpolation> = None;
        /// A jump: the pose before is held until this one.
        cut: bool = false;
    }
}

settings! {
    /// Motion of the head.
    pub struct MotionSection {
        /// The motion.
        name: MotionName = MotionName::default();
        /// Point about which the head turns, head space; without one it is the mannequin's neck, or a
        /// point low in the body's or the groom's box.
        pivot: Option<Vec3> = None, in [-1e4, 1e4] "m";
        /// Rotation of the head added to its motion, about the pivot: pitch (about x), yaw (about y),
        /// roll (about z).
        rotation: Vec3 = Vec3::ZERO, in [-360.0, 360.0] "degrees", slider [-70.0, 70.0];
        /// The way from pose to pose, where a pose does not name its own.
        interpolation: Interpolation = Interpolation::default();
        /// Poses, in the order of their times; used by "keyframes".
        keyframes: Vec<KeyframeSection> = Vec::new();
    }
}

impl MotionSection {
    /// The motion itself.
    ///
    /// # Errors
    /// Keyframes that are missing, not finite or not in the order of their times.
    pub fn motion(&self) -> Result<Motion, Error> {
        Ok(match self.name {
            MotionName::Still => Motion::Still,
            MotionName::Shake => Motion::Shake,
            MotionName::Nod => Motion::Nod,
            MotionName::Turn => Motion::Turn,
            MotionName::Keyframes => {
                let keys: Vec<_> =
                    self.keyframes.iter().map(|key| key.keyframe(self.interpolation)).collect();
                Motion::keyframes(&keys)?
            }
        })
    }
}

impl KeyframeSection {
    fn keyframe(&self, interpolation: Interpolation) -> Keyframe {
        Keyframe {
            time: self.time,
            rotation: self.rotation,
            translation: self.translation,
            interpolation: self.interpolation.unwrap_or(interpolation),
            is_cut: self.cut,
        }
    }
}

settings! {
    /// Motion of the air.
    pub struct WindSection: Copy {
        /// Mean velocity, world space.
        velocity: Vec3 = Vec3::ZERO, in [-100.0, 100.0] "m/s", slider [-10.0, 10.0];
        /// Share of the velocity that comes and goes.
        gust: f32 = 0.5, in [0.0, 1.0], more "stronger gusts and lulls";
        /// Time from gust to gust.
        gust_period: f32 = 1.7, in [0.05, 1000.0] "s", slider [0.2, 10.0], more "slower gusts";
    }
}

impl WindSection {
    /// Velocity of the air \[m/s\] at a time \[s\]: two swings whose periods have no common multiple.
    pub fn at(&self, time: f64) -> Vec3 {
        let phase = std::f64::consts::TAU * time / f64::from(self.gust_period);
        let swing = 0.7 * math::sin(phase) + 0.3 * math::sin(2.618 * phase);
        self.velocity * (1.0 + self.gust * swing as f32)
    }
}
