//! `.npy`, one NumPy array \[NEP 1\]: a short header of text, then numbers.

use super::bytes::Source;
use super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError};
use glam::Vec3;

const MAGIC: &[u8] = b"\x93NUMPY";
/// Longest header \[byte\]: NumPy itself warns above 10,000.
const MAX_HEADER: u64 = 65_536;
/// Most axes of an array.
const MAX_AXES: usize = 4;

/// Numbers as an array holds them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Float(usize),
    Unsigned(usize),
    Signed(usize),
}

impl Kind {
    fn size(self) -> usize {
        match self {
            Self::Float(size) | Self::Unsigned(size) | Self::Signed(size) => size,
        }
    }
}

/// An array of numbers, checked against its bytes.
pub(super) struct Array<'a> {
    pub shape: Vec<u64>,
    kind: Kind,
    bytes: &'a [u8],
}

impl<'a> Array<'a> {
    /// Reads a header and checks that the numbers it names are there, all and no more.
    pub fn new(source: &Source<'a>) -> Result<Self, GroomError> {
        let bytes = source.bytes;
        if !bytes.starts_with(MAGIC) {
            let found = format!("starts with `{}`", bytes[..bytes.len().min(6)].escape_ascii());
            return Err(source.error(found, "`\\x93NUMPY`"));
        }
        let version = source.slice("version", 6, 2, 1)?[0];
        let (begin, length) = match version {
            1 => (10, u64::from(source.u32("header length", 6)? >> 16)),
            2 | 3 => (12, u64::from(source.u32("header length", 8)?)),
            _ => return Err(source.error(format!("version {version} at byte 6"), "1, 2 or 3")),
        };
        if length > MAX_HEADER {
            return Err(source.error(format!("a header of {length} bytes"), format!("{MAX_HEADER} at most")));
        }
        let text = String::from_utf8_lossy(source.slice("header", begin, length, 1)?);
        let array = Self { shape: shape(source, &text)?, kind: kind(source, &text)?, bytes: &[] };
        if value(&text, "fortran_order").is_some_and(|value| value.starts_with("True"))
            && array.shape.len() > 1
        {
            return Err(source.error("an array in Fortran's order", "C order: `numpy.ascontiguousarray`"));
        }
        let count = array.shape.iter().try_fold(1_u64, |count, axis| count.checked_mul(*axis));
        let size = count.and_then(|count| count.checked_mul(array.kind.size() as u64));
        let rest = &bytes[(begin + length) as usize..];
        if size != Some(rest.len() as u64) {
            let found = format!("{} bytes behind the header", rest.len());
            let expected = format!("an array {:?} of numbers of {} bytes", array.shape, array.kind.size());
            return Err(source.error(found, expected));
        }
        Ok(Self { bytes: rest, ..array })
    }

    /// So many numbers from the first on, as floats.
    pub fn first_floats(&self, count: usize) -> Vec<f32> {
        self.numbers().take(count).map(|number| number as f32).collect()
    }

    /// All numbers, which are whole ones from 0 on.
    pub fn whole(&self, source: &Source, name: &str) -> Result<Vec<u32>, GroomError> {
        let whole = |number: f64| {
            let fits = number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0;
            let refused = || source.error(format!("{number} in `{name}`"), "whole numbers from 0 on");
            if fits { Ok(number as u32) } else { Err(refused()) }
        };
        self.numbers().map(whole).collect()
    }

    /// The bytes of an array of single bytes.
    pub fn raw(&self) -> Option<&'a [u8]> {
        (self.kind.size() == 1).then_some(self.bytes)
    }

    fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let kind = self.kind;
        self.bytes.chunks_exact(kind.size()).map(move |bytes| number(kind, bytes))
    }
}

/// One number; whole ones of eight bytes are rounded to double precision.
fn number(kind: Kind, bytes: &[u8]) -> f64 {
    let mut word = [0_u8; 8];
    word[..bytes.len()].copy_from_slice(bytes);
    let unsigned = u64::from_le_bytes(word);
    match kind {
        Kind::Float(4) => f64::from(f32::from_bits(unsigned as u32)),
        Kind::Float(_) => f64::from_bits(unsigned),
        Kind::Unsigned(_) => unsigned as f64,
        Kind::Signed(size) => {
            let empty = 64 - 8 * size as u32;
            ((unsigned << empty) as i64 >> empty) as f64
        }
    }
}

/// Value of a key of a header, which is a Python dictionary of three entries.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) =
        text.split_once(&format!("'{key}'")).or_else(|| text.split_once(&format!("\"{key}\"")))?;
    Some(rest.trim_start().strip_prefix(':')?.trim_start())
}

fn kind(source: &Source, text: &str) -> Result<Kind, GroomError> {
    let name = value(text, "descr").and_then(|rest| rest.get(1..4)).unwrap_or_default();
    Ok(match name {
        "<f4" => Kind::Float(4),
        "<f8" => Kind::Float(8),
        "|u1" | "|b1" => Kind::Unsigned(1),
        "<u2" => Kind::Unsigned(2),
        "<u4" => Kind::Unsigned(4),
        "<u8" => Kind::Unsigned(8),
        "|i1" => Kind::Signed(1),
        "<i2" => Kind::Signed(2),
        "<i4" => Kind::Signed(4),
        "<i8" => Kind::Signed(8),
        found => {
            let expected = "little-endian numbers: `array.astype(numpy.float32)`";
            return Err(source.error(format!("an array of type `{}`", found.escape_debug()), expected));
        }
    })
}

fn shape(source: &Source, text: &str) -> Result<Vec<u64>, GroomError> {
    let inside = value(text, "shape").and_then(|rest| rest.strip_prefix('(')?.split_once(')'));
    let refused = || source.error("a header without a shape", "`'shape': (strands, points, 3)`");
    let (inside, _) = inside.ok_or_else(refused)?;
    let axes = inside.split(',').map(str::trim).filter(|axis| !axis.is_empty());
    let axes: Result<Vec<u64>, _> = axes.map(|axis| axis.parse::<u64>()).collect();
    axes.ok().filter(|axes| axes.len() <= MAX_AXES).ok_or_else(refused)
}

/// Reads a `.npy` file: an array \[strand, point, 3\], or \[point, 3\] with the points of each strand.
///
/// # Errors
/// [`GroomError::Malformed`] with what is wrong.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".npy" };
    let array = Array::new(&source)?;
    let groom = strands(&source, &array, per_strand)?;
    Ok(Parsed { format: ".npy", groom, problems: Vec::new() })
}

/// Strands of one number of points.
pub(super) fn strands(source: &Source, array: &Array, per_strand: Option<u32>) -> Result<Groom, GroomError> {
    let (count, each) = match (&array.shape[..], per_strand) {
        ([strands, points, 3], _) => (*strands, *points),
        ([points, 3], Some(each)) => split(source, *points, each)?,
        ([_, 3], None) => {
            let expected = "an array [strand, point, 3], or the points of a strand (`--per-strand N`)";
            return Err(source.error(format!("an array {:?}", array.shape), expected));
        }
        _ => return Err(source.error(format!("an array {:?}", array.shape), "[strand, point, 3]")),
    };
    even(source, count, each, |count| points(array, count))
}

/// Number of strands that `points` points make, with `each` per strand.
pub(super) fn split(source: &Source, points: u64, each: u32) -> Result<(u64, u64), GroomError> {
    let each = u64::from(each);
    if each == 0 || !points.is_multiple_of(each) {
        let expected = format!("a multiple of {each}, the points of a strand (`--per-strand`)");
        return Err(source.error(format!("{points} points"), expected));
    }
    Ok((points / each, each))
}

/// `count` strands of `each` points; `points` gives so many places.
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

/// So many places of an array.
pub(super) fn points(array: &Array, count: u64) -> Vec<Vec3> {
    array.first_floats(3 * count as usize).chunks_exact(3).map(Vec3::from_slice).collect()
}

/// The bytes of a `.npy` array; `kind` is NumPy's name of what it holds.
pub(super) fn array(kind: &str, shape: &[usize], numbers: impl Iterator<Item = u8>) -> Vec<u8> {
    let axes: String = shape.iter().map(|axis| format!("{axis}, ")).collect();
    let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}", axes.trim_end());
    // Numbers begin at a multiple of 64 bytes, as NumPy writes them.
    let length = (MAGIC.len() + 4 + text.len() + 1).next_multiple_of(64) - MAGIC.len() - 4;
    let mut out = MAGIC.to_vec();
    out.extend([1, 0]);
    out.extend((length as u16).to_le_bytes());
    out.extend(text.as_bytes());
    out.resize(MAGIC.len() + 4 + length - 1, b' ');
    out.push(b'\n');
    out.extend(numbers);
    out
}

/// Single-precision numbers as an array.
pub(super) fn floats(shape: &[usize], numbers: impl Iterator<Item = f32>) -> Vec<u8> {
    array("<f4", shape, numbers.flat_map(f32::to_le_bytes))
}

/// Writes a `.npy` file: an array \[strand, point, 3\].
///
/// # Errors
/// Strands of different point counts.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let each = super::tfx::each(groom, ".npy")?;
    let shape = [groom.strand_count(), each as usize, 3];
    Ok(floats(&shape, groom.points.iter().flat_map(|point| point.to_array())))
}
