//! Where the nodes of a distance grid lie.

use glam::{UVec3, Vec3};

use crate::{Aabb, BodyError};

/// The most cells of one grid: 16 bytes each make 256 MiB.
const CELL_LIMIT: u64 = 256 * 256 * 256;

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
    /// A lattice over a box with at least `padding` \[m\] (and at least two cells) on every side.
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
        let padding = padding.max(2.0 * spacing);
        // A float turned into an integer stops at the largest one, so this cannot overflow.
        let cells = ((size + 2.0 * f64::from(padding)) / f64::from(spacing)).ceil().as_u64vec3();
        let total = cells.x.saturating_mul(cells.y).saturating_mul(cells.z);
        if total > CELL_LIMIT {
            return Err(BodyError::GridTooLarge { cells: cells.to_array(), limit: CELL_LIMIT });
        }
        let middle = 0.5 * (bounds.min + bounds.max);
        let origin = middle - cells.as_vec3() * (0.5 * spacing);
        Ok(Self { origin, spacing, node_count: cells.as_uvec3() + 1 })
    }

    /// Whether the nodes on either side of the plane x = 0 are each other's mirror images.
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

fn out_of_range(what: &'static str, found: f32, expected: &'static str) -> BodyError {
    BodyError::Value { what, found: found.to_string(), expected }
}
