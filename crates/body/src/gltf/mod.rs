//! Reading glTF 2.0: the shape of a file at rest, skins and morph targets in their default pose.

mod address;
mod buffers;
mod document;
mod nodes;
mod vertices;

use std::path::Path;

use ::gltf::mesh::{Mode, Primitive};
use glam::Vec3;

use crate::Mesh;
use crate::parsing::Refusal;
use crate::part_names::Names;
use buffers::{Buffers, load_buffers};
use nodes::Nodes;
use vertices::{Placement, Skins, Vertices, default_weights};

/// The most vertices and the most triangles of one body, and those of a small file.
const COUNT_LIMIT: usize = 16 << 20;
const LEAST_COUNT_LIMIT: usize = 1 << 16;

/// Reads a mesh, or the part of it that has a name, in the units of the file, all nodes in place; vertices without a
/// normal get a zero one. Without a folder no file beside it is read.
pub(crate) fn parse(
    bytes: &[u8],
    folder: Option<&Path>,
    mut names: Option<&mut Names>,
    notes: &mut Vec<String>,
) -> Result<Mesh, Refusal> {
    let (document, blob) = document::document(bytes)?;
    let held = load_buffers(&document, blob, folder)?;
    // Nodes that repeat a mesh make much of a small file: beyond what it could hold itself it is refused.
    let size = bytes.len() + held.iter().map(Vec::len).sum::<usize>();
    let buffers = Buffers::new(held, size.clamp(LEAST_COUNT_LIMIT, COUNT_LIMIT));
    let mut mesh = Mesh::default();
    let nodes = Nodes::new(&document)?;
    let mut skins = Skins::new(&document);
    let mut weightless = 0;
    for node in &nodes.shown {
        let Some(part) = node.mesh() else { continue };
        let joints = match node.skin() {
            Some(skin) => Some(skins.joints(&skin, &nodes.world_from_node, &buffers)?),
            None => None,
        };
        let whole = Placement::Whole(nodes.world_from_node[node.index()]);
        for primitive in part.primitives() {
            if let Some(names) = &mut names {
                let own = [node.name(), part.name(), primitive.material().name()];
                let is_asked = own.map(|name| name.is_some_and(|name| names.add(name)));
                if !is_asked.contains(&true) {
                    continue;
                }
            }
            if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
                continue;
            }
            let room = buffers.limit.saturating_sub(mesh.positions.len());
            let vertices = Vertices::new(&primitive, default_weights(node), &buffers, room)?;
            let Some(vertices) = vertices else { continue };
            let skinned = match joints {
                Some(joints) => {
                    let count = vertices.positions.len();
                    Placement::skinned(&primitive, count, joints, &buffers, &mut weightless)?
                }
                None => None,
            };
            append(&mut mesh, &primitive, &vertices, skinned.as_ref().unwrap_or(&whole), &buffers)?;
        }
    }
    if weightless > 0 {
        notes.push(format!(
            "{weightless} of {} vertices have no weights of joints: the first joint of their skin carries them",
            mesh.positions.len()
        ));
    }
    Ok(mesh)
}

fn append(
    mesh: &mut Mesh,
    part: &Primitive,
    vertices: &Vertices,
    placement: &Placement,
    buffers: &Buffers,
) -> Result<(), Refusal> {
    let (count, limit) = (vertices.positions.len(), buffers.limit);
    let corners = match part.indices() {
        Some(indices) => buffers.indices(&indices)?,
        None => (0..count as u32).collect(),
    };
    let first = mesh.positions.len();
    if first + count > limit || mesh.triangles.len() + corners.len() > limit {
        return Err((format!("more than {limit} vertices or triangles"), "a mesh for a body"));
    }
    if corners.iter().any(|corner| *corner as usize >= count) {
        return Err((format!("an index beyond the {count} vertices"), "indices in range"));
    }
    mesh.positions.extend(placement.positions(&vertices.positions));
    mesh.normals.extend(placement.normals(&vertices.normals[..vertices.normals.len().min(count)]));
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    mesh.triangles.extend(triangles(part.mode(), &corners).map(|corners| {
        let [a, b, c] = corners;
        let turned = if placement.is_mirrored(corners) { [a, c, b] } else { corners };
        turned.map(|corner| first as u32 + corner)
    }));
    Ok(())
}

fn triangles(mode: Mode, corners: &[u32]) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
    match mode {
        Mode::TriangleStrip => Box::new(corners.windows(3).enumerate().map(|(index, c)| {
            // Every second triangle of a strip is wound the other way.
            if index % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] }
        })),
        Mode::TriangleFan => {
            let center = corners.first().copied().unwrap_or_default();
            let rim = corners.get(1..).unwrap_or_default();
            Box::new(rim.windows(2).map(move |pair| [center, pair[0], pair[1]]))
        }
        _ => Box::new(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]])),
    }
}
