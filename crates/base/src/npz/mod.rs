//! Arrays in a zip of .npy members, as numpy's `savez` writes and `load` reads them: little endian, C order.
//!
//! [`GrowingNpz`] writes rows during a run and leaves a sound file at every moment, [`pack`] writes arrays at once;
//! [`Npz`] reads stored and deflated members and takes no memory that the file does not have the bytes for.
//! [`Array::npy`] and [`Bare`] are one array alone, a .npy file.
//!
//! Layouts: the zip format's application note (APPNOTE 6.3.10, PKWARE) and the .npy format 1.0 to 3.0
//! (`numpy.lib.format`).

mod npy;
mod pack;
mod reader;
#[cfg(test)]
mod tests;
mod writer;
mod zip;

use std::borrow::Cow;

pub use npy::Bare;
pub use pack::pack;
pub use reader::{Npz, Rows};
pub use writer::{Growing, GrowingNpz};

/// Most members that a reader accepts.
const MAX_MEMBERS: u64 = 4096;
/// Longest name of a member \[byte\].
const MAX_NAME: usize = 256;

/// The type of an array's elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers without a sign.
    U8,
    /// 16 bits.
    U16,
    /// 32 bits.
    U32,
    /// 64 bits.
    U64,
    /// Whole numbers with a sign.
    I8,
    /// 16 bits.
    I16,
    /// 32 bits.
    I32,
    /// 64 bits.
    I64,
    /// Half precision.
    F16,
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl Kind {
    /// Every kind, numpy's name of it, and the bytes \[byte\] of an element.
    const ALL: [(Self, &'static str, u64); 11] = [
        (Self::U8, "|u1", 1),
        (Self::U16, "<u2", 2),
        (Self::U32, "<u4", 4),
        (Self::U64, "<u8", 8),
        (Self::I8, "|i1", 1),
        (Self::I16, "<i2", 2),
        (Self::I32, "<i4", 4),
        (Self::I64, "<i8", 8),
        (Self::F16, "<f2", 2),
        (Self::F32, "<f4", 4),
        (Self::F64, "<f8", 8),
    ];

    fn row(self) -> (&'static str, u64) {
        let row = Self::ALL.iter().find(|row| row.0 == self).expect("every kind has a row");
        (row.1, row.2)
    }

    /// Name in numpy's headers.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Bytes of an element.
    pub fn bytes(self) -> u64 {
        self.row().1
    }

    /// The kind of a name, and true for numbers with the high byte first; numpy's truth values are bytes of 0 and 1.
    fn of_name(name: &str) -> Option<(Self, bool)> {
        let name = if name == "|b1" { "|u1" } else { name };
        let big = name.strip_prefix('>');
        let is_named = |own: &str| match big {
            Some(bare) => own.strip_prefix('<') == Some(bare),
            None => own == name,
        };
        Self::ALL.iter().find(|row| is_named(row.1)).map(|row| (row.0, big.is_some()))
    }

    /// Elements in double precision; whole numbers of 64 bits are rounded to it.
    pub fn numbers(self, bytes: &[u8]) -> impl Iterator<Item = f64> + '_ {
        bytes.chunks_exact(self.bytes() as usize).map(move |element| self.number(element))
    }

    fn number(self, element: &[u8]) -> f64 {
        let mut word = [0; 8];
        word[..element.len()].copy_from_slice(element);
        let unsigned = u64::from_le_bytes(word);
        match self {
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => unsigned as f64,
            Self::I8 | Self::I16 | Self::I32 | Self::I64 => {
                let empty = 64 - 8 * element.len() as u32;
                ((unsigned << empty) as i64 >> empty) as f64
            }
            Self::F16 => half(unsigned),
            Self::F32 => f64::from(f32::from_bits(unsigned as u32)),
            Self::F64 => f64::from_bits(unsigned),
        }
    }
}

/// A number of half precision [IEEE 754 binary16] by its bits.
fn half(bits: u64) -> f64 {
    let (exponent, fraction) = (bits >> 10 & 31, (bits & 1023) as f64);
    // 2 to the power of an exponent from 1 on, less 25.
    let power = |exponent: u64| f64::from_bits((exponent + 1023 - 25) << 52);
    let size = match exponent {
        0 => fraction * power(1),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * power(exponent),
    };
    if bits >> 15 & 1 == 1 { -size } else { size }
}

/// An array that is written as a whole.
#[derive(Clone, Debug)]
pub struct Array<'a> {
    /// Its name, without `.npy`.
    pub name: &'a str,
    /// Type of the elements.
    pub kind: Kind,
    /// Shape.
    pub shape: Vec<u64>,
    /// The elements in C order, little endian.
    pub bytes: Cow<'a, [u8]>,
}

impl<'a> Array<'a> {
    /// Single-precision numbers.
    pub fn f32s(name: &'a str, shape: &[usize], numbers: impl IntoIterator<Item = f32>) -> Self {
        Self::of(name, Kind::F32, shape, numbers.into_iter().flat_map(f32::to_le_bytes).collect())
    }

    /// Double-precision numbers.
    pub fn f64s(name: &'a str, shape: &[usize], numbers: impl IntoIterator<Item = f64>) -> Self {
        Self::of(name, Kind::F64, shape, numbers.into_iter().flat_map(f64::to_le_bytes).collect())
    }

    /// Whole numbers.
    pub fn u32s(name: &'a str, shape: &[usize], numbers: impl IntoIterator<Item = u32>) -> Self {
        Self::of(name, Kind::U32, shape, numbers.into_iter().flat_map(u32::to_le_bytes).collect())
    }

    /// Bytes of any kind.
    pub fn of(name: &'a str, kind: Kind, shape: &[usize], bytes: Vec<u8>) -> Self {
        let shape = shape.iter().map(|count| *count as u64).collect();
        Self { name, kind, shape, bytes: bytes.into() }
    }
}

/// The single-precision numbers in bytes.
pub fn f32s(bytes: &[u8]) -> impl Iterator<Item = f32> + '_ {
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
}

/// The double-precision numbers in bytes.
pub fn f64s(bytes: &[u8]) -> impl Iterator<Item = f64> + '_ {
    bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(std::array::from_fn(|index| eight[index])))
}

/// The whole numbers of 32 bits in bytes.
pub fn u32s(bytes: &[u8]) -> impl Iterator<Item = u32> + '_ {
    bytes.chunks_exact(4).map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]))
}

/// Why a file is no zip of arrays that can be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NpzError {
    /// The system could not read it.
    #[error(transparent)]
    Read(#[from] std::io::Error),
    /// Its bytes violate the format.
    #[error("{found}, expected {expected}")]
    Malformed {
        /// Content that was found, with its place.
        found: String,
        /// Content that was expected there.
        expected: String,
    },
}

impl NpzError {
    /// An error about the content.
    pub fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::Malformed { found: found.into(), expected: expected.into() }
    }
}
