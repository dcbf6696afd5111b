//! Positions of the vertices of a rig at a time of its clip.

use std::borrow::Cow;
use std::ops::Range;

use glam::{DMat4, Mat4, Vec3};

use super::{Influences, Part, Rig};
use crate::teleports::Teleports;

/// Transforms of the vertices of a part.
enum Carried<'a> {
    /// The transforms of the joints, and the shares of the vertices in them.
    Skin(&'a Influences, Vec<Mat4>),
    /// The transform of the node.
    Node(Mat4),
}

impl Carried<'_> {
    /// The place of a vertex, given after morphing from the middle of its part.
    fn place(&self, vertex: usize, position: Vec3) -> Vec3 {
        match self {
            Self::Skin(influences, joints) => {
                influences.transform(vertex, joints).0.transform_point3(position)
            }
            Self::Node(transform) => transform.transform_point3(position),
        }
    }
}

impl Rig {
    /// Positions of all vertices in the units of the file, in the order of the mesh, at a time of the clip \[s\], held
    /// before its first key and after its last; without a time at rest. Nothing is interpolated over marks.
    pub fn positions(&self, time: Option<f64>, teleports: &Teleports) -> Vec<Vec3> {
        let mut positions = Vec::with_capacity(self.vertex_count());
        self.for_each_part(time, teleports, |part, _, carried, weights| {
            let morphed = part.morphed(weights);
            positions.extend(morphed.iter().enumerate().map(|(vertex, place)| carried.place(vertex, *place)));
        });
        self.placed.add(positions.len() as u64);
        positions
    }

    /// The same of the vertices of these indices alone.
    pub fn places(&self, time: Option<f64>, teleports: &Teleports, vertices: &[u32]) -> Vec<Vec3> {
        let mut places = vec![Vec3::ZERO; vertices.len()];
        self.for_each_part(time, teleports, |part, range, carried, weights| {
            for (vertex, place) in vertices.iter().zip(&mut places) {
                let vertex = *vertex as usize;
                if range.contains(&vertex) {
                    let own = vertex - range.start;
                    *place = carried.place(own, part.morphed_vertex(own, weights));
                }
            }
        });
        self.placed.add(places.len() as u64);
        places
    }

    /// Visits each part with the indices of its vertices, their transforms and the weights of its targets.
    fn for_each_part(
        &self,
        time: Option<f64>,
        teleports: &Teleports,
        mut visit: impl FnMut(&Part, Range<usize>, Carried<'_>, &[f64]),
    ) {
        let pose = self.pose(time, teleports);
        let joints: Vec<Vec<DMat4>> = (self.skins.iter())
            .map(|skin| {
                let placed = |(joint, own): &(usize, DMat4)| pose.world_from_node[*joint] * *own;
                skin.iter().flatten().map(placed).collect()
            })
            .collect();
        let mut first = 0;
        for part in &self.parts {
            let range = first..first + part.base.len();
            first = range.end;
            let carried = match &part.skin {
                Some((skin, influences)) => {
                    Carried::Skin(influences, joints[*skin].iter().map(|joint| part.amid(joint)).collect())
                }
                None => Carried::Node(part.amid(&pose.world_from_node[part.node])),
            };
            visit(part, range, carried, &pose.weights[part.node]);
        }
    }

    /// Number of vertices placed so far.
    pub fn placed_count(&self) -> u64 {
        self.placed.count()
    }
}

impl Part {
    /// The transform of positions from the middle, rounded once: far from the origin of the mesh its parts cancel.
    fn amid(&self, transform: &DMat4) -> Mat4 {
        let place = transform.transform_point3(self.middle);
        DMat4 { w_axis: place.extend(1.0), ..*transform }.as_mat4()
    }

    /// Positions after morphing, from the middle.
    fn morphed(&self, weights: &[f64]) -> Cow<'_, [Vec3]> {
        let mut morphed = Cow::Borrowed(&self.base[..]);
        for (target, moved) in &self.targets {
            let weight = weight(weights, *target);
            if weight != 0.0 {
                let positions = morphed.to_mut();
                moved.iter().for_each(|(vertex, delta)| positions[*vertex as usize] += weight * *delta);
            }
        }
        morphed
    }

    /// The same of one vertex.
    fn morphed_vertex(&self, vertex: usize, weights: &[f64]) -> Vec3 {
        let mut position = self.base[vertex];
        for (target, moved) in &self.targets {
            let (weight, own) = (weight(weights, *target), vertex as u32);
            if weight != 0.0
                && let Ok(index) = moved.binary_search_by_key(&own, |(vertex, _)| *vertex)
            {
                position += weight * moved[index].1;
            }
        }
        position
    }
}

/// Weight of a morph target.
fn weight(weights: &[f64], target: usize) -> f32 {
    weights.get(target).map_or(0.0, |weight| *weight as f32)
}
