//! Tools that the readers of meshes share.

use std::path::Path;

use glam::Vec3;
use strandline_base::{math, memory, read_plain};

use crate::BodyError;

/// Largest file that is read \[bytes\].
const FILE_LIMIT: u64 = 256 << 20;
/// Memory that the parsers need at most for each byte of a file \[byte\].
const TAKEN: u64 = 30;
/// Refusal of a file: the content found and expected.
pub(crate) type Refusal = (String, &'static str);

/// The expectation where a file has parts with names, and none of a name: the file is not to be mended.
pub(crate) const A_NAME: &str = "a name that is in the file";

/// The expectation where a clip of a file without clips is asked for.
pub(crate) const CLIPS: &str = "a file with clips";

/// The way to mend what was refused, given that of another file.
pub(crate) fn remedy(expected: &str, of_file: &'static str) -> &'static str {
    match expected {
        A_NAME => "give one of these names",
        CLIPS => "export the body again as glTF with its animation, or leave the clip out",
        _ => of_file,
    }
}

/// The bytes of a plain file, unless it is too large or would take more memory than may be taken.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, BodyError> {
    memory::check_file("the body", path, FILE_LIMIT, TAKEN)?;
    read_plain(path, FILE_LIMIT).map_err(|source| BodyError::Read { path: path.into(), source })
}

/// A normal of a file as a unit vector, however short; zero for an invalid one.
pub(crate) fn unit_normal(normal: Vec3) -> Vec3 {
    // The square of a very short or very long normal underflows or overflows.
    let largest = normal.abs().max_element();
    if normal.is_finite() && largest > 0.0 { (normal / largest).normalize_or_zero() } else { Vec3::ZERO }
}

/// Linear light of a colour of a file, sRGB from 0 to 1 \[IEC 61966-2-1\]; what is no number is white.
pub(crate) fn linear_light(color: Vec3) -> Vec3 {
    let channel = |part: f32| match part.clamp(0.0, 1.0) {
        part if part.is_nan() => 1.0,
        part if part <= 0.040_45 => part / 12.92,
        part => math::powf((part + 0.055) / 1.055, 2.4),
    };
    Vec3::from(color.to_array().map(channel))
}
