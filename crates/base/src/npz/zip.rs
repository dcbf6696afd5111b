//! The records of a zip that hold its members together. Members are stored; dates are the format's first, so
//! that the same arrays are the same bytes.

use super::npy::ALIGNMENT;

pub const LOCAL: u32 = 0x0403_4b50;
pub const CENTRAL: u32 = 0x0201_4b50;
pub const END: u32 = 0x0605_4b50;
pub const END_64: u32 = 0x0606_4b50;
pub const LOCATOR_64: u32 = 0x0706_4b50;

/// Bytes of the records without their variable fields.
pub const LOCAL_BYTES: u64 = 30;
pub const CENTRAL_BYTES: usize = 46;
pub const END_BYTES: usize = 22;
pub const END_64_BYTES: usize = 56;
pub const LOCATOR_64_BYTES: usize = 20;

/// The extra field of sizes of more than 32 bits.
pub const EXTRA_64: u16 = 1;
/// The extra field that aligns what follows, as Android's tools have it.
const EXTRA_ALIGN: u16 = 0xd935;
/// Stands in a field of 32 bits for a number that the extra field has.
pub const LARGE: u32 = u32::MAX;

/// 1980-01-01.
const DATE: u16 = 0x0021;
/// An ordinary file that its owner may write.
const ATTRIBUTES: u32 = 0o100_644 << 16;

/// A stored member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// With `.npy`.
    pub name: String,
    /// Offset of the local header \[byte\].
    pub offset: u64,
    pub size: u64,
    pub crc: u32,
}

struct Bytes(Vec<u8>);

impl Bytes {
    fn u16s(&mut self, numbers: &[u16]) -> &mut Self {
        self.0.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        self
    }

    fn u32s(&mut self, numbers: &[u32]) -> &mut Self {
        self.0.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        self
    }

    fn u64s(&mut self, numbers: &[u64]) -> &mut Self {
        self.0.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        self
    }

    /// The part that local and central headers share.
    fn common(&mut self, entry: &Entry, zip64: bool) -> &mut Self {
        let size = if zip64 { LARGE } else { entry.size as u32 };
        self.u16s(&[if zip64 { 45 } else { 20 }, 0, 0, 0, DATE]).u32s(&[entry.crc, size, size])
    }
}

/// The local header of a member; what follows it is aligned.
pub fn local(entry: &Entry, zip64: bool) -> Vec<u8> {
    let own = if zip64 { 20 } else { 0 };
    let end = entry.offset + LOCAL_BYTES + entry.name.len() as u64 + own;
    let mut pad = end.next_multiple_of(ALIGNMENT) - end;
    // The field has a head of its own.
    while pad != 0 && pad < 6 {
        pad += ALIGNMENT;
    }
    let mut bytes = Bytes(Vec::new());
    bytes.u32s(&[LOCAL]).common(entry, zip64);
    bytes.u16s(&[entry.name.len() as u16, (own + pad) as u16]).0.extend_from_slice(entry.name.as_bytes());
    if zip64 {
        bytes.u16s(&[EXTRA_64, 16]).u64s(&[entry.size, entry.size]);
    }
    if pad > 0 {
        bytes.u16s(&[EXTRA_ALIGN, pad as u16 - 4, ALIGNMENT as u16]);
        let length = bytes.0.len() as u64 + pad - 6;
        bytes.0.resize(length as usize, 0);
    }
    bytes.0
}

/// Bytes of a member's record in the directory.
pub fn record_bytes(name: &str, zip64: bool) -> u64 {
    (CENTRAL_BYTES + name.len() + if zip64 { 28 } else { 0 }) as u64
}

/// The directory at the end of a file, which begins at `offset`.
pub fn directory<'a>(entries: impl Iterator<Item = &'a Entry>, offset: u64, zip64: bool) -> Vec<u8> {
    let mut bytes = Bytes(Vec::new());
    let mut count = 0;
    for entry in entries {
        count += 1;
        bytes.u32s(&[CENTRAL]).u16s(&[3 << 8 | 45]).common(entry, zip64);
        let extra = if zip64 { 28 } else { 0 };
        bytes.u16s(&[entry.name.len() as u16, extra, 0, 0, 0]).u32s(&[ATTRIBUTES]);
        bytes.u32s(&[if zip64 { LARGE } else { entry.offset as u32 }]);
        bytes.0.extend_from_slice(entry.name.as_bytes());
        if zip64 {
            bytes.u16s(&[EXTRA_64, 24]).u64s(&[entry.size, entry.size, entry.offset]);
        }
    }
    let size = bytes.0.len() as u64;
    if zip64 {
        bytes.u32s(&[END_64]).u64s(&[END_64_BYTES as u64 - 12]).u16s(&[3 << 8 | 45, 45]).u32s(&[0, 0]);
        bytes.u64s(&[count, count, size, offset]);
        bytes.u32s(&[LOCATOR_64, 0]).u64s(&[offset + size]).u32s(&[1]);
    }
    let start = if zip64 { LARGE } else { offset as u32 };
    bytes.u32s(&[END]).u16s(&[0, 0, count as u16, count as u16]).u32s(&[size as u32, start]).u16s(&[0]);
    bytes.0
}
