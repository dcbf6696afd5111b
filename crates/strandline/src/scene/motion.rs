use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::within;
use crate::{
    Error,
    body::{Keyframe, Motion, Pose},
    head::rotation,
};

/// The name of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MotionName {
    /// The head rests.
    Still,
    /// "No".
    #[default]
    Shake,
    /// "Yes".
    Nod,
    /// A slow look to both sides.
    Turn,
    /// The poses of `[[motion.keyframes]]`.
    Keyframes,
}

impl std::str::FromStr for MotionName {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "still" => Ok(Self::Still),
            "shake" => Ok(Self::Shake),
            "nod" => Ok(Self::Nod),
            "turn" => Ok(Self::Turn),
            "keyframes" => Ok(Self::Keyframes),
            found => Err(Error::Value {
                key: "motion.name",
                found: format!("`{found}`"),
                expected: "still, shake, nod, turn or keyframes".to_owned(),
            }),
        }
    }
}

/// A pose at a time, as a person writes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct KeyframeSection {
    /// Time \[s\].
    pub time: f64,
    /// Rotation about the pivot: pitch (about x), yaw (about y), roll (about z) \[degrees\].
    pub rotation: Vec3,
    /// Translation \[m\].
    pub translation: Vec3,
}

/// `[motion]`: how the head moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotionSection {
    /// "still", "shake", "nod", "turn" or "keyframes".
    pub name: MotionName,
    /// Point about which the head turns \[m\], head space; without one it is the mannequin's neck,
    /// or a point low in the body's or the groom's box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pivot: Option<Vec3>,
    /// Rotation of the head besides its motion, about the pivot: pitch (about x), yaw (about y), roll (about z)
    /// \[degrees\].
    pub rotation: Vec3,
    /// Poses, in the order of their times; used by "keyframes".
    pub keyframes: Vec<KeyframeSection>,
}

impl MotionSection {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let most = f64::from(self.rotation.abs().max_element());
        // A maximum passes over what is not a number.
        within("motion.rotation", if self.rotation.is_nan() { f64::NAN } else { most }, 0.0..=360.0)
    }

    /// The motion itself; rotations of keyframes happen about `pivot` \[m\].
    ///
    /// # Errors
    /// Keyframes that are missing, not finite or not in the order of their times.
    pub fn motion(&self, pivot: Vec3) -> Result<Motion, Error> {
        Ok(match self.name {
            MotionName::Still => Motion::Still,
            MotionName::Shake => Motion::Shake,
            MotionName::Nod => Motion::Nod,
            MotionName::Turn => Motion::Turn,
            MotionName::Keyframes => {
                Motion::keyframes(self.keyframes.iter().map(|key| key.keyframe(pivot)).collect())?
            }
        })
    }
}

impl KeyframeSection {
    fn keyframe(&self, pivot: Vec3) -> Keyframe {
        let mut world_from_head = Pose::rotation_about(pivot, rotation(self.rotation));
        world_from_head.translation += self.translation;
        Keyframe { time: self.time, world_from_head }
    }
}

/// `[wind]`: how the air moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WindSection {
    /// Mean velocity \[m/s\], world space.
    pub velocity: Vec3,
    /// Share of the velocity that comes and goes, 0 to 1.
    pub gust: f32,
    /// Time from gust to gust \[s\].
    pub gust_period: f32,
}

impl Default for WindSection {
    fn default() -> Self {
        Self { velocity: Vec3::ZERO, gust: 0.5, gust_period: 1.7 }
    }
}

impl WindSection {
    pub(crate) fn check(&self) -> Result<(), Error> {
        within("wind.velocity", f64::from(self.velocity.length()), 0.0..=100.0)?;
        within("wind.gust", f64::from(self.gust), 0.0..=1.0)?;
        within("wind.gust_period", f64::from(self.gust_period), 0.05..=1000.0)
    }

    /// Velocity of the air \[m/s\] at a time \[s\]: two swings whose periods have no common multiple.
    pub fn at(&self, time: f64) -> Vec3 {
        let phase = std::f64::consts::TAU * time / f64::from(self.gust_period);
        let swing = 0.7 * phase.sin() + 0.3 * (2.618 * phase).sin();
        self.velocity * (1.0 + self.gust * swing as f32)
    }
}
