//! Reading meshes of `.ply` files: head scans and reconstructions.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::ply::{self, Column, Table};

use crate::parsing::{Refusal, linear_light, unit_normal};
use crate::{Materials, Mesh};

/// Names of the list of a face's corners: both are common.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];
/// Number between two strips of triangles in one list.
const END_OF_STRIP: f64 = -1.0;

/// Reads a mesh from the bytes of a file, in its units; polygons become fans of triangles, strips of triangles their
/// triangles, vertices without a normal get a zero one.
pub(crate) fn parse(bytes: &[u8], notes: &mut Vec<String>) -> Result<Mesh, Refusal> {
    const EXPECTED: &str = "a PLY file with vertices (x, y, z) and faces or tristrips (vertex_indices)";
    let of_vertices = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"];
    let asked: [(&str, &[&str]); 3] = [("vertex", &of_vertices), ("face", &CORNERS), ("tristrips", &CORNERS)];
    let file = ply::read(bytes, asked)
        .map_err(|mismatch| (format!("{}, expected {},", mismatch.found, mismatch.expected), EXPECTED))?;
    let [vertices, faces, strips] = &file.tables;
    let positions = vertices.triples(["x", "y", "z"]);
    let positions = positions.ok_or_else(|| ("no coordinates of vertices".to_owned(), EXPECTED))?;
    let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from_array).collect();
    let normals = vertices.triples(["nx", "ny", "nz"]);
    let normals = normals.into_iter().flatten().map(|normal| unit_normal(Vec3::from_array(normal)));
    let mut triangles = triangles(faces, positions.len())?;
    triangles.extend(triangles_of_strips(strips, positions.len())?);
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
    let Some(corners) = corners(faces) else { return Ok(triangles) };
    for face in corners.lists() {
        check(face, count)?;
        let rim = face.get(1..).unwrap_or_default();
        triangles.extend(rim.windows(2).map(|pair| [face[0], pair[0], pair[1]].map(|corner| corner as u32)));
    }
    Ok(triangles)
}

/// Triangles of strips, the form of some laboratories' scans: each corner makes a triangle with the two before it, every
/// second one turned round. A triangle that repeats a corner only leads the strip elsewhere.
fn triangles_of_strips(strips: &Table, count: usize) -> Result<Vec<[u32; 3]>, Refusal> {
    let mut triangles = Vec::new();
    let Some(corners) = corners(strips) else { return Ok(triangles) };
    for strip in corners.lists().flat_map(|list| list.split(|corner| *corner == END_OF_STRIP)) {
        check(strip, count)?;
        for (place, corners) in strip.windows(3).enumerate() {
            let [one, two, three] = [corners[0], corners[1], corners[2]].map(|corner| corner as u32);
            if one != two && two != three && three != one {
                triangles.push(if place % 2 == 0 { [one, two, three] } else { [two, one, three] });
            }
        }
    }
    Ok(triangles)
}

fn corners(table: &Table) -> Option<&Column> {
    CORNERS.iter().find_map(|name| table.list(name))
}

/// Refuses corners that are no vertices.
fn check(corners: &[f64], count: usize) -> Result<(), Refusal> {
    match corners.iter().find(|corner| !(0.0..count as f64).contains(*corner)) {
        Some(corner) => Err((format!("a face with the vertex {corner} of {count}"), "indices in range")),
        None => Ok(()),
    }
}
