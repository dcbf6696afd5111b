//! `.bin`, strands as CT2Hair writes them: as `.data`, but each point has a normal and a label behind it.

use strandline_base::counted;

use super::bytes::{Source, put, put_u32};
use super::{Parsed, data, headerless};
use crate::{Groom, GroomError};

/// Reads a `.bin` file, or bare points with `per_strand` where the size of the file agrees. Published files have points that are not finite; such strands are bad ones.
///
/// # Errors
/// [`GroomError::Malformed`] with the byte or the size that is wrong.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".bin" };
    let (groom, bare) = match data::strands::<7>(&source) {
        Ok(strands) => strands,
        Err(error) => return headerless::read(bytes, ".bin", per_strand).ok_or(error),
    };
    let mut problems = vec!["normals and labels of points are not read".to_owned()];
    if bare > 0 {
        problems.push(counted(bare, "root has no hair", "roots have no hair"));
    }
    Ok(Parsed { format: ".bin", groom, problems })
}

/// Writes a `.bin` file; normals and labels are 0.
///
/// # Errors
/// `None` for a groom in memory.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let mut out = Vec::with_capacity(4 + 4 * groom.strand_count() + 28 * groom.points.len());
    put_u32(&mut out, [groom.strand_count() as u32]);
    for strand in 0..groom.strand_count() {
        let points = groom.strand(strand);
        put_u32(&mut out, [points.len() as u32]);
        put(&mut out, points.iter().flat_map(|point| [point.x, point.y, point.z, 0.0, 0.0, 0.0, 0.0]));
    }
    Ok(out)
}
