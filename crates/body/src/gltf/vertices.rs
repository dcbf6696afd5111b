//! The vertices of a part of a glTF mesh at rest: morphed by default weights, then placed by a node or by joints.

use ::gltf::accessor::DataType;
use ::gltf::mesh::Primitive;
use ::gltf::{Document, Node, Semantic, Skin};
use glam::{Mat3, Mat4, Vec3};

use super::buffers::Buffers;
use crate::parsing::{Refusal, unit_normal};

/// Most vertices that the morph targets of a part may move, all targets together.
const MORPHED_LIMIT: usize = 16 << 20;
/// Most sets of four joints of a part; programs write two at most.
const SETS_LIMIT: u32 = 4;

/// Positions and normals of a part, in the space of its mesh; normals may be fewer, or none.
pub(super) struct Vertices {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
}

impl Vertices {
    /// Reads a part of at most `room` vertices and moves it by the weights of its morph targets; `None` for a part
    /// without positions.
    pub fn new(
        part: &Primitive,
        weights: &[f32],
        buffers: &Buffers,
        room: usize,
    ) -> Result<Option<Self>, Refusal> {
        let Some(accessor) = part.get(&Semantic::Positions) else { return Ok(None) };
        let count = accessor.count();
        if count > room {
            return Err((format!("more than {} vertices", buffers.limit), "a mesh for a body"));
        }
        let positions = buffers.vectors(&accessor, count)?;
        let normals = part.get(&Semantic::Normals);
        let normals = normals.map(|normals| buffers.vectors(&normals, count)).transpose()?;
        let mut vertices = Self { positions, normals: normals.unwrap_or_default() };
        let mut moved = 0;
        for (target, weight) in part.morph_targets().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            moved += vertices.positions.len();
            if moved > MORPHED_LIMIT {
                return Err((format!("more than {MORPHED_LIMIT} morphed vertices"), "fewer morph targets"));
            }
            for (deltas, own) in
                [(target.positions(), &mut vertices.positions), (target.normals(), &mut vertices.normals)]
            {
                let Some(deltas) = deltas else { continue };
                let deltas = buffers.vectors(&deltas, count)?;
                own.iter_mut().zip(deltas).for_each(|(own, delta)| *own += *weight * delta);
            }
        }
        Ok(Some(vertices))
    }
}

/// The weights of morph targets that a node gives to its mesh at rest.
pub(super) fn default_weights<'a>(node: &Node<'a>) -> &'a [f32] {
    let of_mesh = || node.mesh().and_then(|mesh| mesh.weights());
    node.weights().or_else(of_mesh).unwrap_or_default()
}

/// The joints of a skin, each with its inverse bind matrix; at least one.
pub(super) fn joints_of(skin: &Skin, buffers: &Buffers) -> Result<Vec<(usize, Mat4)>, Refusal> {
    let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    if joints.is_empty() {
        return Err((format!("skin {} without joints", skin.index()), "one joint at least"));
    }
    let inverse = match skin.inverse_bind_matrices() {
        Some(accessor) => buffers.numbers::<16>(&accessor, &[DataType::F32], joints.len())?,
        None => vec![Mat4::IDENTITY.to_cols_array(); joints.len()],
    };
    if inverse.len() < joints.len() {
        let found = format!("{} inverse bind matrices for {} joints", inverse.len(), joints.len());
        return Err((found, "one for each joint"));
    }
    Ok(joints.into_iter().zip(inverse.iter().map(Mat4::from_cols_array)).collect())
}

/// True for a sum of weights that carries a vertex.
fn is_weight(total: f32) -> bool {
    total > 0.0 && total.is_finite()
}

/// Joints of the vertices of a part with their weights, as the file has them: sets of four, shape `[set][vertex]`.
#[derive(Debug)]
pub(super) struct Influences(Vec<Vec<Set>>);

/// Four joints of a vertex, and their weights.
type Set = ([u32; 4], [f32; 4]);

impl Influences {
    /// The joints of a part of a skinned mesh, all of them among the `joints` of its skin; `None` where it has none.
    pub fn new(
        part: &Primitive,
        count: usize,
        joints: usize,
        buffers: &Buffers,
    ) -> Result<Option<Self>, Refusal> {
        let mut sets = Vec::new();
        for set in 0.. {
            let accessors = part.get(&Semantic::Joints(set)).zip(part.get(&Semantic::Weights(set)));
            let Some((indices, weights)) = accessors else { break };
            if set == SETS_LIMIT {
                return Err((
                    format!("more than {SETS_LIMIT} sets of joints"),
                    "fewer joints for each vertex",
                ));
            }
            let indices = buffers.joints(&indices, count)?;
            let kinds = [DataType::F32, DataType::U8, DataType::U16];
            let weights = buffers.numbers::<4>(&weights, &kinds, count)?;
            if indices.len() < count || weights.len() < count {
                return Err(("fewer joints or weights than vertices".to_owned(), "four for each vertex"));
            }
            let set: Vec<Set> = indices.into_iter().zip(weights).collect();
            let beyond = |(joint, weight): (&u32, &f32)| *weight > 0.0 && *joint as usize >= joints;
            for (indices, weights) in &set {
                if let Some((joint, _)) = indices.iter().zip(weights).find(|pair| beyond(*pair)) {
                    return Err((format!("the joint {joint} of {joints}"), "joints of the skin"));
                }
            }
            sets.push(set);
        }
        Ok((!sets.is_empty()).then_some(Self(sets)))
    }

    /// Joints of a vertex with their shares of it; without a sum of weights the first joint carries it.
    pub fn shares(&self, vertex: usize) -> impl Iterator<Item = (usize, f32)> {
        let weighted = move || {
            let of_set = move |set: &Vec<Set>| {
                let (indices, weights) = set[vertex];
                indices.into_iter().zip(weights).filter(|(_, weight)| *weight > 0.0)
            };
            self.0.iter().flat_map(of_set)
        };
        let total: f32 = weighted().map(|(_, weight)| weight).sum();
        let first = (!is_weight(total)).then_some((0, 1.0));
        let shares = weighted().filter(move |_| is_weight(total));
        first.into_iter().chain(shares.map(move |(joint, weight)| (joint as usize, weight / total)))
    }

    /// The transform of a vertex, and the sum of its weights; without a sum of weights the first joint carries it.
    pub fn transform(&self, vertex: usize, joints: &[Mat4]) -> (Mat4, f32) {
        let (mut sum, mut total) = (Mat4::ZERO, 0.0_f32);
        for set in &self.0 {
            let (indices, weights) = set[vertex];
            for (joint, weight) in indices.into_iter().zip(weights).filter(|(_, weight)| *weight > 0.0) {
                sum += joints[joint as usize] * weight;
                total += weight;
            }
        }
        (if is_weight(total) { sum * (1.0 / total) } else { joints[0] }, total)
    }
}

/// Transforms of vertices: one for all, or one for each.
pub(super) enum Placement {
    Whole(Mat4),
    Each(Vec<Mat4>),
}

impl Placement {
    /// The placement of a part of a skinned mesh: its node's own transform does not count.
    /// Counts vertices without weights. // glTF 2.0 §3.7.3.3
    pub fn skinned(
        influences: &Influences,
        count: usize,
        world_from_mesh: &[Mat4],
        weightless: &mut usize,
    ) -> Self {
        let placed = |vertex| {
            let (transform, total) = influences.transform(vertex, world_from_mesh);
            *weightless += usize::from(!is_weight(total));
            transform
        };
        Self::Each((0..count).map(placed).collect())
    }

    fn of(&self, vertex: usize) -> &Mat4 {
        match self {
            Self::Whole(transform) => transform,
            Self::Each(transforms) => &transforms[vertex],
        }
    }

    /// Positions in the world.
    pub fn positions(&self, positions: &[Vec3]) -> Vec<Vec3> {
        positions.iter().enumerate().map(|(at, position)| self.of(at).transform_point3(*position)).collect()
    }

    /// Unit normals in the world, turned by the inverse transpose.
    pub fn normals(&self, normals: &[Vec3]) -> Vec<Vec3> {
        let turned = |transform: &Mat4, normal: Vec3| {
            unit_normal(Mat3::from_mat4(*transform).inverse().transpose() * unit_normal(normal))
        };
        normals.iter().enumerate().map(|(at, normal)| turned(self.of(at), *normal)).collect()
    }

    /// Tells triangles that are turned over: a mirror image of their corners.
    pub fn is_mirrored(&self, corners: [u32; 3]) -> bool {
        let determinant = |corner: u32| Mat3::from_mat4(*self.of(corner as usize)).determinant();
        corners.map(determinant).iter().sum::<f32>() < 0.0
    }
}

/// Transforms of the joints of every skin that a document's shown nodes use, each read once.
pub(super) struct Skins(Vec<Option<Vec<Mat4>>>);

impl Skins {
    pub fn new(document: &Document) -> Self {
        Self(vec![None; document.skins().len()])
    }

    /// The transforms of a skin's joints at rest, from the space of its mesh to the world; at least one.
    pub fn joints(
        &mut self,
        skin: &Skin,
        world_from_node: &[Mat4],
        buffers: &Buffers,
    ) -> Result<&[Mat4], Refusal> {
        let slot = &mut self.0[skin.index()];
        match slot {
            Some(joints) => Ok(joints),
            None => {
                let joints = joints_of(skin, buffers)?;
                Ok(slot.insert(joints.iter().map(|(joint, own)| world_from_node[*joint] * *own).collect()))
            }
        }
    }
}
