//! Positions of the nodes of a distance grid.

use glam::{DVec3, U64Vec3, UVec3, Vec3};
use strandline_base::math;

use crate::{Aabb, BodyError};

/// The most cells along one side.
const SIDE_LIMIT: u64 = 1024;
/// Layers that are worked on together.
pub(crate) const SLAB: usize = 8;

/// Nodes at equal spacing in a box; x varies fastest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// Position of node 0, 0, 0 \[m\].
    pub origin: Vec3,
    /// Distance of neighbouring nodes \[m\].
    pub spacing: f32,
    /// Nodes in x, y, z; at least two in each.
    pub node_count: UVec3,
}

impl Lattice {
    /// The most nodes of one grid: 16 bytes each make 128 MiB, the largest buffer of a GPU.
    pub const NODE_LIMIT: u64 = 8 << 20;
    /// The coarsest spacing \[m\] that is taken in place of one that is too fine; a body that needs more is
    /// in other units.
    pub const COARSEST: f32 = 0.1;

    /// A lattice over a box with at least `padding` \[m\] (and at least two cells) on every side; where
    /// that would be too many nodes, their spacing is the finest one that makes few enough.
    pub fn around(bounds: Aabb, spacing: f32, padding: f32) -> Result<Self, BodyError> {
        if !spacing.is_finite() || spacing <= 0.0 {
            return Err(out_of_range(
                "the spacing of the distance grid",
                spacing,
                "a finite number above zero [m]",
            ));
        }
        if !padding.is_finite() || padding < 0.0 {
            let expected = "a finite number, zero or more [m]";
            return Err(out_of_range("the padding of the distance grid", padding, expected));
        }
        let size = (bounds.max - bounds.min).as_dvec3();
        if !size.is_finite() || size.min_element() < 0.0 {
            return Err(BodyError::Value {
                what: "the box of the body",
                found: format!("from {} to {}", bounds.min, bounds.max),
                expected: "finite corners in order [m]",
            });
        }
        let asked = cells_at(size, spacing, padding);
        let mut spacing = spacing;
        let mut cells = asked;
        while let Some(excess) = excess(cells) {
            spacing *= excess.max(1.001) as f32;
            cells = cells_at(size, spacing, padding);
            if spacing > Self::COARSEST {
                return Err(BodyError::GridTooLarge { cells: asked.to_array(), limit: Lattice::NODE_LIMIT });
            }
        }
        let middle = 0.5 * (bounds.min + bounds.max);
        let origin = middle - cells.as_vec3() * (0.5 * spacing);
        Ok(Self { origin, spacing, node_count: cells.as_uvec3() + 1 })
    }

    /// True if the nodes on either side of the plane x = 0 are each other's mirror images.
    pub fn is_centered(&self) -> bool {
        self.origin.x == -0.5 * self.spacing * (self.node_count.x - 1) as f32
    }

    /// Nodes in all.
    pub fn len(&self) -> usize {
        let [x, y, z] = self.node_count.to_array().map(|count| count as usize);
        x * y * z
    }

    /// Nodes of one layer of equal z.
    pub fn layer_len(&self) -> usize {
        self.node_count.x as usize * self.node_count.y as usize
    }

    /// Place of a node in the order of storage.
    pub fn index(&self, node: UVec3) -> usize {
        let [nx, ny, _] = self.node_count.to_array().map(|count| count as usize);
        node.x as usize + nx * (node.y as usize + ny * node.z as usize)
    }

    /// The node at a place in the order of storage.
    pub fn node(&self, index: usize) -> UVec3 {
        let [nx, ny, _] = self.node_count.to_array().map(|count| count as usize);
        UVec3::new((index % nx) as u32, (index / nx % ny) as u32, (index / (nx * ny)) as u32)
    }

    /// Position of a node \[m\].
    pub fn position(&self, node: UVec3) -> Vec3 {
        self.origin + node.as_vec3() * self.spacing
    }
}

/// Cells in x, y, z. A float turned into an integer stops at the largest one, so this cannot overflow.
fn cells_at(size: DVec3, spacing: f32, padding: f32) -> U64Vec3 {
    let padding = f64::from(padding.max(2.0 * spacing));
    ((size + 2.0 * padding) / f64::from(spacing)).ceil().as_u64vec3()
}

/// Factor by which cells must be coarsened, if there are too many.
fn excess(cells: U64Vec3) -> Option<f64> {
    let nodes = cells.saturating_add(U64Vec3::ONE);
    let total = nodes.x.saturating_mul(nodes.y).saturating_mul(nodes.z);
    let side = cells.max_element();
    let excess = (side as f64 / SIDE_LIMIT as f64).max(math::cbrt(total as f64 / Lattice::NODE_LIMIT as f64));
    (side > SIDE_LIMIT || total > Lattice::NODE_LIMIT).then_some(excess)
}

fn out_of_range(what: &'static str, found: f32, expected: &'static str) -> BodyError {
    BodyError::Value { what, found: found.to_string(), expected }
}
