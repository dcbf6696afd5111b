//! Finding and closing the holes of a mesh.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::Mesh;

/// An edge of a triangle, in the triangle's direction, between welded vertices.
type Edge = [u32; 2];

/// The edges that no triangle shares in the opposite direction, sorted.
///
/// They form closed rims: every vertex is left by as many as arrive.
pub(crate) fn open_edges(mesh: &Mesh) -> Vec<Edge> {
    let welded = welded_vertices(&mesh.positions);
    let mut edges: Vec<(Edge, bool)> = Vec::with_capacity(mesh.triangles.len() * 3);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| welded[corner as usize]);
        for [start, end] in [[a, b], [b, c], [c, a]] {
            if start != end {
                edges.push(([start.min(end), start.max(end)], start < end));
            }
        }
    }
    edges.sort_unstable();
    let mut open = Vec::new();
    for group in edges.chunk_by(|one, other| one.0 == other.0) {
        let [low, high] = group[0].0;
        let forward = group.iter().filter(|(_, forward)| *forward).count();
        let backward = group.len() - forward;
        open.extend((backward..forward).map(|_| [low, high]));
        open.extend((forward..backward).map(|_| [high, low]));
    }
    open.sort_unstable();
    open
}

/// The mesh with a fan of triangles over every hole.
pub(crate) fn close(mesh: &Mesh) -> Mesh {
    let mut closed = mesh.clone();
    for rim in rims(&open_edges(mesh)) {
        let middle = rim_middle(&mesh.positions, &rim);
        let center = closed.positions.len() as u32;
        closed.positions.push(middle);
        let mut normal = Vec3::ZERO;
        for [start, end] in &rim {
            closed.triangles.push([*end, *start, center]);
            let [a, b] = [start, end].map(|vertex| mesh.positions[*vertex as usize] - middle);
            normal += b.cross(a);
        }
        closed.normals.push(normal.normalize_or(Vec3::Y));
    }
    closed
}

/// For each vertex the first one at its exact position. The map is only looked up, never walked, so its
/// order does not matter.
pub(crate) fn welded_vertices(positions: &[Vec3]) -> Vec<u32> {
    let mut first_at = HashMap::with_capacity(positions.len());
    let welded = positions.iter().enumerate().map(|(index, position)| {
        // Adding zero makes -0 equal to 0 in bits too.
        let bits = (*position + 0.0).to_array().map(f32::to_bits);
        *first_at.entry(bits).or_insert(index as u32)
    });
    welded.collect()
}

/// Joins edges, sorted by their start, to closed rims.
fn rims(edges: &[Edge]) -> Vec<Vec<Edge>> {
    let mut is_used = vec![false; edges.len()];
    // For the first edge of each start, how many of those that leave there are used for certain.
    let mut used_from = vec![0; edges.len()];
    let mut rims = Vec::new();
    for first in 0..edges.len() {
        let mut rim = Vec::new();
        let mut next = Some(first);
        while let Some(index) = next.filter(|index| !is_used[*index]) {
            is_used[index] = true;
            rim.push(edges[index]);
            let [_, end] = edges[index];
            let from = edges.partition_point(|edge| edge[0] < end);
            if let Some(used) = used_from.get_mut(from) {
                let leaves = |index: usize| edges.get(index).is_some_and(|edge| edge[0] == end);
                while leaves(from + *used) && is_used[from + *used] {
                    *used += 1;
                }
                next = leaves(from + *used).then_some(from + *used);
            }
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    rims
}

/// Mean of the rim, weighted by the lengths of its edges.
fn rim_middle(positions: &[Vec3], rim: &[Edge]) -> Vec3 {
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for edge in rim {
        let [start, end] = edge.map(|vertex| positions[vertex as usize].as_dvec3());
        let length = start.distance(end);
        sum += (start + end) * (0.5 * length);
        total += length;
    }
    (sum / total).as_vec3()
}
