//! Arrays in a zip of .npy members, as numpy's `savez` writes and `load` reads them: little endian, C order.
//!
//! [`GrowingNpz`] writes rows during a run and leaves a sound file at every moment; [`Npz`] reads stored
//! and deflated members and takes no memory that the file does not have the bytes for.
//!
//! Layouts: the zip format's application note (APPNOTE 6.3.10, PKWARE) and the .npy format 1.0 to 3.0
//! (`numpy.lib.format`).

mod npy;
mod reader;
#[cfg(test)]
mod tests;
mod writer;
mod zip;

use std::borrow::Cow;

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
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl Kind {
    /// Every kind, numpy's name of it, and the bytes of an element.
    const ALL: [(Self, &'static str, u64); 10] = [
        (Self::U8, "|u1", 1),
        (Self::U16, "<u2", 2),
        (Self::U32, "<u4", 4),
        (Self::U64, "<u8", 8),
        (Self::I8, "|i1", 1),
        (Self::I16, "<i2", 2),
        (Self::I32, "<i4", 4),
        (Self::I64, "<i8", 8),
        (Self::F32, "<f4", 4),
        (Self::F64, "<f8", 8),
    ];

    fn row(self) -> (&'static str, u64) {
        let row = Self::ALL.iter().find(|row| row.0 == self).expect("every kind has a row");
        (row.1, row.2)
    }

    /// Type name in numpy.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Bytes of an element.
    pub fn bytes(self) -> u64 {
        self.row().1
    }

    fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|row| row.1 == name).map(|row| row.0)
    }
}

/// An array that is written at once.
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
