//! Skins that move by themselves as rows of four words, which shaders read: skin_table.wesl.

use glam::Vec3;

use crate::skin_box::SkinBox;
use crate::skin_solid::SkinSolid;
use crate::{BodyFrame, Collider, PosedSkin, Shape};

/// Most waiting nodes of a search: a table of the greatest size that a device binds has a tree of 20 levels.
#[allow(dead_code)] // shaders read it
const WAITING: usize = 24;
/// Number by which the first triangle of a leaf is multiplied; its count is added. A leaf has fewer triangles.
const LEAF_CODE: u32 = 8;
/// Rows of a node, of a vertex and of a triangle.
const ROWS: usize = 2;

/// The skins of a table of solids, and where they were when it was last written.
#[derive(Debug, Default)]
pub struct SkinTable {
    skins: Vec<Listed>,
}

/// Rows to write, and the index of the first.
pub type Written = (usize, Vec<[u32; 4]>);

/// A skin in a table.
#[derive(Debug)]
struct Listed {
    collider: Collider,
    /// Row of the solid's header, that row while the skin rides the head and while it moves, and the row of the first node.
    header: usize,
    at_rest: [u32; 4],
    moving: [u32; 4],
    first: usize,
    posed: Option<PosedSkin>,
    /// Side of the triangles that is outside, as they were written last.
    facing: f32,
}

impl SkinTable {
    /// Adds the skin of a collider: the row of its solid's header, what that holds while it rides the head and while it
    /// moves, and the row of its first node.
    pub(crate) fn add(
        &mut self,
        collider: &Collider,
        header: usize,
        [at_rest, moving]: [[u32; 4]; 2],
        first: usize,
    ) {
        let Shape::Skin(solid) = &collider.shape else { return };
        let (facing, collider) = (solid.facing, collider.clone());
        self.skins.push(Listed { collider, header, at_rest, moving, first, posed: None, facing });
    }

    /// The rows that bring a table to a step between two frames of the body; none where it is there.
    pub fn between(&mut self, start: &BodyFrame, end: &BodyFrame) -> Vec<Written> {
        let mut written = Vec::new();
        for listed in &mut self.skins {
            let is_known =
                listed.posed.as_ref().is_some_and(|posed| posed.is_of(&listed.collider, start, end));
            if is_known {
                continue;
            }
            let posed = PosedSkin::of(&listed.collider, start, end);
            if posed.is_some() != listed.posed.is_some() {
                let row = if posed.is_some() { listed.moving } else { listed.at_rest };
                written.push((listed.header, vec![row]));
            }
            written.extend(posed.as_ref().map(|posed| (listed.first, posed.moving_rows())));
            if let Some(posed) = posed.as_ref().filter(|posed| posed.facing != listed.facing) {
                listed.facing = posed.facing;
                let [.., triangles, _] = places(&posed.solid, listed.first);
                written.push((triangles as usize, triangle_rows(&posed.solid, posed.facing).collect()));
            }
            listed.posed = posed;
        }
        written
    }

    /// Row of the header of the first skin that moved by itself when the table was last written.
    pub fn moving(&self) -> Option<usize> {
        self.skins.iter().find(|listed| listed.posed.is_some()).map(|listed| listed.header)
    }

    /// Most way \[m\] of a vertex of any skin through the step for which the table was last written.
    pub fn most_shift(&self) -> f32 {
        self.skins
            .iter()
            .filter_map(|listed| listed.posed.as_ref())
            .map(PosedSkin::most_shift)
            .fold(0.0, f32::max)
    }
}

/// First rows of the parts of a skin: its nodes, vertices, triangles, and the triangles around vertices.
pub(crate) fn places(skin: &SkinSolid, first: usize) -> [u32; 4] {
    let vertices = first + ROWS * skin.nodes.len();
    let triangles = vertices + ROWS * skin.rest.len();
    [first, vertices, triangles, triangles + ROWS * skin.triangles.len()].map(|row| row as u32)
}

/// The rows of a skin that rides the head.
pub(crate) fn rows(skin: &SkinSolid) -> Vec<[u32; 4]> {
    let mut rows = moving_rows(skin, &skin.boxes_about(&skin.rest), [&skin.rest, &skin.rest]);
    rows.extend(triangle_rows(skin, skin.facing));
    let around = skin.all_around().chunks(4);
    rows.extend(around.map(|part| std::array::from_fn(|at| part.get(at).copied().unwrap_or_default())));
    rows
}

/// The rows of triangles whose outside is on a side.
fn triangle_rows(skin: &SkinSolid, facing: f32) -> impl Iterator<Item = [u32; 4]> {
    skin.triangles.iter().zip(&skin.across).flat_map(move |(corners, across)| {
        let ([a, b, c], [one, two, three]) = (*corners, *across);
        [[a, b, c, facing.to_bits()], [one, two, three, 0]]
    })
}

/// The rows of nodes and vertices: what changes when the skin moves.
fn moving_rows(skin: &SkinSolid, boxes: &[SkinBox], [start, end]: [&[Vec3]; 2]) -> Vec<[u32; 4]> {
    let vector = |vector: Vec3, last: u32| {
        let [x, y, z] = vector.to_array().map(f32::to_bits);
        [x, y, z, last]
    };
    let mut rows = Vec::with_capacity(ROWS * (boxes.len() + end.len()));
    for (node, around) in skin.nodes.iter().zip(boxes) {
        let [min, max] = around.corners();
        let [first, behind] = node.range;
        let leaf = if node.right == 0 { first * LEAF_CODE + (behind - first) } else { 0 };
        rows.extend([vector(min.into(), node.right), vector(max.into(), leaf)]);
    }
    for (vertex, (start, end)) in start.iter().zip(end).enumerate() {
        let [first, behind] = skin.range_around(vertex as u32);
        rows.extend([vector(*end, first), vector(*start, behind)]);
    }
    rows
}

impl PosedSkin {
    /// The rows of its nodes and vertices.
    fn moving_rows(&self) -> Vec<[u32; 4]> {
        moving_rows(&self.solid, &self.boxes, [&self.start, &self.end])
    }
}
