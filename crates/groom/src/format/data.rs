//! `.data`, strands as the USC-HairSalon database has them: a count, then for each strand a count and its points.

use strandline_base::counted;

use super::bytes::{Source, put, put_u32, vec3};
use super::{MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed, headerless};
use crate::{Groom, GroomError};

/// Reads a `.data` file, or bare points with `per_strand` where the size of the file agrees. A strand of a single point stands for a root without hair and is left out.
///
/// # Errors
/// [`GroomError::Malformed`] with the byte or the size that is wrong.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".data" };
    let (groom, bare) = match strands::<3>(&source) {
        Ok(strands) => strands,
        Err(error) => return headerless::read(bytes, ".data", per_strand).ok_or(error),
    };
    let problems = match bare {
        0 => Vec::new(),
        count => vec![counted(count, "root has no hair", "roots have no hair")],
    };
    Ok(Parsed { format: ".data", groom, problems })
}

/// Strands of points of `N` numbers, the first three of which are coordinates; how many have one point only.
pub(super) fn strands<const N: usize>(source: &Source) -> Result<(Groom, usize), GroomError> {
    let count = u64::from(source.u32("strand count", 0)?);
    if !(1..=MAX_STRANDS).contains(&count) {
        return Err(source.error(format!("{count} strands at byte 0"), format!("1 to {MAX_STRANDS}")));
    }
    // Each strand has its own count at least: no memory is taken that the file cannot fill.
    source.slice("counts of points", 4, count, 4)?;
    let mut groom = Groom::empty(0.0);
    groom.starts.reserve(count as usize);
    let (mut offset, mut bare) = (4, 0);
    for _ in 0..count {
        let points = u64::from(source.u32("points of a strand", offset)?);
        if points > MAX_POINTS_PER_STRAND {
            let found = format!("{points} points of a strand at byte {offset}");
            return Err(source.error(found, format!("0 to {MAX_POINTS_PER_STRAND}")));
        }
        let places = source.groups::<N, 3>("points", offset + 4, points)?;
        if points < 2 {
            bare += 1;
        } else {
            groom.push(places.into_iter().map(vec3));
        }
        offset += 4 + 4 * N as u64 * points;
    }
    let length = source.bytes.len() as u64;
    if offset != length {
        return Err(source.error(format!("{length} bytes"), format!("{offset} bytes for {count} strands")));
    }
    Ok((groom, bare))
}

/// Writes a `.data` file.
///
/// # Errors
/// `None` for a groom in memory.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let mut out = Vec::with_capacity(4 + 4 * groom.strand_count() + 12 * groom.points.len());
    put_u32(&mut out, [groom.strand_count() as u32]);
    for strand in 0..groom.strand_count() {
        let points = groom.strand(strand);
        put_u32(&mut out, [points.len() as u32]);
        put(&mut out, points.iter().flat_map(|point| point.to_array()));
    }
    Ok(out)
}
