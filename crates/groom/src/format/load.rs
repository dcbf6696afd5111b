use std::path::Path;

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use strandline_base::{Key, Kind, Row, SettingError, Value, WholeFile, choices, read_plain};

use super::report::Report;
use super::{MAX_FILE_BYTES, Parsed, hair, sieve::sieve, tfx};
use crate::{Groom, GroomError, Widths};

/// Diameter of a human hair \[m\], for files that name none.
const HAIR_WIDTH: f32 = 8e-5;

/// Metres for each unit of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ScaleText", into = "ScaleText")]
pub enum Scale {
    /// The first of 1, 0.01, 0.001 and 0.0254 that makes the box around all points as large as a
    /// head of hair can be: its diagonal 0.05 to 2 m.
    #[default]
    Auto,
    /// Given.
    Factor(f32),
}

/// "auto" or a number, as a scene file has it.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum ScaleText {
    Name(String),
    Factor(f32),
}

impl TryFrom<ScaleText> for Scale {
    type Error = String;

    fn try_from(text: ScaleText) -> Result<Self, String> {
        match text {
            ScaleText::Name(name) if name == "auto" => Ok(Self::Auto),
            ScaleText::Factor(factor) => Ok(Self::Factor(factor)),
            ScaleText::Name(found) => {
                Err(format!("scale is `{found}`, expected \"auto\" or a number above 0"))
            }
        }
    }
}

impl Value for Scale {
    type Given = Self;
    const KIND: Kind = Kind::NumberOr("auto");

    fn take(&mut self, given: Self) {
        *self = given;
    }

    fn check(&self, row: &Row, key: &Key) -> Result<(), SettingError> {
        match self {
            Self::Auto => Ok(()),
            Self::Factor(factor) => factor.check(row, key),
        }
    }
}

impl From<Scale> for ScaleText {
    fn from(scale: Scale) -> Self {
        match scale {
            Scale::Auto => Self::Name("auto".to_owned()),
            Scale::Factor(factor) => Self::Factor(factor),
        }
    }
}

choices! {
    /// The axis of a file that points up.
    pub enum Up as "groom.up" {
        /// y, as here; the face looks along +z.
        Y = "y",
        /// z; the face looks along -y.
        Z = "z",
    }
    default Y
}

/// How a file is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadOptions {
    /// Whether a bad strand is an error; else it is left out and counted.
    pub strict: bool,
    /// Metres for each unit of the file.
    pub scale: Scale,
    /// The axis that points up.
    pub up: Up,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { strict: true, scale: Scale::Auto, up: Up::Y }
    }
}

/// A groom and what is to be said of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The strands \[m\], y up.
    pub groom: Groom,
    /// What the file holds.
    pub report: Report,
}

/// What writing left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Saved {
    /// Parts of the groom that the format cannot hold.
    pub left_out: Vec<&'static str>,
}

/// Loads a .hair or .tfx file; the ending names the format.
///
/// # Errors
/// See [`GroomError`]; the path stands last.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, GroomError> {
    let read: fn(&[u8]) -> Result<Parsed, GroomError> = match ending(path).as_str() {
        "hair" => hair::read,
        "tfx" => tfx::read,
        found => return Err(GroomError::Ending { found: found.to_owned(), path: path.to_owned() }),
    };
    let file = |source| GroomError::File { action: "read", path: path.to_owned(), source };
    let bytes = read_plain(path, MAX_FILE_BYTES).map_err(file)?;
    read(&bytes).and_then(|parsed| prepare(parsed, options)).map_err(|error| error.of(path))
}

/// Sieves, scales and turns what a reader found.
///
/// # Errors
/// A bad strand in strict mode; no strand left.
pub fn prepare(parsed: Parsed, options: &LoadOptions) -> Result<Loaded, GroomError> {
    let mut problems = parsed.problems;
    let mut groom = sieve(parsed.groom, options.strict, &mut problems)?;
    if groom.strand_count() == 0 {
        return Err(GroomError::Empty);
    }
    let scale = match options.scale {
        Scale::Factor(factor) => factor,
        Scale::Auto => plausible_scale(&groom),
    };
    if scale != 1.0 && options.scale == Scale::Auto {
        problems.push(format!("one unit of the file is taken as {scale} m"));
    }
    let rotation = match options.up {
        Up::Y => Quat::IDENTITY,
        Up::Z => Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
    };
    groom.transform(scale, rotation, Vec3::ZERO);
    if groom.widths == Widths::Constant(0.0) {
        groom.widths = Widths::Constant(HAIR_WIDTH);
        problems.push(format!("the file has no widths: {} mm is taken", 1e3 * HAIR_WIDTH));
    }
    let report = Report::new(parsed.format, &groom, scale, problems);
    Ok(Loaded { groom, report })
}

fn plausible_scale(groom: &Groom) -> f32 {
    let bounds = groom.bounds();
    let diagonal = bounds.min.distance(bounds.max);
    let fits = |scale: &f32| (0.05..=2.0).contains(&(scale * diagonal));
    [1.0, 0.01, 0.001, 0.0254].into_iter().find(fits).unwrap_or(1.0)
}

/// Writes a .hair or .tfx file; the ending names the format. The file is whole or not there.
///
/// # Errors
/// A format that cannot hold the groom, or a folder that cannot be written.
pub fn save(groom: &Groom, path: &Path) -> Result<Saved, GroomError> {
    let mut left_out = Vec::new();
    let mut note = |absent: bool, what| left_out.extend(absent.then_some(what));
    note(groom.root_normals.is_some(), "root normals");
    note(groom.groups.is_some(), "groups");
    note(groom.masses.is_some(), "masses");
    note(groom.velocities.is_some(), "velocities");
    let bytes = match ending(path).as_str() {
        "hair" => {
            note(groom.root_uvs.is_some(), "root coordinates");
            hair::write(groom)
        }
        "tfx" => {
            note(groom.transparencies.is_some(), "transparency");
            tfx::write(groom)
        }
        found => return Err(GroomError::Ending { found: found.to_owned(), path: path.to_owned() }),
    };
    let bytes = bytes.map_err(|error| error.of(path))?;
    WholeFile::save(path, &bytes).map_err(|source| GroomError::File {
        action: "write",
        path: path.to_owned(),
        source,
    })?;
    Ok(Saved { left_out })
}

fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}
