use crate::{
    Ray,
    render::{BodyLook, Camera, LevelOfDetail, Light, Look, PictureSettings},
    scene::{CameraKeyframe, MotionSection, WindSection},
    sim::Settings,
};

/// A change of hair that plays. The next picture that is begun shows changes of the picture, the one after it changes of
/// the motion.
#[derive(Clone)]
pub enum Change {
    /// Back to rest, and to the beginning of the motion.
    Reset,
    /// Another view.
    Camera(Camera),
    /// Other keyframes of the camera, about where the scene has it; the view follows them.
    CameraKeys(Vec<CameraKeyframe>),
    /// Another look of the hair.
    Look(Box<Look>),
    /// Another look of the body.
    BodyLook(BodyLook),
    /// Other lights.
    Lights(Vec<Light>),
    /// Another level of detail.
    LevelOfDetail(LevelOfDetail),
    /// Another size or finish of the pictures.
    Picture(PictureSettings),
    /// Other settings of the simulation.
    Settings(Box<Settings>),
    /// Another length of all strands, 0.05 to 2 of their own.
    Length(f32),
    /// Another wind.
    Wind(WindSection),
    /// A motion of the head of another name, from its beginning; or other keyframes of it, or a further turn added to it,
    /// at its present time. The pivot stays, and solids go from key to key as before. A head follows a motion of a file as it
    /// was loaded: another file, joint, clip, scale or mark is refused.
    Motion(Box<MotionSection>),
    /// Takes the first hair on a line of sight, and all hair within a distance \[m\] of it, into a hand.
    Grab(Ray, f32),
    /// Moves the hand to a line of sight at its present distance from the camera.
    Drag(Ray),
    /// Lets go of the hair.
    Release,
}

impl Change {
    /// True for a change of what is drawn, or of the air, that no state of the hair decides.
    pub(crate) fn is_of_picture(&self) -> bool {
        match self {
            Self::Camera(_)
            | Self::CameraKeys(_)
            | Self::Look(_)
            | Self::BodyLook(_)
            | Self::Lights(_)
            | Self::LevelOfDetail(_)
            | Self::Picture(_)
            | Self::Wind(_) => true,
            Self::Reset
            | Self::Settings(_)
            | Self::Length(_)
            | Self::Motion(_)
            | Self::Grab(..)
            | Self::Drag(_)
            | Self::Release => false,
        }
    }
}
