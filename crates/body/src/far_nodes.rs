//! Nodes far from the surface: of a large lattice only every fourth of them along each axis is searched for, and what
//! lies between is a bound.
//!
//! The distance to a triangle is convex and curved by at most 2 / d in all, so that what is interpolated over a block
//! lies no more than (side^2 / 8) (2 / d) above it, and that to the nearest of several no more above either: less this,
//! it is never more than the distance.

use glam::{DVec3, UVec3};
use strandline_base::par::prelude::*;

use crate::lattice::Lattice;
use crate::triangle_tree::{Nearest, TriangleTree};

/// Cells along a side of a block.
const SIDE: u32 = 4;
/// Distance \[cells\] of all corners of a block of which only these are searched for.
const FAR: f64 = 14.0;
/// Half of a block's diagonal \[cells\]: no node of it is farther from a corner.
const HALF: f64 = 3.5;
/// Nodes of a lattice that are all searched for.
const FEW: usize = 1 << 20;

/// The corners of all blocks.
pub(crate) struct FarNodes {
    counts: UVec3,
    nearest: Vec<Nearest>,
}

impl FarNodes {
    /// Looks for the surface from every corner, at no more than `budget` triangles each; `None` for a small lattice. A
    /// corner for which these do not suffice counts as near, so that the nodes of its blocks are searched for.
    pub fn new(tree: &TriangleTree, lattice: &Lattice, budget: u64) -> Option<Self> {
        if lattice.len() <= FEW {
            return None;
        }
        let counts = (lattice.node_count - 1).map(|cells| cells.div_ceil(SIDE)) + 1;
        let mut nearest = vec![Nearest::NONE; (counts.x * counts.y * counts.z) as usize];
        let last = lattice.node_count - 1;
        nearest.par_chunks_mut(counts.x as usize).enumerate().for_each(|(row, nearest)| {
            let (y, z) = (row as u32 % counts.y, row as u32 / counts.y);
            let mut before = Nearest::NONE;
            for (x, nearest) in (0..).zip(nearest) {
                let point = (SIDE * UVec3::new(x, y, z)).min(last).as_dvec3();
                if before.triangle != Nearest::NONE.triangle {
                    tree.offer(before.triangle, point, nearest);
                }
                let sufficed = tree.search(point, budget, nearest) < budget;
                before = *nearest;
                if !sufficed {
                    nearest.squared = 0.0;
                }
            }
        });
        Some(Self { counts, nearest })
    }

    /// Lower bound of the distance of a node and a triangle near it, from the corners of its block, if these
    /// are far.
    pub fn at(&self, node: UVec3, lattice: &Lattice) -> Option<Nearest> {
        let block = (node / SIDE).min(self.counts - 2);
        let [low, high] =
            [block, block + 1].map(|corner| (SIDE * corner).min(lattice.node_count - 1).as_dvec3());
        let share = (node.as_dvec3() - low) / (high - low);
        let mut least = f64::INFINITY;
        let mut sum = 0.0;
        let mut triangle = Nearest::NONE.triangle;
        for corner in 0..8 {
            let step = UVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
            let place = block + step;
            let nearest =
                self.nearest[(place.x + self.counts.x * (place.y + self.counts.y * place.z)) as usize];
            let weight = DVec3::select(step.cmpeq(UVec3::ONE), share, 1.0 - share).element_product();
            let distance = nearest.squared.sqrt();
            sum += weight * distance;
            if distance < least {
                (least, triangle) = (distance, nearest.triangle);
            }
        }
        let above = f64::from(SIDE * SIDE) / 8.0 * 2.0 / (least - HALF);
        (least >= FAR).then(|| Nearest { squared: (sum - above).powi(2), triangle })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::Corners;

    /// A disc of thin triangles that meet at its middle \[cells\], aslant so that their boxes overlap.
    fn disc(middle: DVec3, radius: f64, count: u32) -> Vec<Corners> {
        let (u, v) = DVec3::ONE.normalize().any_orthonormal_pair();
        let rim = |index: u32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(index) / f64::from(count)).sin_cos();
            middle + radius * (cos * u + sin * v)
        };
        (0..count).map(|index| [middle, rim(index), rim(index + 1)]).collect()
    }

    #[test]
    fn what_could_not_be_made_sure_of_is_not_taken_for_known() {
        let node_count = UVec3::new(128, 96, 128);
        let lattice = Lattice { origin: glam::Vec3::ZERO, spacing: 1.0, node_count };
        let triangles = disc(DVec3::new(40.0, 20.0, 40.0), 16.0, 2000);
        let tree = TriangleTree::new(&triangles, (0..2000).collect());
        let node = UVec3::new(70, 52, 71);
        let mut nearest = Nearest::NONE;
        tree.search(node.as_dvec3(), u64::MAX, &mut nearest);
        let at = |budget| FarNodes::new(&tree, &lattice, budget).expect("a large lattice").at(node, &lattice);
        let found = at(u64::MAX).expect("all corners of its block are far").squared.sqrt();
        assert!(found <= nearest.squared.sqrt() && found > nearest.squared.sqrt() - 0.5, "{found}");
        assert!(at(16).is_none(), "after 16 triangles of 2,000 a corner is sure of nothing");
    }
}
