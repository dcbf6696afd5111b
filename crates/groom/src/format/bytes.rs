//! Little-endian numbers out of and into bytes.

use glam::{Vec2, Vec3};

use crate::GroomError;

/// Bytes of a file of a named format.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    pub bytes: &'a [u8],
    pub format: &'static str,
}

impl<'a> Source<'a> {
    /// An error about the content.
    pub fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> GroomError {
        GroomError::Malformed {
            format: self.format,
            found: found.into(),
            expected: expected.into(),
            mend: "the file may be cut off or of another format: export it again",
        }
    }

    /// `count` elements of `size` bytes at `offset`; refused when they reach beyond the end.
    pub fn slice(&self, what: &str, offset: u64, count: u64, size: u64) -> Result<&'a [u8], GroomError> {
        let end = count.checked_mul(size).and_then(|length| length.checked_add(offset));
        match end {
            Some(end) if end <= self.bytes.len() as u64 => Ok(&self.bytes[offset as usize..end as usize]),
            _ => {
                let length = self.bytes.len();
                Err(self.error(
                    format!("{length} bytes"),
                    format!("{count} x {size} bytes of {what} from byte {offset}"),
                ))
            }
        }
    }

    pub fn u32(&self, what: &str, offset: u64) -> Result<u32, GroomError> {
        let bytes = self.slice(what, offset, 1, 4)?;
        Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    pub fn f32(&self, what: &str, offset: u64) -> Result<f32, GroomError> {
        Ok(f32::from_bits(self.u32(what, offset)?))
    }

    pub fn f32s(&self, what: &str, offset: u64, count: u64) -> Result<Vec<f32>, GroomError> {
        Ok(numbers(self.slice(what, offset, count, 4)?).collect())
    }

    /// Groups of `N` numbers; the first `M` of each are kept.
    pub fn groups<const N: usize, const M: usize>(
        &self,
        what: &str,
        offset: u64,
        count: u64,
    ) -> Result<Vec<[f32; M]>, GroomError> {
        let bytes = self.slice(what, offset, count, 4 * N as u64)?;
        let group = |bytes: &[u8]| {
            let mut group = [0.0; M];
            for (slot, number) in group.iter_mut().zip(numbers(bytes)) {
                *slot = number;
            }
            group
        };
        Ok(bytes.chunks_exact(4 * N).map(group).collect())
    }
}

fn numbers(bytes: &[u8]) -> impl Iterator<Item = f32> + '_ {
    bytes.chunks_exact(4).map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
}

/// Appends numbers.
pub fn put(out: &mut Vec<u8>, numbers: impl IntoIterator<Item = f32>) {
    for number in numbers {
        out.extend_from_slice(&number.to_le_bytes());
    }
}

/// Appends whole numbers.
pub fn put_u32(out: &mut Vec<u8>, numbers: impl IntoIterator<Item = u32>) {
    for number in numbers {
        out.extend_from_slice(&number.to_le_bytes());
    }
}

pub fn vec3(values: [f32; 3]) -> Vec3 {
    Vec3::from_array(values)
}

pub fn vec2(values: [f32; 2]) -> Vec2 {
    Vec2::from_array(values)
}
