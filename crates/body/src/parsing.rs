//! What the readers of meshes share.

use std::path::Path;

use glam::Vec3;
use strandline_base::read_plain;

use crate::BodyError;

/// Largest file that is read \[bytes\]: the parsers need up to 30 times as much memory.
const FILE_LIMIT: u64 = 256 << 20;
/// Why a file is refused: what was found and what was expected.
pub(crate) type Refusal = (String, &'static str);

/// The bytes of a plain file, unless it is too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, BodyError> {
    read_plain(path, FILE_LIMIT).map_err(|source| BodyError::Read { path: path.into(), source })
}

/// A normal of a file as a unit vector, however short; zero for what is none.
pub(crate) fn unit_normal(normal: Vec3) -> Vec3 {
    // The square of a very short or very long one is no number that could be divided by.
    let largest = normal.abs().max_element();
    if normal.is_finite() && largest > 0.0 { (normal / largest).normalize_or_zero() } else { Vec3::ZERO }
}
