//! Small files of the formats that bodies come in.

use std::path::PathBuf;

use strandline_body::{BodyError, Mesh};
use tempfile::TempDir;

/// The cube from 0 to 1 in six quads.
pub const CUBE_OBJ: &str = "# a cube
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
";

/// The quads of the cube.
const QUADS: [[u8; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// A file in a folder of its own, which goes when the folder is dropped.
pub fn scratch(name: &str, bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

/// Result of loading a file of this name and content.
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Mesh, BodyError> {
    let (_folder, path) = scratch(name, bytes);
    Mesh::load(&path, 1.0)
}

/// Eight places, then 36 indices of a byte.
pub fn cube_bin() -> Vec<u8> {
    let places = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let floats = places.iter().flatten().flat_map(|number: &u8| f32::from(*number).to_le_bytes());
    floats.chain(QUADS.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])).collect()
}

/// The cube below two nodes, with `placing` as the members of the inner one.
pub fn cube_json(placing: &str, uri: Option<&str>) -> String {
    let placing = placing.trim_start_matches('{').trim_end_matches('}');
    let comma = if placing.is_empty() { "" } else { ", " };
    let uri = uri.map(|uri| format!(r#", "uri": "{uri}""#)).unwrap_or_default();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"children": [1]}}, {{"mesh": 0, "skin": 0{comma}{placing}}}],
"skins": [{{"joints": [0]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
"accessors": [
 {{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}},
 {{"bufferView": 1, "componentType": 5121, "count": 36, "type": "SCALAR"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 96}}, {{"buffer": 0, "byteOffset": 96, "byteLength": 36}}],
"buffers": [{{"byteLength": 132{uri}}}]}}"#
    )
}

/// A binary glTF file.
pub fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF".to_vec();
    let number = |bytes: &mut Vec<u8>, number: usize| bytes.extend((number as u32).to_le_bytes());
    number(&mut bytes, 2);
    number(&mut bytes, 28 + json.len() + bin.len());
    number(&mut bytes, json.len());
    bytes.extend(b"JSON");
    bytes.extend(json);
    number(&mut bytes, bin.len());
    bytes.extend(b"BIN\0");
    bytes.extend(bin);
    bytes
}

/// The cube in one binary file.
pub fn cube_glb(placing: &str) -> Vec<u8> {
    glb(&cube_json(placing, None), &cube_bin())
}

/// The bytes of the cube as text.
pub fn data_uri() -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    // 132 bytes are a multiple of three: nothing is left to pad.
    let encoded: String = cube_bin()
        .chunks_exact(3)
        .flat_map(|c| {
            let bits = u32::from(c[0]) << 16 | u32::from(c[1]) << 8 | u32::from(c[2]);
            [18, 12, 6, 0].map(|shift| char::from(LETTERS[(bits >> shift & 63) as usize]))
        })
        .collect();
    format!("data:application/octet-stream;base64,{encoded}")
}
