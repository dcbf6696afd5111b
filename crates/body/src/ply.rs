//! Reading meshes of `.ply` files: head scans and reconstructions.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::ply::{self, Table};

use crate::parsing::{Refusal, linear_light, unit_normal};
use crate::{Materials, Mesh};

/// Names of the list of a face's corners: both are common.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads a mesh from the bytes of a file, in its units; polygons become fans of triangles, vertices without a normal
/// get a zero one.
pub(crate) fn parse(bytes: &[u8], notes: &mut Vec<String>) -> Result<Mesh, Refusal> {
    const EXPECTED: &str = "a PLY file with vertices (x, y, z) and faces (vertex_indices)";
    let of_vertices = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"];
    let asked: [(&str, &[&str]); 2] = [("vertex", &of_vertices), ("face", &CORNERS)];
    let file = ply::read(bytes, asked)
        .map_err(|mismatch| (format!("{}, expected {},", mismatch.found, mismatch.expected), EXPECTED))?;
    let [vertices, faces] = &file.tables;
    let positions = vertices.triples(["x", "y", "z"]);
    let positions = positions.ok_or_else(|| ("no coordinates of vertices".to_owned(), EXPECTED))?;
    let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from_array).collect();
    let normals = vertices.triples(["nx", "ny", "nz"]);
    let normals = normals.into_iter().flatten().map(|normal| unit_normal(Vec3::from_array(normal)));
    let triangles = triangles(faces, positions.len())?;
    let mut mesh = Mesh { normals: normals.collect(), triangles, positions, ..Mesh::default() };
    if mesh.triangles.is_empty() {
        return Err((format!("{} points and no faces", mesh.positions.len()), EXPECTED));
    }
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    if let Some(colors) = vertices.triples(["red", "green", "blue"]) {
        let most = if vertices.is_byte("red") { 255.0 } else { 1.0 };
        let colors = colors.into_iter().map(|color| linear_light(Vec3::from_array(color) / most).extend(1.0));
        let materials = Materials::of_vertices(colors.collect(), mesh.triangles.len());
        mesh.materials = materials.drawn(notes).map(Arc::new);
    }
    Ok(mesh)
}

/// The triangles of all faces.
fn triangles(faces: &Table, count: usize) -> Result<Vec<[u32; 3]>, Refusal> {
    let mut triangles = Vec::new();
    let Some(corners) = CORNERS.iter().find_map(|name| faces.list(name)) else { return Ok(triangles) };
    for face in corners.lists() {
        if let Some(corner) = face.iter().find(|corner| !(0.0..count as f64).contains(*corner)) {
            return Err((format!("a face with the vertex {corner} of {count}"), "indices in range"));
        }
        let rim = face.get(1..).unwrap_or_default();
        triangles.extend(rim.windows(2).map(|pair| [face[0], pair[0], pair[1]].map(|corner| corner as u32)));
    }
    Ok(triangles)
}
