//! The buffers of a glTF file, read with every size checked first.

use std::path::{Component, Path};

use ::gltf::Document;
use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::buffer::Source;
use glam::Vec3;

use crate::parsing::{Refusal, read_file};

/// The bytes of each buffer.
pub(crate) struct Buffers(Vec<Vec<u8>>);

/// Loads buffers in the file, buffers encoded as text, and files beside it.
pub(crate) fn load_buffers(
    document: &Document,
    mut blob: Option<Vec<u8>>,
    folder: Option<&Path>,
) -> Result<Buffers, Refusal> {
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let index = buffer.index();
        let bytes = match buffer.source() {
            Source::Bin => blob.take(),
            Source::Uri(uri) if uri.starts_with("data:") => {
                uri.split_once(";base64,").and_then(|(_, text)| from_base64(text))
            }
            Source::Uri(uri) => {
                let (folder, name) = folder.zip(file_name(uri)).ok_or_else(|| {
                    (
                        format!("buffer {index} at `{uri}`"),
                        "the name of a file beside this one, or in a folder there",
                    )
                })?;
                let expected = "the file of that name beside this one";
                Some(
                    read_file(&folder.join(name))
                        .map_err(|error| (format!("buffer {index}: {error}"), expected))?,
                )
            }
        };
        match bytes {
            Some(bytes) => buffers.push(bytes),
            None => {
                return Err((format!("no bytes for buffer {index}"), "a buffer in the file or beside it"));
            }
        }
    }
    Ok(Buffers(buffers))
}

/// A relative address as a path below the file's folder: `%20` and the like become bytes again. `None` for other
/// addresses, and for paths that leave the folder after decoding: from the root, upward, a drive, a share.
fn file_name(uri: &str) -> Option<String> {
    let mut parts = uri.split('%');
    let mut name = parts.next()?.as_bytes().to_vec();
    for part in parts {
        name.push(u8::from_str_radix(part.get(..2)?, 16).ok()?);
        name.extend_from_slice(&part.as_bytes()[2..]);
    }
    String::from_utf8(name).ok().filter(|name| {
        // Separators of folders and drives of any system count on all systems: a file means the same
        // everywhere.
        let is_below =
            |name: &str| Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        !name.is_empty() && !name.contains(['\0', ':', '\\']) && is_below(name)
    })
}

/// The bytes of text in base 64 \[RFC4648 §4\], with or without `=` at its end.
fn from_base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for four in text.chunks(4) {
        let mut bits = 0_u32;
        for digit in four {
            let value = match digit {
                b'A'..=b'Z' => digit - b'A',
                b'a'..=b'z' => digit - b'a' + 26,
                b'0'..=b'9' => digit - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        // Six bits a digit: one digit alone is no byte.
        let count = four.len() * 6 / 8;
        if count == 0 {
            return None;
        }
        bits <<= 32 - 6 * four.len() as u32;
        bytes.extend(&bits.to_be_bytes()[..count]);
    }
    Some(bytes)
}

impl Buffers {
    /// Bytes of all buffers.
    pub fn len(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    /// An accessor of three floats each.
    pub fn vectors(&self, accessor: &Accessor<'_>) -> Result<Vec<Vec3>, Refusal> {
        if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            let found = format!("accessor {} of other numbers", accessor.index());
            return Err((found, "three 32-bit floats for each vertex"));
        }
        let float = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        Ok(self
            .elements(accessor, 12)?
            .map(|bytes| Vec3::new(float(&bytes[..4]), float(&bytes[4..8]), float(&bytes[8..])))
            .collect())
    }

    /// An accessor of whole numbers.
    pub fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, Refusal> {
        let size = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => 1,
            (DataType::U16, Dimensions::Scalar) => 2,
            (DataType::U32, Dimensions::Scalar) => 4,
            _ => {
                let found = format!("accessor {} of other numbers", accessor.index());
                return Err((found, "whole numbers without sign as indices"));
            }
        };
        let elements = self.elements(accessor, size)?;
        Ok(elements
            .map(|bytes| bytes.iter().rev().fold(0, |value, byte| (value << 8) | u32::from(*byte)))
            .collect())
    }

    /// The bytes of each element, `size` bytes long.
    fn elements(&self, accessor: &Accessor<'_>, size: usize) -> Result<impl Iterator<Item = &[u8]>, Refusal> {
        let index = accessor.index();
        let refused = |what: &str| (format!("accessor {index} {what}"), "numbers within a buffer");
        if accessor.sparse().is_some() {
            return Err(refused("that is sparse"));
        }
        let view = accessor.view().ok_or_else(|| refused("without a buffer"))?;
        let bytes = self.0.get(view.buffer().index()).ok_or_else(|| refused("of no buffer"))?;
        let stride = view.stride().unwrap_or(size).max(size);
        let count = accessor.count();
        let part = view
            .offset()
            .checked_add(view.length())
            .and_then(|end| bytes.get(view.offset()..end))
            .and_then(|part| part.get(accessor.offset()..))
            .ok_or_else(|| refused("beyond its buffer"))?;
        let needed = count.checked_sub(1).and_then(|gaps| gaps.checked_mul(stride)?.checked_add(size));
        if needed.unwrap_or(if count == 0 { 0 } else { usize::MAX }) > part.len() {
            return Err(refused("beyond its buffer"));
        }
        Ok((0..count).map(move |element| &part[element * stride..element * stride + size]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_in_base_64_is_read() {
        // [RFC4648 §10]
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg", "foob"),
            ("Zm9vYmFy", "foobar"),
        ] {
            assert_eq!(from_base64(text).as_deref(), Some(bytes.as_bytes()), "{text}");
        }
        assert_eq!(from_base64("+/+/"), Some(vec![0xfb, 0xff, 0xbf]));
        for text in ["Zm9vY", "Zm 9v", "Zm-_", "Zg=v"] {
            assert_eq!(from_base64(text), None, "{text}");
        }
    }
}
