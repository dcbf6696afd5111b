//! Reading OBJ.

use std::io::BufRead;
use std::path::Path;

use glam::Vec3;

use crate::parsing::{Refusal, read_file, unit_normal};
use crate::{BodyError, Mesh};

/// Reads a mesh in the units of the file; vertices without a normal get a zero one.
pub(crate) fn read(path: &Path) -> Result<Mesh, BodyError> {
    let bytes = read_file(path)?;
    parse(&bytes).map_err(|(found, expected)| BodyError::Mesh {
        path: path.into(),
        found,
        expected,
        mend: "export the body again",
    })
}

/// The same from the bytes of a file.
pub(crate) fn parse(mut bytes: &[u8]) -> Result<Mesh, Refusal> {
    let refused = |found: String| (found, "a Wavefront OBJ file with vertices (v) and faces (f)");
    check_faces(bytes).map_err(refused)?;
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..tobj::LoadOptions::default()
    };
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) = tobj::load_obj_buf(&mut bytes, &options, no_materials)
        .map_err(|error| refused(format!("a line that is none ({error})")))?;
    let mut mesh = Mesh::default();
    for model in &models {
        append(&mut mesh, &model.mesh);
    }
    Ok(mesh)
}

fn append(mesh: &mut Mesh, part: &tobj::Mesh) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(part.positions.chunks_exact(3).map(Vec3::from_slice));
    mesh.triangles.extend(part.indices.chunks_exact(3).map(|c| [first + c[0], first + c[1], first + c[2]]));
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    // A vertex with several normals gets their mean: heads have no sharp edges.
    for (vertex, normal) in part.indices.iter().zip(&part.normal_indices) {
        if let Some(normal) = part.normals.chunks_exact(3).nth(*normal as usize) {
            mesh.normals[(first + vertex) as usize] += unit_normal(Vec3::from_slice(normal));
        }
    }
}

/// Refuses faces whose indices the parser could not count with, and names their line.
fn check_faces(bytes: &[u8]) -> Result<(), String> {
    // Positions, texture coordinates and normals so far, in the order of a face's indices.
    let mut counts = [0i64; 3];
    for (number, line) in bytes.lines().enumerate() {
        let number = number + 1;
        let line = line.map_err(|_| format!("bytes that are no text in line {number}"))?;
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => counts[0] += 1,
            Some("vt") => counts[1] += 1,
            Some("vn") => counts[2] += 1,
            Some("f" | "l") => {
                for word in words {
                    check_corner(word, counts).map_err(|what| format!("{what} in line {number}"))?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn check_corner(word: &str, counts: [i64; 3]) -> Result<(), String> {
    let indices: Vec<&str> = word.split('/').collect();
    if indices.len() > 3 {
        return Err(format!("the face corner `{word}`"));
    }
    for (place, (text, count)) in indices.iter().zip(counts).enumerate() {
        if text.is_empty() && place > 0 {
            continue;
        }
        let index: i64 = text.parse().map_err(|_| format!("the face corner `{word}`"))?;
        // Indices count from 1, or back from the last with a minus; a face may precede its vertices.
        if index == 0 || index < -count || index > i64::from(u32::MAX) {
            return Err(format!("the index {index}, of {count} so far,"));
        }
    }
    Ok(())
}
