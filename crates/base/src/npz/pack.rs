//! A zip of arrays, written as a whole.

use crc32fast::Hasher;

use super::{
    Array, npy,
    zip::{self, Entry},
};

/// Files that may become larger than this \[byte\] have sizes of 64 bits: 4 GiB without what records take.
pub const SMALL: u64 = (4 << 30) - (64 << 20);

/// Name of an array's member.
pub fn file_name(name: &str) -> String {
    format!("{name}.npy")
}

/// The directory entry of an array at `offset`, and the bytes before its elements: the member's header and its own.
pub fn member(array: &Array, offset: u64, zip64: bool) -> (Entry, Vec<u8>) {
    let header = npy::header(array.kind, &array.shape, 0);
    let mut crc = Hasher::new();
    crc.update(&header);
    crc.update(&array.bytes);
    let size = (header.len() + array.bytes.len()) as u64;
    let entry = Entry { name: file_name(array.name), offset, size, crc: crc.finalize() };
    let mut bytes = zip::local(&entry, zip64);
    bytes.extend(header);
    (entry, bytes)
}

impl Array<'_> {
    /// The array as a .npy file.
    pub fn npy(&self) -> Vec<u8> {
        let mut bytes = npy::header(self.kind, &self.shape, 0);
        bytes.extend_from_slice(&self.bytes);
        bytes
    }
}

/// Arrays as a .npz file; the same arrays are the same bytes.
pub fn pack(arrays: &[Array]) -> Vec<u8> {
    let elements: u64 = arrays.iter().map(|array| array.bytes.len() as u64).sum();
    packed(arrays, elements > SMALL)
}

fn packed(arrays: &[Array], zip64: bool) -> Vec<u8> {
    let (mut bytes, mut entries) = (Vec::new(), Vec::new());
    for array in arrays {
        let (entry, head) = member(array, bytes.len() as u64, zip64);
        bytes.extend(head);
        bytes.extend_from_slice(&array.bytes);
        entries.push(entry);
    }
    bytes.extend(zip::directory(entries.iter(), bytes.len() as u64, zip64));
    bytes
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::{Kind, Npz, u32s};
    use super::*;

    #[test]
    fn packed_arrays_are_read_again_with_sizes_of_32_and_64_bits() {
        let arrays = [
            Array::u32s("starts", &[3], [0, 40, 100]),
            Array::f32s("points", &[2, 3], (0..6).map(|number| number as f32)),
            Array::of("meta", Kind::U8, &[2], b"{}".to_vec()),
        ];
        for zip64 in [false, true] {
            let bytes = packed(&arrays, zip64);
            assert_eq!(bytes.windows(4).any(|four| four == zip::END_64.to_le_bytes()), zip64);
            let mut npz = Npz::new(Cursor::new(&bytes)).unwrap();
            assert_eq!(npz.names().collect::<Vec<_>>(), ["starts", "points", "meta"]);
            for array in &arrays {
                let mut rows = npz.open(array.name).unwrap().unwrap();
                assert_eq!((rows.kind(), rows.shape()), (array.kind, &array.shape[..]));
                assert_eq!(npz.all(&mut rows).unwrap(), *array.bytes);
            }
            assert!(npz.unpacked_bytes() > 12 + 24 + 2 && npz.unpacked_bytes() < bytes.len() as u64);
        }
        assert_eq!(u32s(&arrays[0].npy()[128..]).collect::<Vec<_>>(), [0, 40, 100]);
    }
}
