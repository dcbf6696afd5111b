use glam::Vec3;
use strandline_base::{Key, SettingError, choices, settings};

use crate::{
    body::{Aabb, Interpolation},
    render::Camera,
};

choices! {
    /// From where the camera looks when its position is not given.
    pub enum View as "camera.view" {
        /// The face.
        Front = "front",
        /// Between the face and the left side.
        ThreeQuarter = "three_quarter",
        /// The left side.
        Side = "side",
        /// The back of the head.
        Back = "back",
    }
    default ThreeQuarter
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

settings! {
    /// The camera at a time, about where `[camera]` has it.
    pub struct CameraKeyframe: Copy {
        /// Time; each later than the one before.
        time: f64 = 0.0, in [-1e6, 1e6] "s";
        /// Turn about a vertical through the target, counter-clockwise as seen from above; whole turns count.
        turn: f32 = 0.0, in [-36_000.0, 36_000.0] "degrees", slider [-180.0, 180.0];
        /// Rise about the target, up to 89 degrees above it or below.
        rise: f32 = 0.0, in [-180.0, 180.0] "degrees", more "a view from further above";
        /// Distance from the target over that of `[camera]`.
        distance: f32 = 1.0, in [0.01, 1000.0], slider [0.2, 5.0], more "a view from further away";
        /// Displacement of camera and target, world space.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// The way to the next keyframe; "smooth" without it.
        interpolation: Option<Interpolation> = None;
        /// A jump: the view before is held until this one.
        cut: bool = false;
    }
}

settings! {
    /// A view that was kept.
    pub struct KeptView {
        /// Its name.
        name: String = String::new();
        /// Position, world space.
        position: Vec3 = Vec3::Z, in [-1e4, 1e4] "m";
        /// Target, world space.
        target: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Vertical field of view.
        field_of_view: f32 = 30.0, in [1.0, 170.0] "degrees", more "a wider view";
    }
}

settings! {
    /// View of the pictures.
    pub struct CameraSection {
        /// From where it looks when its position is not given; hair and body fill the picture.
        view: View = View::default();
        /// Position, world space.
        position: Option<Vec3> = None, in [-1e4, 1e4] "m";
        /// Target, world space; without it the middle of hair and body.
        target: Option<Vec3> = None, in [-1e4, 1e4] "m";
        /// Vertical field of view; without it that of the framing.
        field_of_view: Option<f32> = None, in [1.0, 170.0] "degrees", more "a wider view";
        /// Views of a film, in the order of their times; a window follows them until its view is moved.
        keyframes: Vec<CameraKeyframe> = Vec::new(), in [0, 100_000];
        /// Views that a window lists; no picture of `render` looks from them.
        kept: Vec<KeptView> = Vec::new(), in [0, 1000];
    }
    also CameraSection::apart;
}

/// The framing holds the corners of the box around hair and body, and a head has none: the camera comes closer by
/// this share, as far as the hair stays in the picture, with a margin of so much about it.
const CLOSER: f32 = 0.82;
const MARGIN: f32 = 1.02;

impl CameraSection {
    /// The camera, given the box around hair and body \[m\], places \[m\] that lie farthest out in it, and width / height
    /// of the picture.
    pub fn camera(&self, bounds: Aabb, outermost: &[Vec3], aspect: f32) -> Camera {
        let framing = Camera::framing(bounds, self.view.direction(), aspect);
        let target = self.target.unwrap_or(framing.target);
        let mut away = CLOSER * (framing.position - framing.target);
        let least = MARGIN * framing.distance_to_see(outermost, aspect);
        if away.length() < least {
            away *= least / away.length();
        }
        let position = self.position.unwrap_or(target + away);
        let field_of_view = self.field_of_view.unwrap_or(framing.field_of_view);
        Camera { position, target, field_of_view, ..framing }
    }
}

impl CameraSection {
    fn apart(&self, key: &Key) -> Result<(), SettingError> {
        match (self.position, self.target) {
            (Some(position), Some(target)) if position.distance(target) < 1e-6 => {
                Err(SettingError::new(key.of("target"), target, "a point away from camera.position"))
            }
            _ => Ok(()),
        }
    }
}

settings! {
    /// Number and rate of the pictures.
    pub struct FilmSection: Copy {
        /// Number of pictures.
        frames: u32 = 120, in [1, 1_000_000], more "a longer film";
        /// Pictures per second of the scene's time.
        frames_per_second: f32 = 30.0, in [1.0, 1000.0] "1/s", more "smoother motion, more pictures";
        /// Time that passes with the head at rest before the first picture; none does before hair that
        /// begins in a pose. Rods begin at rest and need none; with `method = "constrain"`, where hair sags at
        /// first, the default is 1, and with wet hair 2.
        settle: f32 = 0.0, in [0.0, 3600.0] "s", more "hair that has come further to rest";
        /// Time of motion and wind at the beginning.
        start: f64 = 0.0, in [0.0, 1e6] "s";
    }
}

impl FilmSection {
    /// Time \[s\] in which strands come to hang that do not begin at rest.
    pub const SETTLE: f32 = 1.0;
    /// Time \[s\] in which a dry groom droops when it is wetted.
    pub const DROOP: f32 = 2.0;
}
