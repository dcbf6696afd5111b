//! Finding and closing the holes of a mesh.

use std::borrow::Cow;
use std::collections::HashSet;

use glam::{DVec3, Vec3};

use crate::Mesh;
use crate::welding::welded_vertices;

/// An edge of a triangle, in the triangle's direction, between welded vertices.
type Edge = [u32; 2];

impl Mesh {
    /// True if the surface has an inside: every edge of a triangle meets one of a neighbour in the opposite
    /// direction, with vertices at the same position counted as one.
    pub fn is_closed(&self) -> bool {
        self.open_edge_count() == 0
    }

    /// Number of edges of triangles without a counterpart in the opposite direction.
    ///
    /// # Panics
    /// As [`Self::is_closed`] and [`Self::closed`], if an index is out of range; indices of loaded meshes are not.
    pub fn open_edge_count(&self) -> usize {
        open_edges(self).len()
    }

    /// The mesh without triangles that are there before, between the same places and wound the same way: they
    /// only add work.
    pub(crate) fn without_repeats(&self) -> Cow<'_, Self> {
        let welded = welded_vertices(&self.positions);
        let mut known = HashSet::with_capacity(self.triangles.len());
        let is_new = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| welded[corner as usize]);
            known.insert([[a, b, c], [b, c, a], [c, a, b]].into_iter().min())
        };
        let triangles: Vec<_> = self.triangles.iter().copied().filter(is_new).collect();
        if triangles.len() == self.triangles.len() {
            return Cow::Borrowed(self);
        }
        let (positions, normals) = (self.positions.clone(), self.normals.clone());
        Cow::Owned(Self { positions, normals, triangles, ..Self::default() })
    }

    /// The mesh with every hole closed by a fan of triangles from the middle of its rim.
    pub fn closed(&self) -> Self {
        close(self)
    }
}

/// The edges that no triangle shares in the opposite direction, sorted.
///
/// They form closed rims: every vertex is left by as many as arrive.
fn open_edges(mesh: &Mesh) -> Vec<Edge> {
    let welded = welded_vertices(&mesh.positions);
    let edges = || {
        mesh.triangles.iter().flat_map(|triangle| {
            let [a, b, c] = triangle.map(|corner| welded[corner as usize]);
            [[a, b], [b, c], [c, a]].into_iter().filter(|[start, end]| start != end)
        })
    };
    // Edges by their lower end: the higher one, and whether it is the end. A vertex has a few: to sort those of each
    // takes a fraction of the time of sorting all.
    let mut starts = vec![0_usize; mesh.positions.len() + 1];
    edges().for_each(|[start, end]| starts[start.min(end) as usize + 1] += 1);
    for low in 0..mesh.positions.len() {
        starts[low + 1] += starts[low];
    }
    let (mut next, mut highs) = (starts.clone(), vec![0_u64; starts[mesh.positions.len()]]);
    for [start, end] in edges() {
        let place = &mut next[start.min(end) as usize];
        highs[*place] = u64::from(start.max(end)) << 1 | u64::from(start < end);
        *place += 1;
    }
    let mut open = Vec::new();
    for (low, range) in starts.windows(2).enumerate() {
        let highs = &mut highs[range[0]..range[1]];
        highs.sort_unstable();
        for group in highs.chunk_by(|one, other| one >> 1 == other >> 1) {
            let (low, high) = (low as u32, (group[0] >> 1) as u32);
            let forward = group.iter().filter(|&edge| edge & 1 == 1).count();
            let backward = group.len() - forward;
            open.extend((backward..forward).map(|_| [low, high]));
            open.extend((forward..backward).map(|_| [high, low]));
        }
    }
    open.sort_unstable();
    open
}

/// The mesh with a fan of triangles over every hole.
fn close(mesh: &Mesh) -> Mesh {
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
