//! Reading glTF 2.0: the shape of a file at rest, skins and morph targets in their default pose, and its motion.

mod address;
mod buffers;
mod clips;
mod document;
mod fault;
mod materials;
mod nodes;
mod pictures;
mod rig;
mod track;
mod vertices;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use ::gltf::mesh::{Mode, Primitive};
use ::gltf::{Document, Node};
use glam::Vec3;
use strandline_base::memory;

use crate::Mesh;
use crate::parsing::Refusal;
use crate::part_names::Names;
use buffers::{Buffers, load_buffers};
use clips::Clips;
use document::Parts;
pub(crate) use fault::Fault;
use materials::{Looks, Painter, Part};
use nodes::Nodes;
pub(crate) use rig::Rig;
use vertices::{Influences, Placement, Skins, Vertices, default_weights};

/// The most vertices and the most triangles of one body, and those of a small file.
const COUNT_LIMIT: usize = 16 << 20;
const LEAST_COUNT_LIMIT: usize = 1 << 16;

/// Reads a mesh, or the part of it that has a name, in the units of the file, all nodes in place; vertices without a
/// normal get a zero one. Without a folder no file beside it is read.
pub(crate) fn parse(
    bytes: &[u8],
    folder: Option<&Path>,
    names: Option<&mut Names>,
    notes: &mut Vec<String>,
) -> Result<Mesh, Refusal> {
    let file = File::open(bytes, folder)?;
    let nodes = Nodes::new(&file.document)?;
    file.mesh(&nodes, names, notes, &mut |_, _, _| Ok(()))
}

/// Reads a mesh as [`parse`] does, and its motion in a clip.
pub(crate) fn parse_moving(
    bytes: &[u8],
    folder: Option<&Path>,
    clip: &str,
    notes: &mut Vec<String>,
) -> Result<(Mesh, Rig), Fault> {
    let file = File::open(bytes, folder)?;
    let nodes = Nodes::new(&file.document)?;
    let tracks = file.clips.tracks(clip, &file.document, &file.buffers, notes)?;
    let mut rig = Rig::new(&nodes, tracks);
    rig.set_teleports(file.clips.teleports(clip)?);
    memory::check(&[rig.keys(), rig.need(&nodes.shown, file.buffers.limit)]).map_err(Fault::Memory)?;
    let add = &mut |node: &Node<'_>, part: &Primitive<'_>, influences| {
        rig.add(node, part, influences, &file.buffers)
    };
    let mesh = file.mesh(&nodes, None, notes, add)?;
    notes.extend(rig.unsearched());
    notes.extend(rig.inside_out().map(|(time, node)| {
        format!(
            "the clip turns what {node} carries inside out at {time:.2} s: hair stays outside of a body that is mirrored as \
             a whole, and lies within a part that is mirrored alone"
        )
    }));
    Ok((mesh, rig))
}

/// Reads the nodes of a file and their motion in a clip, without its mesh.
pub(crate) fn parse_nodes(
    bytes: &[u8],
    folder: Option<&Path>,
    clip: &str,
    notes: &mut Vec<String>,
) -> Result<Rig, Fault> {
    let file = File::open(bytes, folder)?;
    let nodes = Nodes::new(&file.document)?;
    let tracks = file.clips.tracks(clip, &file.document, &file.buffers, notes)?;
    let mut rig = Rig::new(&nodes, tracks);
    rig.set_teleports(file.clips.teleports(clip)?);
    notes.extend(rig.unsearched());
    Ok(rig)
}

/// Names of the clips of a file, in their order.
pub(crate) fn clip_names(bytes: &[u8]) -> Result<Vec<String>, Refusal> {
    Ok(document::document(bytes)?.clips.names())
}

/// A file with its buffers.
struct File {
    document: Document,
    clips: Clips,
    looks: Looks,
    buffers: Buffers,
    /// Its folder, where files beside it are read.
    folder: Option<PathBuf>,
}

/// Receives a part of a mesh with its node, and with the joints of its vertices where a skin carries it.
type Receiver<'a> = &'a mut dyn FnMut(&Node<'_>, &Primitive<'_>, Option<Influences>) -> Result<(), Refusal>;

impl File {
    fn open(bytes: &[u8], folder: Option<&Path>) -> Result<Self, Refusal> {
        let Parts { document, clips, looks, blob } = document::document(bytes)?;
        let held = load_buffers(&document, blob, folder)?;
        // Nodes that repeat a mesh make much of a small file: beyond what it could hold itself it is refused.
        let size = bytes.len() + held.iter().map(Vec::len).sum::<usize>();
        let buffers = Buffers::new(held, size.clamp(LEAST_COUNT_LIMIT, COUNT_LIMIT));
        Ok(Self { document, clips, looks, buffers, folder: folder.map(Path::to_owned) })
    }

    /// The mesh at rest; hands over each part of it, in the order of its vertices.
    fn mesh(
        &self,
        nodes: &Nodes<'_>,
        mut names: Option<&mut Names>,
        notes: &mut Vec<String>,
        each: Receiver<'_>,
    ) -> Result<Mesh, Refusal> {
        let (buffers, mut mesh) = (&self.buffers, Mesh::default());
        let mut skins = Skins::new(&self.document);
        let mut weightless = 0;
        // A part that is asked for by its name is not drawn.
        let painter = || Painter::new(&self.looks, &self.document, buffers, self.folder.as_deref());
        let mut painter = names.is_none().then(painter);
        for node in &nodes.shown {
            let Some(part) = node.mesh() else { continue };
            let joints = match node.skin() {
                Some(skin) => Some(skins.joints(&skin, &nodes.world_from_node, buffers)?),
                None => None,
            };
            let whole = Placement::Whole(nodes.world_from_node[node.index()]);
            for primitive in part.primitives() {
                if !is_asked(names.as_deref_mut(), [node.name(), part.name(), primitive.material().name()]) {
                    continue;
                }
                if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
                    continue;
                }
                let room = buffers.limit.saturating_sub(mesh.positions.len());
                let vertices = Vertices::new(&primitive, default_weights(node), buffers, room)?;
                let Some(vertices) = vertices else { continue };
                let count = vertices.positions.len();
                let influences = match joints {
                    Some(joints) => Influences::new(&primitive, count, joints.len(), buffers)?,
                    None => None,
                };
                let skinned = influences.as_ref().zip(joints);
                let skinned = skinned.map(|(influences, joints)| {
                    Placement::skinned(influences, count, joints, &mut weightless)
                });
                let first = [mesh.positions.len(), mesh.triangles.len()];
                append(&mut mesh, &primitive, &vertices, skinned.as_ref().unwrap_or(&whole), buffers)?;
                let (of, material) = ([part.index(), primitive.index()], primitive.material().index());
                painter.iter_mut().for_each(|painter| painter.add(&Part { of, material, first }, &mesh));
                each(node, &primitive, influences)?;
            }
        }
        mesh.materials = painter.and_then(|painter| painter.finish(&mesh, notes)).map(Arc::new);
        note_weightless(weightless, &mesh, notes);
        Ok(mesh)
    }
}

fn note_weightless(weightless: usize, mesh: &Mesh, notes: &mut Vec<String>) {
    if weightless > 0 {
        let count = mesh.positions.len();
        let (have, them) = if weightless == 1 { ("has", "it") } else { ("have", "them") };
        notes.push(format!(
            "{weightless} of {count} vertices {have} no weights of joints: the first joint of the skin carries {them}"
        ));
    }
}

/// Notes the names of a part; true where one of them is asked for, or none is.
fn is_asked(names: Option<&mut Names>, own: [Option<&str>; 3]) -> bool {
    let Some(names) = names else { return true };
    own.map(|name| name.is_some_and(|name| names.add(name))).contains(&true)
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
