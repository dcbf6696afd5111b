//! Strands without a header: nothing but coordinates, one point after the other.

use super::bytes::{Source, vec3};
use super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed};
use crate::Groom;

/// Reads 32-bit coordinates of strands of `each` points where the size of the file agrees and every number could be
/// one; `None` where it does not.
pub fn read(bytes: &[u8], format: &'static str, each: Option<u32>) -> Option<Parsed> {
    let each = u64::from(each?);
    let (points, rest) = (bytes.len() as u64 / 12, bytes.len() % 12);
    let agrees = rest == 0
        && (2..=MAX_POINTS_PER_STRAND).contains(&each)
        && (1..=MAX_POINTS).contains(&points)
        && points.is_multiple_of(each)
        && points / each <= MAX_STRANDS;
    if !agrees {
        return None;
    }
    let source = Source { bytes, format };
    let places = source.groups::<3, 3>("points", 0, points).ok()?;
    // Counts of a header and bytes of text are numbers next to 0 or far beyond any hair.
    let is_place = |number: &f32| number.is_finite() && number.abs() < super::MAX_COORDINATE;
    if !places.as_flattened().iter().all(is_place) {
        return None;
    }
    let groom = Groom {
        starts: (0..=points / each).map(|strand| (strand * each) as u32).collect(),
        points: places.into_iter().map(vec3).collect(),
        ..Groom::empty(0.0)
    };
    let problems = vec![format!("no header: {each} points a strand are taken, as asked")];
    Some(Parsed { format, groom, problems })
}
