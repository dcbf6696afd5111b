//! The skin of a body as a solid: samples of its distance at rest, and its triangles for when it moves.

use std::sync::Arc;

use glam::{Vec3, Vec3A};
use strandline_base::Tally;
use strandline_base::par::prelude::*;

use crate::inside_out::{RestVolume, side_of};
use crate::mesh_distance::skin_triangles;
use crate::skin_box::SkinBox;
use crate::welding::welded_vertices;
use crate::{Aabb, BodyError, DistanceGrid, Mesh};

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Least nodes of a part of the tree whose leaves are listed together, and most parts.
const PART: usize = 4096;
const MOST_PARTS: usize = 8;
/// No triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// A closed surface whose vertices may move, and the tree over its triangles.
///
/// Holes are closed by fans whose middles follow their rims, and shells within others at rest are left out. The order of
/// triangles and boxes is that of the shape at rest.
#[derive(Debug)]
pub struct SkinSolid {
    grid: Arc<DistanceGrid>,
    /// Vertices of the mesh; those behind them are the middles of rims.
    pub(crate) vertex_count: usize,
    /// Positions at rest \[m\].
    pub(crate) rest: Vec<Vec3>,
    /// For each middle the vertices of its rim and their weights.
    middles: Vec<Vec<(u32, f32)>>,
    /// Corners of triangles, those of a leaf beside each other.
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) nodes: Vec<SkinNode>,
    /// For each triangle the ones across its edges from corner 0 to 1, 1 to 2 and 2 to 0.
    pub(crate) across: Vec<[u32; 3]>,
    /// First vertex at each place.
    pub(crate) welded: Vec<u32>,
    /// Triangles around each first vertex: from `first_around` of it to that of the next.
    around: Vec<u32>,
    first_around: Vec<u32>,
    /// -1 for a surface that is inside out.
    pub(crate) facing: f32,
    volume: RestVolume,
    pub(crate) tally: SkinTally,
}

/// Counts of searches of a skin for what is nearest, of the triangles that they look at, and of lines through it, through all
/// steps.
#[derive(Debug, Default)]
pub(crate) struct SkinTally {
    pub searches: Tally,
    pub looks: Tally,
    pub lines: Tally,
}

/// A node of the tree; the left child follows its parent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkinNode {
    /// Its triangles.
    pub range: [u32; 2],
    /// Index of the right child; 0 for a leaf.
    pub right: u32,
}

impl SkinSolid {
    /// The skin of a mesh, and the samples of its distance that stand for it while it rides the head.
    ///
    /// # Errors
    /// A mesh that is empty or has invalid indices or positions, as [`DistanceGrid::of_mesh`] refuses it.
    pub fn new(mesh: &Mesh, grid: Arc<DistanceGrid>) -> Result<Self, BodyError> {
        mesh.check_usable()?;
        let closed = mesh.without_repeats().closed();
        let rest = closed.positions.clone();
        let vertex_count = mesh.positions.len();
        let (indices, facing) = skin_triangles(&closed, grid.spacing())?;
        let corners = |index: &u32| closed.triangles[*index as usize];
        let has_area = |[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| rest[*corner as usize]);
            (b - a).cross(c - a) != Vec3::ZERO
        };
        let mut triangles: Vec<[u32; 3]> = indices.iter().map(corners).filter(has_area).collect();
        if triangles.is_empty() {
            triangles.push(closed.triangles[0]);
        }
        let mut nodes = Vec::new();
        grow(&mut triangles, 0, &rest, &mut nodes);
        let welded = welded_vertices(&rest);
        let across = across(&triangles, &welded);
        let (around, first_around) = around(&triangles, &welded);
        let middles = middles(&closed, vertex_count);
        let volume = RestVolume::new(&rest, &triangles);
        Ok(Self {
            grid,
            vertex_count,
            rest,
            middles,
            triangles,
            nodes,
            across,
            welded,
            around,
            first_around,
            facing,
            volume,
            tally: SkinTally::default(),
        })
    }

    /// Samples of the distance at rest.
    pub fn grid(&self) -> &Arc<DistanceGrid> {
        &self.grid
    }

    /// Number of triangles, those over holes among them.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Numbers of searches for what is nearest so far, of triangles that they looked at, and of lines that were followed, in
    /// a build with debug assertions; else 0.
    #[doc(hidden)]
    pub fn work(&self) -> [u64; 3] {
        let SkinTally { searches, looks, lines } = &self.tally;
        [searches, looks, lines].map(Tally::count)
    }

    /// Box of the skin at rest.
    pub(crate) fn bounds(&self) -> Aabb {
        crate::SignedDistance::bounds(&*self.grid)
    }

    /// Triangles around a vertex and those at its place.
    pub(crate) fn around(&self, vertex: u32) -> &[u32] {
        let [first, behind] = self.range_around(vertex);
        &self.around[first as usize..behind as usize]
    }

    /// The triangles around all vertices, and which of them lie around one and those at its place: the first, and that
    /// behind the last.
    pub(crate) fn all_around(&self) -> &[u32] {
        &self.around
    }

    pub(crate) fn range_around(&self, vertex: u32) -> [u32; 2] {
        let first = self.welded[vertex as usize] as usize;
        [self.first_around[first], self.first_around[first + 1]]
    }

    /// Sides of the triangles that are outside, as [`Self::facing`], for the vertices at the end of a step and at its start,
    /// from which they moved by `shift` \[m\] at most.
    pub(crate) fn facings(&self, [end, start]: [&[Vec3]; 2], shift: f32) -> [f32; 2] {
        let share = self.volume.share(end, &self.triangles);
        let side = side_of(share);
        let keeps = self.volume.keeps_side(share, shift);
        let before = if keeps { side } else { self.volume.side(start, &self.triangles) };
        [side, before].map(|side| side * self.facing)
    }

    /// Boxes of all nodes about positions \[m\].
    pub(crate) fn boxes_about(&self, positions: &[Vec3]) -> Vec<SkinBox> {
        let about = |node: &SkinNode| {
            let triangles = &self.triangles[node.range[0] as usize..node.range[1] as usize];
            let corners = triangles.iter().flatten().map(|corner| Vec3A::from(positions[*corner as usize]));
            let around = corners.fold([Vec3A::INFINITY, Vec3A::NEG_INFINITY], |[min, max], corner| {
                [min.min(corner), max.max(corner)]
            });
            SkinBox::new(around, 0, node.range)
        };
        let mut boxes = vec![SkinBox::EMPTY; self.nodes.len()];
        let leaves = boxes.par_iter_mut().zip(&self.nodes).with_min_len(512);
        leaves.filter(|(_, node)| node.right == 0).for_each(|(corners, node)| *corners = about(node));
        // Children lie behind their parents.
        for (index, node) in self.nodes.iter().enumerate().rev().filter(|(_, node)| node.right > 0) {
            let [left, right] = [boxes[index + 1].corners(), boxes[node.right as usize].corners()];
            boxes[index] =
                SkinBox::new([left[0].min(right[0]), left[1].max(right[1])], node.right, node.range);
        }
        boxes
    }

    /// Number of nodes of each part of the tree whose leaves are listed together.
    fn part_size(&self) -> usize {
        self.nodes.len().div_ceil(MOST_PARTS).max(PART)
    }

    /// Number of these parts.
    pub(crate) fn part_count(&self) -> usize {
        self.nodes.len().div_ceil(self.part_size())
    }

    /// The boxes of the leaves in a part of the tree, each with the most of the numbers of its vertices.
    pub(crate) fn shifts_of_leaves<'a>(
        &'a self,
        part: usize,
        boxes: &'a [SkinBox],
        squares: &'a [f32],
    ) -> impl Iterator<Item = ([Vec3A; 2], f32)> + 'a {
        let nodes = self.nodes.iter().zip(boxes).skip(part * self.part_size()).take(self.part_size());
        nodes.filter(|(node, _)| node.right == 0).map(|(node, around)| {
            let triangles = &self.triangles[node.range[0] as usize..node.range[1] as usize];
            let all = triangles.iter().flatten().map(|corner| squares[*corner as usize]);
            (around.corners(), all.fold(0.0, f32::max))
        })
    }

    /// Positions of all vertices \[m\]: those of the skin, of a mesh at rest without any, and the middles of rims.
    pub(crate) fn positions(&self, skin: Option<&[Vec3]>) -> Vec<Vec3> {
        let Some(skin) = skin else { return self.rest.clone() };
        let mut positions = Vec::with_capacity(self.rest.len());
        positions.extend_from_slice(skin);
        for (rim, rest) in self.middles.iter().zip(&self.rest[self.vertex_count..]) {
            // At rest to the bit.
            let moved = rim
                .iter()
                .map(|(vertex, weight)| (skin[*vertex as usize] - self.rest[*vertex as usize]) * *weight);
            positions.push(*rest + moved.sum::<Vec3>());
        }
        positions
    }
}

/// Sorts triangles into a tree; `start` is the place of the first among all.
fn grow(triangles: &mut [[u32; 3]], start: usize, rest: &[Vec3], nodes: &mut Vec<SkinNode>) {
    let node = nodes.len();
    nodes.push(SkinNode { range: [start as u32, (start + triangles.len()) as u32], right: 0 });
    if triangles.len() <= LEAF {
        return;
    }
    let middle = |corners: &[u32; 3]| corners.iter().map(|corner| rest[*corner as usize]).sum::<Vec3>();
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for corners in triangles.iter() {
        (low, high) = (low.min(middle(corners)), high.max(middle(corners)));
    }
    let axis = (high - low).max_position();
    let half = triangles.len() / 2;
    triangles.select_nth_unstable_by(half, |one, other| {
        middle(one)[axis].total_cmp(&middle(other)[axis]).then(one.cmp(other))
    });
    let (left, right) = triangles.split_at_mut(half);
    grow(left, start, rest, nodes);
    nodes[node].right = nodes.len() as u32;
    grow(right, start + half, rest, nodes);
}

/// For each triangle those across its edges.
fn across(triangles: &[[u32; 3]], welded: &[u32]) -> Vec<[u32; 3]> {
    let mut edges: Vec<([u32; 2], u32, usize)> = Vec::with_capacity(3 * triangles.len());
    for (index, corners) in triangles.iter().enumerate() {
        let corners = corners.map(|corner| welded[corner as usize]);
        for edge in 0..3 {
            let [start, end] = [corners[edge], corners[(edge + 1) % 3]];
            edges.push(([start.min(end), start.max(end)], index as u32, edge));
        }
    }
    edges.sort_unstable();
    let mut across = vec![[NONE; 3]; triangles.len()];
    for group in edges.chunk_by(|one, other| one.0 == other.0) {
        // At an edge of more than two triangles each has one of the others.
        for (place, (_, index, edge)) in group.iter().enumerate() {
            let other = group[(place + 1) % group.len()].1;
            across[*index as usize][*edge] = if other == *index { NONE } else { other };
        }
    }
    across
}

/// Triangles around each vertex, and where those of each begin.
fn around(triangles: &[[u32; 3]], welded: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(3 * triangles.len());
    for (index, corners) in triangles.iter().enumerate() {
        pairs.extend(corners.iter().map(|corner| (welded[*corner as usize], index as u32)));
    }
    pairs.sort_unstable();
    let first = |vertex: usize| pairs.partition_point(|(of, _)| (*of as usize) < vertex) as u32;
    let starts = (0..=welded.len()).map(first).collect();
    (pairs.into_iter().map(|(_, triangle)| triangle).collect(), starts)
}

/// For each vertex behind those of the mesh the rim of its hole, weighted by the lengths of its edges.
fn middles(closed: &Mesh, vertex_count: usize) -> Vec<Vec<(u32, f32)>> {
    let mut rims = vec![Vec::new(); closed.positions.len() - vertex_count];
    for [end, start, center] in &closed.triangles {
        let Some(rim) = (*center as usize).checked_sub(vertex_count) else { continue };
        let [one, other] = [start, end].map(|vertex| closed.positions[*vertex as usize]);
        let half = 0.5 * one.distance(other);
        rims[rim].extend([(*start, half), (*end, half)]);
    }
    for rim in &mut rims {
        let total: f32 = rim.iter().map(|(_, weight)| weight).sum();
        rim.iter_mut().for_each(|(_, weight)| *weight /= total.max(f32::MIN_POSITIVE));
    }
    rims
}
