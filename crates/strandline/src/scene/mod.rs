//! A scene: everything that one run needs, as one TOML file. docs/scene.md lists every key.

mod body;
mod builtin;
mod film;
mod groom;
mod motion;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub use body::{BodySection, ColliderSection, Model};
pub use film::{CameraSection, FilmSection, View};
pub use groom::GroomSection;
pub use motion::{KeyframeSection, MotionName, MotionSection, WindSection};

use crate::{
    Devices, Error,
    groom::StyleSettings,
    render::{BodyLook, LevelOfDetail, Light, Look, PictureSettings},
    sim::Settings,
};

/// One run: groom, body, motion, colliders, simulation, look, camera, lights, picture and film.
///
/// Every key has a default; unknown keys are refused by name. Paths are relative to the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Scene {
    /// Strands from a file, and how guides are made.
    pub groom: GroomSection,
    /// The style grown when no groom file is named.
    pub style: StyleSettings,
    /// What hair grows on and hits.
    pub body: BodySection,
    /// How the head moves.
    pub motion: MotionSection,
    /// How the air moves.
    pub wind: WindSection,
    /// Solids beside the body.
    pub colliders: Vec<ColliderSection>,
    /// How hair moves.
    pub simulation: Settings,
    /// Colour and shape of the drawn hair.
    pub look: Look,
    /// Colour of the drawn body.
    pub body_look: BodyLook,
    /// How detail falls with distance.
    pub level_of_detail: LevelOfDetail,
    /// Where the picture is taken from.
    pub camera: CameraSection,
    /// The lights; none named means three: key and rim with shadows, and a fill.
    pub lights: Vec<Light>,
    /// Size and finish of a picture.
    pub picture: PictureSettings,
    /// How many pictures, how fast.
    pub film: FilmSection,
    /// The folder that relative paths start from; not part of the file.
    #[serde(skip)]
    pub folder: PathBuf,
}

impl Scene {
    /// Where it says that it is simulated and drawn.
    pub fn devices(&self) -> Devices {
        Devices { simulation: self.simulation.backend, pictures: self.picture.backend }
    }

    /// Loads a TOML file.
    ///
    /// # Errors
    /// A file that cannot be read, is not TOML, or has an unknown key or a value of the wrong kind.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| Error::ReadScene { path: path.to_owned(), source })?;
        let mut scene = Self::parse(&text, &path.display().to_string())?;
        scene.folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(scene)
    }

    /// Reads TOML text; `origin` names it in errors.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn parse(text: &str, origin: &str) -> Result<Self, Error> {
        let scene: Self = toml::from_str(text).map_err(|error| Error::ParseScene {
            origin: origin.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        scene.check()?;
        Ok(scene)
    }

    /// The scene as TOML, every key spelled out.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("every section is plain data")
    }

    /// Checks the values that no other part checks.
    ///
    /// # Errors
    /// [`Error::Value`] names the key, what was found and what was expected.
    pub fn check(&self) -> Result<(), Error> {
        self.groom.check()?;
        self.body.check()?;
        self.film.check()?;
        self.motion.check()?;
        self.wind.check()
    }

    /// Lets hair and motion begin at their beginning, not where a saved scene has them: for other hair.
    pub fn begin_at_rest(&mut self) {
        (self.groom.pose, self.film.start) = (None, 0.0);
    }

    /// A path of the scene, from the scene's folder.
    pub(crate) fn path(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}

/// Refuses a number outside `range`.
pub(crate) fn within(
    key: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
) -> Result<(), Error> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(Error::Value {
        key,
        found: value.to_string(),
        expected: format!("{} to {}", range.start(), range.end()),
    })
}

/// Whether a path has the ending of a scene file.
pub fn is_file(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}
