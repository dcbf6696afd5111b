use std::collections::BTreeMap;
use std::f32::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use strandline_base::{Key, Kind, Row, SettingError, Value, choices, math, memory, read_plain};

use super::cleaning::Cleaning;
use super::ends::RootEnd;
use super::report::Report;
use super::{
    Attribute, Chosen, FORMATS, Format, HAIR_WIDTH, MAX_FILE_BYTES, MAX_POINTS, MAX_STRANDS, Parsed, Reader,
    project, sieve::sieve, sound::mend_looks, unit::unit_alone,
};
use crate::{Groom, GroomError, Widths};

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
    pub enum Up as "up" {
        /// The axis that groom and body show, y without a body.
        Auto = "auto",
        /// y, as here; the face looks along +z.
        Y = "y",
        /// z; the face looks along -y.
        Z = "z",
        /// x; the face looks along +z.
        X = "x",
        /// -y, as cameras have it; the face looks along -z.
        MinusY = "-y",
        /// -z; the face looks along +y.
        MinusZ = "-z",
        /// -x; the face looks along +z.
        MinusX = "-x",
    }
    default Auto
}

impl Up {
    /// Rotation that brings the axis to y and the face to +z.
    pub fn rotation(self) -> Quat {
        match self {
            Self::Auto | Self::Y => Quat::IDENTITY,
            Self::Z => math::rotation(Vec3::X, -FRAC_PI_2),
            Self::MinusZ => math::rotation(Vec3::X, FRAC_PI_2),
            Self::MinusY => math::rotation(Vec3::X, PI),
            Self::X => math::rotation(Vec3::Z, FRAC_PI_2),
            Self::MinusX => math::rotation(Vec3::Z, -FRAC_PI_2),
        }
    }
}

/// Advice where strands unlike the others are named and kept.
const HINT: &str = "`convert --clean` mends it";

/// Options of reading a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadOptions {
    /// True if a bad strand is an error; otherwise it is left out and counted.
    pub strict: bool,
    /// Metres for each unit of the file.
    pub scale: Scale,
    /// The axis that points up.
    pub up: Up,
    /// A turn after that \[degrees\]: pitch (about x), yaw (about y), roll (about z).
    pub turn: Vec3,
    /// Points of each strand, for files that hold points and do not say which of them make a strand.
    pub per_strand: Option<u32>,
    /// Frame of moving hair, from 0, in USD a time code; the first without one.
    pub frame: Option<u32>,
    /// The end of each strand at which its root is; [`RootEnd::Auto`] turns strands where `cleaning` mends all.
    pub root_end: RootEnd,
    /// The treatment of strands unlike the others.
    pub cleaning: Cleaning,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            strict: true,
            scale: Scale::Auto,
            up: Up::Y,
            turn: Vec3::ZERO,
            per_strand: None,
            frame: None,
            root_end: RootEnd::Auto,
            cleaning: Cleaning::Named,
        }
    }
}

/// A groom and its report.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The strands \[m\], y up.
    pub groom: Groom,
    /// Contents of the file.
    pub report: Report,
}

impl Groom {
    /// Loads a file of any of the [`FORMATS`](super::FORMATS) strictly, in metres, y up; see [`load`] for more.
    ///
    /// # Errors
    /// See [`GroomError`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, GroomError> {
        Ok(load(path.as_ref(), &LoadOptions::default())?.groom)
    }
}

/// Loads a file of any of the formats; its ending names it.
///
/// # Errors
/// See [`GroomError`]; the path stands last.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, GroomError> {
    let parsed = parse(path, options)?;
    prepare(parsed, options).map_err(|error| error.of(path))
}

/// Loads several files as one groom: each is a group of the name of its file, or has groups of its own, which are
/// numbered again and keep their names. Their units are the same.
///
/// # Errors
/// As [`load`]; no file.
pub fn load_all(paths: &[PathBuf], options: &LoadOptions) -> Result<Loaded, GroomError> {
    match paths {
        [] => Err(GroomError::Empty),
        [path] => load(path, options),
        [first, ..] => {
            let name = |path: &PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            let parts = paths.iter().map(|path| (path.clone(), name(path).unwrap_or_default()));
            prepare(joined(parts, options)?, options).map_err(|error| error.of(first))
        }
    }
}

/// The strands of a file as they stand there.
fn parse(path: &Path, options: &LoadOptions) -> Result<Parsed, GroomError> {
    let format = Format::of(path)?;
    let file = |source| GroomError::File { action: "read", path: path.to_owned(), source };
    memory::check_file("the groom", path, MAX_FILE_BYTES, format.taken)?;
    let bytes = read_plain(path, MAX_FILE_BYTES).map_err(file)?;
    match format.read {
        Reader::Bytes(read) => {
            let chosen = Chosen { per_strand: options.per_strand, frame: options.frame };
            read(&bytes, chosen).map_err(|error| error.of(path))
        }
        Reader::Project => {
            let project = project::read(&bytes).map_err(|error| error.of(path))?;
            let folder = path.parent().unwrap_or(Path::new(""));
            let parts = project.parts.into_iter().map(|[file, name]| (folder.join(file), name));
            let mut parsed = joined(parts, options)?;
            parsed.format = ".tfxproj";
            if let (Some(color), None) = (project.color, &parsed.groom.colors) {
                parsed.groom.colors = Some(vec![color; parsed.groom.points.len()]);
            }
            Ok(parsed)
        }
    }
}

/// The strands of several files, each a group of a name unless it has groups of its own.
fn joined(
    parts: impl Iterator<Item = (PathBuf, String)>,
    options: &LoadOptions,
) -> Result<Parsed, GroomError> {
    let (mut whole, mut files): (Option<Parsed>, _) = (None, BTreeMap::new());
    let mut taken = 0;
    for (path, name) in parts {
        let mut part = parse(&path, options)?;
        taken = regroup(&mut part.groom, &name, taken);
        part.problems.iter_mut().for_each(|problem| *problem = format!("{name}: {problem}"));
        let Some(whole) = &mut whole else {
            add_files(&mut files, 0, &part.groom, path);
            whole = Some(part);
            continue;
        };
        let strands = (whole.groom.strand_count() + part.groom.strand_count()) as u64;
        let points = (whole.groom.points.len() + part.groom.points.len()) as u64;
        if strands > MAX_STRANDS || points > MAX_POINTS {
            let found = format!("{strands} strands of {points} points in all");
            let expected = format!("{MAX_STRANDS} strands of {MAX_POINTS} points at most");
            return Err(GroomError::from(SettingError::new("the groom", found, expected)).of(&path));
        }
        for lost in Attribute::ALL
            .into_iter()
            .filter(|lost| *lost != Attribute::Widths && lost.is_in(&whole.groom) != lost.is_in(&part.groom))
        {
            if !matches!(lost, Attribute::WidthsAlong | Attribute::GroupNames) {
                let has = if lost.is_in(&part.groom) {
                    "not all files before it have"
                } else {
                    "not this file but one before it has"
                };
                whole.problems.push(format!("{name}: {has} {}: left out", lost.name()));
            }
        }
        add_files(&mut files, whole.groom.strand_count(), &part.groom, path);
        whole.groom.append(part.groom);
        whole.problems.append(&mut part.problems);
    }
    let mut whole = whole.ok_or(GroomError::Empty)?;
    (whole.groom.numbers, whole.groom.files) = (None, files);
    Ok(whole)
}

/// Adds the files of a part whose strands stand behind `strands` others: its own where it was read from several.
fn add_files(files: &mut BTreeMap<u32, PathBuf>, strands: usize, part: &Groom, path: PathBuf) {
    let strands = strands as u32;
    if part.files.is_empty() {
        files.insert(strands, path);
    }
    files.extend(part.files.iter().map(|(first, file)| (strands + first, file.clone())));
}

/// Gives the groups of a file numbers from `first` on, those of several files each their own; strands without a group
/// become one. A group without a name has that of its file. Returns the number behind the last.
fn regroup(groom: &mut Groom, name: &str, first: u32) -> u32 {
    let groups = groom.groups.get_or_insert_with(|| vec![0; groom.starts.len() - 1]);
    let mut own = groups.clone();
    own.sort_unstable();
    own.dedup();
    let place = |group: u32| first + own.partition_point(|known| *known < group) as u32;
    groups.iter_mut().for_each(|group| *group = place(*group));
    let named = |group: &u32| match groom.group_names.get(group) {
        Some(known) => known.clone(),
        None if own.len() == 1 => name.to_owned(),
        None => format!("{name} {group}"),
    };
    groom.group_names = own.iter().map(|group| (place(*group), named(group))).collect();
    first + own.len() as u32
}

/// A groom from memory, prepared as one from a file: bad strands are left out or refused, the rest is scaled and turned.
///
/// # Errors
/// A bad strand in strict mode; no strand left.
pub fn sieved(groom: Groom, options: &LoadOptions) -> Result<Loaded, GroomError> {
    prepare(Parsed { format: "memory", groom, problems: Vec::new() }, options)
}

/// Sieves, scales and turns the strands of a reader.
///
/// # Errors
/// A bad strand in strict mode; no strand left.
pub fn prepare(parsed: Parsed, options: &LoadOptions) -> Result<Loaded, GroomError> {
    let mut problems = parsed.problems;
    let mut groom = parsed.groom;
    if !options.strict {
        problems.extend(mend_looks(&mut groom));
    }
    let mut groom = sieve(groom, options.strict, &mut problems)?;
    if groom.strand_count() == 0 {
        return Err(GroomError::Empty);
    }
    match options.cleaning {
        Cleaning::Named => problems.extend(groom.strays(HINT)),
        Cleaning::Strays | Cleaning::All => problems.extend(groom.leave_out_strays()),
    }
    problems.extend(groom.rooted(options.root_end, options.cleaning, HINT));
    let scale = match options.scale {
        Scale::Factor(factor) => factor,
        Scale::Auto if defines_space(parsed.format) => 1.0,
        Scale::Auto => unit_alone(&[&groom]),
    };
    if scale != 1.0 && options.scale == Scale::Auto {
        problems.push(format!("one unit of the file is taken as {scale} m"));
    }
    groom.transform(scale, math::pitch_yaw_roll(options.turn) * options.up.rotation(), Vec3::ZERO);
    if groom.widths == Widths::Constant(0.0) {
        groom.widths = Widths::Constant(HAIR_WIDTH);
        problems.push(format!("the file has no widths: {} mm is taken", 1e3 * HAIR_WIDTH));
    }
    match options.cleaning {
        Cleaning::Named => problems.extend(groom.unlike(HINT)),
        Cleaning::Strays => {}
        Cleaning::All => problems.extend(groom.mend()),
    }
    let report = Report::new(parsed.format, &groom, scale, problems);
    Ok(Loaded { groom, report })
}

/// True for the name of a format that defines units and axes.
fn defines_space(name: &str) -> bool {
    let ending = name.strip_prefix('.').unwrap_or(name);
    FORMATS.iter().any(|format| format.defines_space && format.ending == ending)
}
