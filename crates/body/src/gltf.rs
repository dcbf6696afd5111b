//! Reading glTF 2.0.

use std::path::{Path, PathBuf};

use ::gltf::Semantic;
use ::gltf::mesh::{Mode, Primitive};
use glam::{Mat3, Mat4, Vec3};

use crate::gltf_buffers::{Buffers, load_buffers};
use crate::parsing::{Refusal, read_file, unit_normal};
use crate::part_names::Names;
use crate::{BodyError, Mesh};

/// The most vertices and the most triangles of one body, and those of a small file.
const COUNT_LIMIT: usize = 16 << 20;
const LEAST_COUNT_LIMIT: usize = 1 << 16;
/// The deepest nesting of nodes.
const DEPTH_LIMIT: usize = 64;

/// Reads a mesh, or the part of it that has a name, in the units of the file, all nodes in place; vertices without a
/// normal get a zero one.
pub(crate) fn read(path: &Path, names: Option<&mut Names>) -> Result<Mesh, BodyError> {
    let bytes = read_file(path)?;
    parse(&bytes, path.parent(), names).map_err(|(found, expected)| BodyError::Mesh {
        path: PathBuf::from(path),
        found,
        expected,
        mend: "export the body again as plain glTF 2.0 (no compression), or as OBJ",
    })
}

/// The same from the bytes of a file; without a folder no file beside it is read.
pub(crate) fn parse(
    bytes: &[u8],
    folder: Option<&Path>,
    mut names: Option<&mut Names>,
) -> Result<Mesh, Refusal> {
    check_container(bytes)?;
    let refused = |error: ::gltf::Error| (format!("bad glTF ({error})"), "valid glTF 2.0");
    check_positions(&::gltf::Gltf::from_slice_without_validation(bytes).map_err(refused)?.document)?;
    let ::gltf::Gltf { document, blob } = ::gltf::Gltf::from_slice(bytes).map_err(refused)?;
    let buffers = load_buffers(&document, blob, folder)?;
    // Nodes that repeat a mesh make much of a small file: more than it could hold itself is refused.
    let limit = (bytes.len() + buffers.len()).clamp(LEAST_COUNT_LIMIT, COUNT_LIMIT);
    let mut mesh = Mesh::default();
    for (node, world_from_node) in placed_nodes(&document)? {
        let Some(part) = node.mesh() else { continue };
        for primitive in part.primitives() {
            if let Some(names) = &mut names {
                let own = [node.name(), part.name(), primitive.material().name()];
                let is_asked = own.map(|name| name.is_some_and(|name| names.add(name)));
                if !is_asked.contains(&true) {
                    continue;
                }
            }
            append(&mut mesh, &primitive, world_from_node, &buffers, limit)?;
        }
    }
    Ok(mesh)
}

/// A binary file says its own length, which the parser subtracts from without a look.
fn check_container(bytes: &[u8]) -> Result<(), Refusal> {
    if !bytes.starts_with(b"glTF") {
        return Ok(());
    }
    let stated = bytes.get(8..12).and_then(|field| field.try_into().ok()).map(u32::from_le_bytes);
    match stated {
        Some(length) if length >= 12 && length as usize <= bytes.len() => Ok(()),
        Some(length) => {
            Err((format!("a file of {} bytes that says it has {length}", bytes.len()), "the whole file"))
        }
        None => Err((format!("a file of {} bytes", bytes.len()), "a header of 12 bytes")),
    }
}

/// The parser's own validation looks up the accessor of the positions before it knows that it exists.
fn check_positions(document: &::gltf::Document) -> Result<(), Refusal> {
    let root = document.as_json();
    let parts = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    for accessor in parts.flat_map(|part| part.attributes.values()) {
        if accessor.value() >= root.accessors.len() {
            let found = format!("the accessor {} of {}", accessor.value(), root.accessors.len());
            return Err((found, "accessors in range"));
        }
    }
    Ok(())
}

/// All nodes with their transforms, parents first.
fn placed_nodes(document: &::gltf::Document) -> Result<Vec<(::gltf::Node<'_>, Mat4)>, Refusal> {
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children()) {
        if std::mem::replace(&mut is_child[child.index()], true) {
            return Err((format!("node {} below two others", child.index()), "a tree of nodes"));
        }
    }
    let mut placed = Vec::new();
    // Every node is below one other at most: the walk from the roots meets each once and ends.
    let mut waiting: Vec<_> = document
        .nodes()
        .filter(|node| !is_child[node.index()])
        .map(|node| (node, Mat4::IDENTITY, 0))
        .collect();
    while let Some((node, world_from_parent, depth)) = waiting.pop() {
        if depth > DEPTH_LIMIT {
            return Err((format!("node {} more than {DEPTH_LIMIT} deep", node.index()), "fewer levels"));
        }
        let world_from_node = world_from_parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        waiting.extend(node.children().map(|child| (child, world_from_node, depth + 1)));
        placed.push((node, world_from_node));
    }
    placed.sort_by_key(|(node, _)| node.index());
    Ok(placed)
}

fn append(
    mesh: &mut Mesh,
    part: &Primitive,
    world_from_node: Mat4,
    buffers: &Buffers,
    limit: usize,
) -> Result<(), Refusal> {
    if !matches!(part.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(());
    }
    let Some(positions) = part.get(&Semantic::Positions) else { return Ok(()) };
    let positions = buffers.vectors(&positions)?;
    let corners = match part.indices() {
        Some(indices) => buffers.indices(&indices)?,
        None => (0..positions.len() as u32).collect(),
    };
    let first = mesh.positions.len();
    if first + positions.len() > limit || mesh.triangles.len() + corners.len() > limit {
        return Err((format!("more than {limit} vertices or triangles"), "a mesh for a body"));
    }
    if let Some(corner) = corners.iter().find(|corner| **corner as usize >= positions.len()) {
        return Err((format!("the index {corner} of {} vertices", positions.len()), "indices in range"));
    }
    let normals = match part.get(&Semantic::Normals) {
        Some(normals) => buffers.vectors(&normals)?,
        None => Vec::new(),
    };
    // Normals turn with the inverse transpose; a mirror image turns the triangles over.
    let linear = Mat3::from_mat4(world_from_node);
    let world_from_normal = linear.inverse().transpose();
    mesh.positions.extend(positions.iter().map(|position| world_from_node.transform_point3(*position)));
    let placed = |normal: &Vec3| unit_normal(world_from_normal * unit_normal(*normal));
    mesh.normals.extend(normals.iter().take(positions.len()).map(placed));
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    let is_mirrored = linear.determinant() < 0.0;
    mesh.triangles.extend(triangles(part.mode(), &corners).map(|[a, b, c]| {
        let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
        [a, b, c].map(|corner| first as u32 + corner)
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
