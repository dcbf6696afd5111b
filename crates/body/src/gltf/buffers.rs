//! The buffers of a glTF file and the numbers in them, read with every size checked first.

use std::path::Path;

use ::gltf::Document;
use ::gltf::accessor::sparse::IndexType;
use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::buffer::{Source, View};
use glam::Vec3;

use super::address::{file_below, from_base64};
use crate::parsing::{Refusal, read_file};

/// The bytes of each buffer.
pub(super) struct Buffers {
    bytes: Vec<Vec<u8>>,
    /// Most elements of one accessor: those without bytes of their own could be any number.
    pub limit: usize,
}

/// Loads what the file holds itself, what it encodes as text, and files beside it.
pub(super) fn load_buffers(
    document: &Document,
    mut blob: Option<Vec<u8>>,
    folder: Option<&Path>,
) -> Result<Vec<Vec<u8>>, Refusal> {
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let index = buffer.index();
        let bytes = match buffer.source() {
            Source::Bin => blob.take(),
            Source::Uri(uri) if uri.starts_with("data:") => {
                uri.split_once(";base64,").and_then(|(_, text)| from_base64(text))
            }
            Source::Uri(uri) => {
                let path = folder.and_then(|folder| file_below(folder, uri)).ok_or_else(|| {
                    (
                        format!("buffer {index} at `{uri}`"),
                        "the name of a file beside this one, or in a folder there",
                    )
                })?;
                let expected = "the file of that name beside this one";
                Some(read_file(&path).map_err(|error| (format!("buffer {index}: {error}"), expected))?)
            }
        };
        match bytes {
            Some(bytes) => buffers.push(bytes),
            None => {
                return Err((format!("no bytes for buffer {index}"), "a buffer in the file or beside it"));
            }
        }
    }
    Ok(buffers)
}

impl Buffers {
    pub fn new(bytes: Vec<Vec<u8>>, limit: usize) -> Self {
        Self { bytes, limit }
    }

    /// At most `most` elements of three numbers each: floats, or whole numbers as KHR_mesh_quantization has them.
    pub fn vectors(&self, accessor: &Accessor<'_>, most: usize) -> Result<Vec<Vec3>, Refusal> {
        let kinds = [DataType::F32, DataType::I8, DataType::U8, DataType::I16, DataType::U16];
        self.numbers::<3>(accessor, &kinds, most).map(|all| all.into_iter().map(Vec3::from_array).collect())
    }

    /// At most `most` elements of `N` numbers each, normalised where the accessor says so.
    pub fn numbers<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        kinds: &[DataType],
        most: usize,
    ) -> Result<Vec<[f32; N]>, Refusal> {
        let kind = accessor.data_type();
        if accessor.dimensions().multiplicity() != N || !kinds.contains(&kind) {
            let found = format!("accessor {} of other numbers", accessor.index());
            return Err((found, "the numbers that glTF 2.0 or KHR_mesh_quantization have there"));
        }
        let elements = self.elements(accessor, most)?;
        let number = |bytes: &[u8]| number(kind, bytes, accessor.normalized());
        let element = |bytes: &[u8]| std::array::from_fn(|at| number(&bytes[at * kind.size()..]));
        Ok(elements.chunks_exact(N * kind.size()).map(element).collect())
    }

    /// At most `most` elements of four whole numbers each: the joints of vertices.
    pub fn joints(&self, accessor: &Accessor<'_>, most: usize) -> Result<Vec<[u32; 4]>, Refusal> {
        let size = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Vec4) => 1,
            (DataType::U16, Dimensions::Vec4) => 2,
            _ => return Err(other_numbers(accessor, "four whole numbers of 8 or 16 bits as joints")),
        };
        let elements = self.elements(accessor, most)?;
        let element = |bytes: &[u8]| std::array::from_fn(|at| whole(&bytes[at * size..(at + 1) * size]));
        Ok(elements.chunks_exact(4 * size).map(element).collect())
    }

    /// An accessor of whole numbers.
    pub fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, Refusal> {
        let size = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => 1,
            (DataType::U16, Dimensions::Scalar) => 2,
            (DataType::U32, Dimensions::Scalar) => 4,
            _ => return Err(other_numbers(accessor, "whole numbers without sign as indices")),
        };
        Ok(self.elements(accessor, usize::MAX)?.chunks_exact(size).map(whole).collect())
    }

    /// The bytes of at most `most` elements, one behind the other.
    fn elements(&self, accessor: &Accessor<'_>, most: usize) -> Result<Vec<u8>, Refusal> {
        let count = accessor.count().min(most);
        let size = accessor.size();
        let refused =
            |what: &str| (format!("accessor {} {what}", accessor.index()), "numbers within a buffer");
        let mut elements = match accessor.view() {
            Some(view) => {
                let stride = view.stride().unwrap_or(size);
                self.part(&view, accessor.offset(), [count, size, stride])
                    .ok_or_else(|| refused("beyond its buffer"))?
            }
            None if accessor.sparse().is_none() => return Err(refused("without a buffer")),
            None if count > self.limit => return Err(refused("of more elements than the file could hold")),
            None => vec![0; count * size],
        };
        if let Some(sparse) = accessor.sparse() {
            let index_size = match sparse.indices().index_type() {
                IndexType::U8 => 1,
                IndexType::U16 => 2,
                IndexType::U32 => 4,
            };
            let changed = sparse.count();
            let indices = sparse.indices();
            let indices = self.part(&indices.view(), indices.offset(), [changed, index_size, index_size]);
            let values = sparse.values();
            let values = self.part(&values.view(), values.offset(), [changed, size, size]);
            let (indices, values) =
                indices.zip(values).ok_or_else(|| refused("whose sparse part lies beyond its buffer"))?;
            for (index, value) in indices.chunks_exact(index_size).zip(values.chunks_exact(size)) {
                let index = whole(index) as usize;
                if index >= accessor.count() {
                    return Err(refused("with a sparse index beyond its elements"));
                }
                if index < count {
                    elements[index * size..(index + 1) * size].copy_from_slice(value);
                }
            }
        }
        Ok(elements)
    }

    /// All bytes of a view; `None` beyond its buffer.
    pub fn bytes_of(&self, view: &View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.bytes.get(view.buffer().index())?.get(view.offset()..end)
    }

    /// Elements of a view from an offset on, by count, size and stride \[byte\]; `None` beyond the buffer.
    fn part(&self, view: &View<'_>, offset: usize, [count, size, stride]: [usize; 3]) -> Option<Vec<u8>> {
        let stride = stride.max(size);
        let part = self.bytes_of(view)?.get(offset..)?;
        let needed = match count.checked_sub(1) {
            Some(gaps) => gaps.checked_mul(stride)?.checked_add(size)?,
            None => 0,
        };
        if needed > part.len() {
            return None;
        }
        if stride == size {
            return Some(part[..needed].to_vec());
        }
        Some(
            (0..count)
                .flat_map(|element| &part[element * stride..element * stride + size])
                .copied()
                .collect(),
        )
    }
}

fn other_numbers(accessor: &Accessor<'_>, expected: &'static str) -> Refusal {
    (format!("accessor {} of other numbers", accessor.index()), expected)
}

/// A whole number without sign, the lowest byte first.
fn whole(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, byte| (value << 8) | u32::from(*byte))
}

/// The first number of bytes; normalised ones are shares of the largest.
fn number(kind: DataType, bytes: &[u8], is_normalized: bool) -> f32 {
    let (value, largest) = match kind {
        DataType::I8 => (f32::from(bytes[0] as i8), 127.0),
        DataType::U8 => (f32::from(bytes[0]), 255.0),
        DataType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
        DataType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
        DataType::U32 => (whole(&bytes[..4]) as f32, u32::MAX as f32),
        DataType::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    };
    if is_normalized { (value / largest).max(-1.0) } else { value }
}
