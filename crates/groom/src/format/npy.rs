//! `.npy`, one NumPy array \[NEP 1\]: a short header of text, then numbers.

use std::borrow::Cow;

use super::bytes::Source;
use super::rows;
use super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError};
use glam::Vec3;
use strandline_base::npz::{self, Bare, Kind, NpzError};

/// An array of numbers, checked against its bytes.
pub(super) struct Array<'a> {
    pub shape: Vec<u64>,
    pub kind: Kind,
    pub bytes: Cow<'a, [u8]>,
}

impl Array<'_> {
    /// `count` numbers from the one with the index `first` on.
    pub fn floats_from(&self, first: usize, count: usize) -> Vec<f32> {
        let bytes = self.bytes.get(first * self.kind.bytes() as usize..).unwrap_or_default();
        self.kind.numbers(bytes).take(count).map(|number| number as f32).collect()
    }

    /// All numbers, which are whole ones from 0 on.
    pub fn whole(&self, source: &Source, name: &str) -> Result<Vec<u32>, GroomError> {
        let whole = |number: f64| {
            let fits = number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0;
            let refused = || source.error(format!("{number} in `{name}`"), "whole numbers from 0 on");
            if fits { Ok(number as u32) } else { Err(refused()) }
        };
        self.kind.numbers(&self.bytes).map(whole).collect()
    }

    /// The bytes of an array of single bytes.
    pub fn raw(&self) -> Option<&[u8]> {
        (self.kind.bytes() == 1).then_some(&self.bytes)
    }
}

/// An error of the reader of arrays as one of a groom file.
pub(super) fn refused(source: &Source, error: NpzError) -> GroomError {
    match error {
        NpzError::Malformed { found, expected } => source.error(found, expected),
        other => source.error(other.to_string(), "all bytes of its arrays"),
    }
}

/// Reads a `.npy` file: an array \[strand, point, 3\], or \[point, 3\] with the points of each strand.
///
/// # Errors
/// [`GroomError::Malformed`] with the error.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".npy" };
    let Bare { kind, shape, bytes } = Bare::new(bytes).map_err(|error| refused(&source, error))?;
    let array = Array { shape, kind, bytes };
    let groom = strands(&source, &array, per_strand)?;
    Ok(Parsed { format: ".npy", groom, problems: Vec::new() })
}

/// Strands of one number of points.
pub(super) fn strands(source: &Source, array: &Array, per_strand: Option<u32>) -> Result<Groom, GroomError> {
    let (count, each) = match (&array.shape[..], per_strand) {
        ([strands, points, 3], _) => (*strands, *points),
        ([points, 3], Some(each)) => split(source, *points, each)?,
        ([count, 3], None) => {
            let places = points(array, 0, (*count).min(MAX_POINTS));
            let expected = format!("an array [strand, point, 3], or {}", rows::asked(&places));
            return Err(source.error(format!("an array {:?}", array.shape), expected));
        }
        _ => return Err(source.error(format!("an array {:?}", array.shape), "[strand, point, 3]")),
    };
    even(source, count, each, |count| points(array, 0, count))
}

/// Number of strands that `points` points make, and `each`, the points of one.
pub(super) fn split(source: &Source, points: u64, each: u32) -> Result<(u64, u64), GroomError> {
    let each = u64::from(each);
    if each == 0 || !points.is_multiple_of(each) {
        let expected = format!(
            "a multiple of {each}, the points of a strand (`--per-strand N`, in Python `points_per_strand=N`)"
        );
        return Err(source.error(format!("{points} points"), expected));
    }
    Ok((points / each, each))
}

/// `count` strands of `each` points; `points` returns as many positions as it is asked for.
pub(super) fn even(
    source: &Source,
    count: u64,
    each: u64,
    points: impl FnOnce(u64) -> Vec<Vec3>,
) -> Result<Groom, GroomError> {
    let in_range = (1..=MAX_STRANDS).contains(&count) && (1..=MAX_POINTS_PER_STRAND).contains(&each);
    if !in_range || count * each > MAX_POINTS {
        let expected = format!("1 to {MAX_STRANDS} strands of 1 to {MAX_POINTS_PER_STRAND} points");
        return Err(source.error(format!("{count} strands of {each} points"), expected));
    }
    let starts = (0..=count).map(|strand| (strand * each) as u32).collect();
    Ok(Groom { starts, points: points(count * each), ..Groom::empty(0.0) })
}

/// `count` positions of an array from the one with the index `first` on.
pub(super) fn points(array: &Array, first: u64, count: u64) -> Vec<Vec3> {
    array.floats_from(3 * first as usize, 3 * count as usize).chunks_exact(3).map(Vec3::from_slice).collect()
}

/// Writes a `.npy` file: an array \[strand, point, 3\].
///
/// # Errors
/// Strands of different point counts.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let each = super::tfx::each(groom, ".npy")?;
    let shape = [groom.strand_count(), each as usize, 3];
    let numbers = groom.points.iter().flat_map(|point| point.to_array());
    Ok(npz::Array::f32s("points", &shape, numbers).npy())
}
