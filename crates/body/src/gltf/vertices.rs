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

/// The transforms of a skin's joints at rest, from the space of its mesh to the world; at least one.
pub(super) fn world_from_mesh_by_joint(
    skin: &Skin,
    world_from_node: &[Mat4],
    buffers: &Buffers,
) -> Result<Vec<Mat4>, Refusal> {
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
    let joint_from_mesh = inverse.iter().map(Mat4::from_cols_array);
    Ok(joints.iter().zip(joint_from_mesh).map(|(joint, own)| world_from_node[*joint] * own).collect())
}

/// True for a sum of weights that carries a vertex.
fn is_weight(total: f32) -> bool {
    total > 0.0 && total.is_finite()
}

/// Transforms of vertices: one for all, or one for each.
pub(super) enum Placement {
    Whole(Mat4),
    Each(Vec<Mat4>),
}

impl Placement {
    /// The placement of a part of a skinned mesh: its node's own transform does not count.
    /// `None` where the part has no joints. Counts vertices without weights. // glTF 2.0 §3.7.3.3
    pub fn skinned(
        part: &Primitive,
        count: usize,
        world_from_mesh: &[Mat4],
        buffers: &Buffers,
        weightless: &mut usize,
    ) -> Result<Option<Self>, Refusal> {
        let mut sums = vec![(Mat4::ZERO, 0.0_f32); count];
        let mut is_skinned = false;
        for set in 0.. {
            let accessors = part.get(&Semantic::Joints(set)).zip(part.get(&Semantic::Weights(set)));
            let Some((joints, weights)) = accessors else { break };
            if set == SETS_LIMIT {
                return Err((
                    format!("more than {SETS_LIMIT} sets of joints"),
                    "fewer joints for each vertex",
                ));
            }
            is_skinned = true;
            let joints = buffers.joints(&joints, count)?;
            let kinds = [DataType::F32, DataType::U8, DataType::U16];
            let weights = buffers.numbers::<4>(&weights, &kinds, count)?;
            if joints.len() < count || weights.len() < count {
                return Err(("fewer joints or weights than vertices".to_owned(), "four for each vertex"));
            }
            for ((sum, total), (joints, weights)) in sums.iter_mut().zip(joints.iter().zip(&weights)) {
                for (joint, weight) in joints.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
                    let Some(transform) = world_from_mesh.get(*joint as usize) else {
                        let found = format!("the joint {joint} of {}", world_from_mesh.len());
                        return Err((found, "joints of the skin"));
                    };
                    *sum += *transform * *weight;
                    *total += weight;
                }
            }
        }
        if is_skinned {
            *weightless += sums.iter().filter(|(_, total)| !is_weight(*total)).count();
        }
        // Vertices without a weight are carried by the first joint.
        let placed = |(sum, total): (Mat4, f32)| {
            if is_weight(total) { sum * (1.0 / total) } else { world_from_mesh[0] }
        };
        Ok(is_skinned.then(|| Self::Each(sums.into_iter().map(placed).collect())))
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

/// The joints of every skin that a document's shown nodes use, read once.
pub(super) struct Skins(Vec<Option<Vec<Mat4>>>);

impl Skins {
    pub fn new(document: &Document) -> Self {
        Self(vec![None; document.skins().len()])
    }

    /// See [`world_from_mesh_by_joint`].
    pub fn joints(
        &mut self,
        skin: &Skin,
        world_from_node: &[Mat4],
        buffers: &Buffers,
    ) -> Result<&[Mat4], Refusal> {
        let slot = &mut self.0[skin.index()];
        match slot {
            Some(joints) => Ok(joints),
            None => Ok(slot.insert(world_from_mesh_by_joint(skin, world_from_node, buffers)?)),
        }
    }
}
