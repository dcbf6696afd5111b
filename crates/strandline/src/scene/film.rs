use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::within;
use crate::{Error, body::Aabb, render::Camera};

/// From where the camera looks when its position is not given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum View {
    /// The face.
    Front,
    /// Between the face and the left side.
    #[default]
    ThreeQuarter,
    /// The left side.
    Side,
    /// The back of the head.
    Back,
}

impl View {
    /// Direction from the head to the camera, not of unit length.
    pub fn direction(self) -> Vec3 {
        match self {
            Self::Front => Vec3::new(0.0, 0.08, 1.0),
            Self::ThreeQuarter => Vec3::new(0.62, 0.12, 0.78),
            Self::Side => Vec3::new(1.0, 0.08, 0.0),
            Self::Back => Vec3::new(0.0, 0.12, -1.0),
        }
    }
}

/// `[camera]`: where the picture is taken from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CameraSection {
    /// Used without `position`: "front", "three_quarter", "side" or "back", framing hair and body.
    pub view: View,
    /// Where it stands \[m\], world space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<Vec3>,
    /// What it looks at \[m\], world space; without it the middle of hair and body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Vec3>,
    /// Vertical field of view \[degrees\] of a camera with `position`; without it that of the framing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field_of_view: Option<f32>,
}

/// The framing holds the corners of the box around hair and body, and a head has none: the camera
/// comes closer by this share.
const CLOSER: f32 = 0.82;

impl CameraSection {
    /// The camera, given the box around hair and body \[m\] and width / height of the picture.
    pub fn camera(&self, bounds: Aabb, aspect: f32) -> Camera {
        let framing = Camera::framing(bounds, self.view.direction(), aspect);
        let target = self.target.unwrap_or(framing.target);
        let position = self.position.unwrap_or(target + CLOSER * (framing.position - framing.target));
        let field_of_view = self.field_of_view.unwrap_or(framing.field_of_view);
        Camera { position, target, field_of_view, ..framing }
    }
}

/// `[film]`: how many pictures, how fast.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FilmSection {
    /// Number of pictures.
    pub frames: u32,
    /// Pictures per second of the scene's time.
    pub frames_per_second: f32,
    /// Time that passes with the head at rest before the first picture \[s\]; none does before hair that
    /// begins in a pose.
    pub settle: f32,
    /// Time of motion and wind at the beginning \[s\].
    pub start: f64,
}

impl Default for FilmSection {
    fn default() -> Self {
        Self { frames: 120, frames_per_second: 30.0, settle: 1.0, start: 0.0 }
    }
}

impl FilmSection {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("film.frames", f64::from(self.frames), 1.0..=1e6)?;
        within("film.frames_per_second", f64::from(self.frames_per_second), 1.0..=1000.0)?;
        within("film.settle", f64::from(self.settle), 0.0..=3600.0)?;
        within("film.start", self.start, 0.0..=1e6)
    }
}
