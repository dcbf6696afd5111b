//! Every format once: its ending, description, reader, writer and the attributes that it holds.

use std::path::Path;

use super::attribute::Attribute::{self, *};
use super::chosen::Chosen;
use super::fitted::Fitted;
use super::{Parsed, bin, data, hair, npy, npz, obj, ply, tfx, usda};
use crate::{Groom, GroomError};

/// Parser of bytes.
pub type Read = fn(&[u8], Chosen) -> Result<Parsed, GroomError>;
/// Changes a groom so that it fits the limits of a format.
pub type Fit = fn(&Groom) -> Result<Fitted, GroomError>;

/// Writer of bytes.
pub type Write = fn(&Groom) -> Result<Vec<u8>, GroomError>;

/// Reader of a format.
#[derive(Clone, Copy, Debug)]
pub enum Reader {
    /// Strands from its bytes.
    Bytes(Read),
    /// Its lines name the files that hold the strands.
    Project,
}

/// A format of groom files.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// The ending of its files, without the dot, in lower case.
    pub ending: &'static str,
    /// Its description, human-readable.
    pub about: &'static str,
    /// Its reader.
    pub read: Reader,
    /// Its writer, if there is one.
    pub write: Option<Write>,
    /// Changes that make a groom fit its limits, where it has some.
    pub fit: Option<Fit>,
    /// True where it defines units and axes: its reader brings them to metres and y up.
    pub defines_space: bool,
    /// Attributes that it holds beside points.
    pub holds: &'static [Attribute],
    /// Most memory of reading for each byte of a file \[byte\]: the file and its content. Text is shorter
    /// than its numbers.
    pub taken: u64,
}

/// All formats.
pub const FORMATS: [Format; 10] = [
    Format {
        ending: "hair",
        about: "HAIR of Cem Yuksel",
        read: Reader::Bytes(|bytes, chosen| hair::read(bytes, chosen.per_strand)),
        write: Some(hair::write),
        fit: None,
        defines_space: false,
        holds: &[Widths, WidthsAlong, Colors, Transparencies],
        taken: 2,
    },
    Format {
        ending: "tfx",
        about: "TressFX 2 (text), 3 and 4, written as 4 with 4, 8, 16, 32 or 64 points a strand",
        read: Reader::Bytes(|bytes, _| tfx::read(bytes)),
        write: Some(tfx::write),
        fit: Some(tfx::fitted),
        defines_space: false,
        holds: &[Widths, Colors, RootUvs],
        taken: 2,
    },
    Format {
        ending: "tfxproj",
        about: "a project of TressFX 3: each of its .tfx files becomes a group",
        read: Reader::Project,
        write: None,
        fit: None,
        defines_space: false,
        holds: &[],
        taken: 2,
    },
    Format {
        ending: "data",
        about: "USC-HairSalon: points alone",
        read: Reader::Bytes(|bytes, chosen| data::read(bytes, chosen.per_strand)),
        write: Some(data::write),
        fit: None,
        defines_space: false,
        holds: &[],
        taken: 2,
    },
    Format {
        ending: "bin",
        about: "CT2Hair: points, written in metres (its own files are in millimetres); normals and labels are not read, \
                and written as 0",
        read: Reader::Bytes(|bytes, chosen| bin::read(bytes, chosen.per_strand)),
        write: Some(bin::write),
        fit: None,
        defines_space: false,
        holds: &[],
        taken: 2,
    },
    Format {
        ending: "ply",
        about: "vertices with `strand` and `edge` elements, edges alone, or bare vertices with `--per-strand N`",
        read: Reader::Bytes(|bytes, chosen| ply::read(bytes, chosen.per_strand)),
        write: Some(ply::write),
        fit: None,
        defines_space: false,
        holds: &Attribute::ALL,
        taken: 18,
    },
    Format {
        ending: "npz",
        about: "NumPy arrays by name: `points` and `starts`, or `positions` [strand, point, 3]",
        read: Reader::Bytes(npz::read_frame),
        write: Some(npz::write),
        fit: None,
        defines_space: false,
        holds: &Attribute::ALL,
        taken: 2,
    },
    Format {
        ending: "npy",
        about: "one NumPy array [strand, point, 3]; points alone",
        read: Reader::Bytes(|bytes, chosen| npy::read(bytes, chosen.per_strand)),
        write: Some(npy::write),
        fit: None,
        defines_space: false,
        holds: &[],
        taken: 2,
    },
    Format {
        ending: "obj",
        about: "lines (`l`), with groups by `g` and colours behind vertices",
        read: Reader::Bytes(|bytes, _| obj::read(bytes)),
        write: Some(obj::write),
        fit: None,
        defines_space: false,
        holds: &[Colors, Groups, GroupNames],
        taken: 8,
    },
    Format {
        ending: "usda",
        about: "text USD: `BasisCurves` of a stage at one of its times, in its units and axes",
        read: Reader::Bytes(|bytes, chosen| usda::read_at(bytes, chosen.frame)),
        write: None,
        fit: None,
        defines_space: true,
        holds: &[],
        taken: 16,
    },
];

/// The way in for files of other programs.
fn way_in(ending: &str) -> &'static str {
    match ending {
        "abc" => {
            "the `strandline` of `pip install 'strandline[abc]'` reads and writes it; or import it in Blender and export the curves as USD with the ending .usda"
        }
        "usdc" => {
            "the `strandline` of `pip install 'strandline[usd]'` reads and writes it; or write it as text: `usdcat -o hair.usda FILE`"
        }
        "usdz" => {
            "the `strandline` of `pip install 'strandline[usd]'` reads it; or write it as text: `usdcat -o hair.usda FILE`"
        }
        "fbx" | "blend" | "ma" | "mb" | "hip" | "max" | "c4d" => {
            "open it in its program, or in Blender, make the hair curves, and export them as USD with the ending .usda"
        }
        "glb" | "gltf" | "vrm" | "stl" => "a mesh is a body (`--body`)",
        _ => "export the strands in one of these formats",
    }
}

impl Format {
    /// The format that the ending of a path names.
    ///
    /// # Errors
    /// [`GroomError::Ending`].
    pub fn of(path: &Path) -> Result<&'static Self, GroomError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let found = ending.unwrap_or_default();
        // A `.usd` file is a text or a binary USD: its reader tells them apart.
        let known = if found == "usd" { "usda" } else { &found };
        FORMATS.iter().find(|format| format.ending == known).ok_or_else(|| GroomError::Ending {
            mend: way_in(&found),
            found: found.clone(),
            expected: endings(|_| true),
            path: path.to_owned(),
        })
    }

    /// True if the ending of a path names a format.
    pub fn is_of(path: &Path) -> bool {
        Self::of(path).is_ok()
    }
}

/// The endings of the formats that are chosen, as a person lists them: ".hair, .tfx or .obj".
pub fn endings(choose: impl Fn(&Format) -> bool) -> String {
    let chosen: Vec<String> =
        FORMATS.iter().filter(|format| choose(format)).map(|format| format!(".{}", format.ending)).collect();
    match chosen.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}
