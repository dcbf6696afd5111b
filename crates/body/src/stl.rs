//! Reading meshes of `.stl` files, text and binary.

use std::collections::HashMap;

use glam::Vec3;
use strandline_base::utf8_text;

use crate::Mesh;
use crate::parsing::Refusal;

/// Bytes before the count of a binary file, and of each of its triangles: a normal, three corners, two bytes.
const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// Reads a mesh from the bytes of a file, in its units; corners at one place become one vertex without a normal.
pub(crate) fn parse(bytes: &[u8]) -> Result<Mesh, Refusal> {
    // Binary files may begin with the word of text files: their length tells them.
    let corners = match binary_count(bytes) {
        Some(count) => binary(bytes, count),
        None => text(&utf8_text(bytes))?,
    };
    let mut mesh = Mesh::default();
    let mut known = HashMap::new();
    let mut vertex = |corner: Vec3| {
        // Zeros of both signs are one place.
        *known.entry((corner + 0.0).to_array().map(f32::to_bits)).or_insert_with(|| {
            mesh.positions.push(corner);
            mesh.positions.len() as u32 - 1
        })
    };
    mesh.triangles = corners.iter().map(|corners| corners.map(&mut vertex)).collect();
    mesh.normals = vec![Vec3::ZERO; mesh.positions.len()];
    Ok(mesh)
}

/// The triangles of a binary file, which its length must hold; `None` for text.
fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER..HEADER + 4)?.try_into().map(u32::from_le_bytes).ok()? as usize;
    let length = count.checked_mul(TRIANGLE)?.checked_add(HEADER + 4)?;
    let is_text = utf8_text(bytes).trim_ascii_start().starts_with(b"solid");
    (bytes.len() == length || (bytes.len() > length && !is_text)).then_some(count)
}

fn binary(bytes: &[u8], count: usize) -> Vec<[Vec3; 3]> {
    let number = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let corner = |bytes: &[u8]| Vec3::new(number(bytes), number(&bytes[4..]), number(&bytes[8..]));
    let rows = bytes[HEADER + 4..].chunks_exact(TRIANGLE).take(count);
    rows.map(|row| [12, 24, 36].map(|at| corner(&row[at..]))).collect()
}

/// The triangles of a text: three lines `vertex x y z` each.
fn text(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, Refusal> {
    const EXPECTED: &str =
        "an STL file, binary with the length that it states or text from `solid` to `endsolid`";
    let refused = |found: String| (found, EXPECTED);
    if !bytes.trim_ascii_start().starts_with(b"solid") {
        return Err(refused(format!("{} bytes that begin with `{}`", bytes.len(), start(bytes))));
    }
    let mut corners = Vec::new();
    for (number, line) in bytes.split(|byte| matches!(byte, b'\n' | b'\r')).enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let numbers: Vec<f32> = words.map(str::parse).collect::<Result<_, _>>().unwrap_or_default();
                let [x, y, z] = numbers[..] else {
                    return Err(refused(format!("`{}` in line {}", start(line.as_bytes()), number + 1)));
                };
                corners.push(Vec3::new(x, y, z));
            }
            Some("endfacet") if !corners.len().is_multiple_of(3) => {
                return Err(refused(format!(
                    "a facet of other than three vertices before line {}",
                    number + 1
                )));
            }
            _ => {}
        }
    }
    let (triangles, rest) = corners.as_chunks::<3>();
    if rest.is_empty() { Ok(triangles.to_vec()) } else { Err(refused("a facet that is cut off".to_owned())) }
}

/// The first bytes of a text, human-readable.
fn start(bytes: &[u8]) -> String {
    bytes[..bytes.len().min(40)].escape_ascii().to_string()
}
