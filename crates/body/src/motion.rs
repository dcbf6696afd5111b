use serde::{Deserialize, Serialize};

use crate::Pose;

/// A pose at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Keyframe {
    /// Time \[s\].
    pub time: f64,
    /// The head's pose then.
    pub world_from_head: Pose,
}

/// How the head moves: a pose for every time, smooth in velocity, at rest at time 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Motion {
    /// The head rests.
    #[default]
    Still,
    /// "No": the thesis's head shake, about the vertical axis.
    Shake,
    /// "Yes": about the axis through the ears.
    Nod,
    /// A slow look to the left and to the right.
    Turn,
    /// Poses from a scene, joined by a curve that is smooth in velocity.
    Keyframes(Vec<Keyframe>),
}

impl Motion {
    /// The head's pose (`world_from_head`) at a time \[s\].
    pub fn pose(&self, _time: f64) -> Pose {
        unimplemented!("body mechanics")
    }
}
