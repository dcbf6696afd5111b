//! Reading OBJ.

use std::borrow::Cow;
use std::io::BufRead;
use std::path::Path;

use glam::Vec3;
use strandline_base::whole_lines;

use crate::Mesh;
use crate::parsing::{Refusal, unit_normal};
use crate::part_names::Names;

/// The part that has a name, from the bytes of a file.
pub(crate) fn parse_part(bytes: &[u8], names: &mut Names) -> Result<Mesh, Refusal> {
    parse(&only(&whole_lines(bytes), names))
}

/// The file without the faces that have not the name asked for: that of their object, a group or the material.
fn only(bytes: &[u8], names: &mut Names) -> Vec<u8> {
    let mut kept = Vec::with_capacity(bytes.len());
    // Of the object, the group and the material.
    let mut is_asked = [false; 3];
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_whitespace();
        let place = match words.next() {
            Some("o") => 0,
            Some("g") => 1,
            Some("usemtl") => 2,
            Some("f") if !is_asked.contains(&true) => continue,
            _ => {
                kept.extend_from_slice(line);
                continue;
            }
        };
        let words: Vec<&str> = words.collect();
        // A name may hold spaces; a face may be in several groups.
        is_asked[place] = names.add(&words.join(" "));
        if place == 1 && words.len() > 1 {
            is_asked[place] |= words.iter().map(|word| names.add(word)).fold(false, |one, two| one | two);
        }
        kept.extend_from_slice(line);
    }
    kept
}

/// Reads the shape of a mesh from a text whose lines are whole, in its units; vertices without a normal get a zero one.
pub(crate) fn parse(text: &[u8]) -> Result<Mesh, Refusal> {
    let text = without_colors(text);
    let mut bytes = &*text;
    let refused = |found: String| (found, "a Wavefront OBJ file with vertices (v) and faces (f)");
    check_faces(&text).map_err(refused)?;
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..tobj::LoadOptions::default()
    };
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) = tobj::load_obj_buf(&mut bytes, &options, no_materials)
        .map_err(|error| refused(format!("an invalid line ({error})")))?;
    let mut mesh = Mesh::default();
    for model in &models {
        append(&mut mesh, &model.mesh);
    }
    Ok(mesh)
}

/// For each vertex of the mesh its place among the vertices (v) of the file, from 0, and the number of these.
pub(crate) fn order(bytes: &[u8]) -> Result<(Vec<u32>, usize), Refusal> {
    let text = whole_lines(bytes);
    let (mut numbered, mut count) = (Vec::with_capacity(text.len()), 0);
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        match line.trim_ascii_start() {
            [b'v', b' ' | b'\t', ..] => {
                // Single precision counts to 16 million, as many vertices as a file can hold.
                numbered.extend_from_slice(format!("v {count} 0 0\n").as_bytes());
                count += 1;
            }
            _ => numbered.extend_from_slice(line),
        }
    }
    Ok((parse(&numbered)?.positions.iter().map(|place| place.x as u32).collect(), count))
}

/// The text with three numbers for each vertex: colours behind them, which may be those of some vertices alone, are not
/// the parser's.
fn without_colors(text: &[u8]) -> Cow<'_, [u8]> {
    fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
        line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
    }
    let has_more = |line: &[u8]| words(line).next() == Some(b"v") && words(line).nth(4).is_some();
    let lines = || text.split_inclusive(|byte| *byte == b'\n');
    if !lines().any(has_more) {
        return Cow::Borrowed(text);
    }
    let mut plain = Vec::with_capacity(text.len());
    for line in lines() {
        if has_more(line) {
            words(line).take(4).for_each(|word| plain.extend(word.iter().chain(b" ")));
            plain.push(b'\n');
        } else {
            plain.extend_from_slice(line);
        }
    }
    Cow::Owned(plain)
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
        let line = line.map_err(|_| format!("bytes that are not text in line {number}"))?;
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
