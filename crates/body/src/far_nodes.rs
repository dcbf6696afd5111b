//! Nodes far from the surface: of a large lattice only every fourth of them along each axis is searched for, nearer ones
//! every second, and what lies between is a bound.
//!
//! The distance to a triangle is convex and curved by at most 2 / d in all, so that what is interpolated over a block
//! lies no more than (side^2 / 8) (2 / d) above it, and that to the nearest of several no more above either: less this,
//! it is never more than the distance.

use glam::{DVec3, UVec3};
use strandline_base::par::prelude::*;

use crate::lattice::Lattice;
use crate::triangle_tree::{Nearest, TriangleTree};

/// Cells along a side of the blocks of each level, and the distance \[cells\] of all corners of a block of which only
/// these are searched for: a node of it lies less by 0.4 cells at most, and by 0.14 in a small block.
const LEVELS: [(u32, f64); 2] = [(4, 14.0), (2, 9.0)];
/// Half of a block's diagonal over its side: no node of it is farther from a corner.
const HALF: f64 = 0.875;
/// Nodes of a lattice that are all searched for.
const FEW: usize = 5 << 17;

/// The corners of all blocks, the large ones first.
pub(crate) struct FarNodes(Vec<Level>);

/// The corners of blocks of one size.
struct Level {
    side: u32,
    far: f64,
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
        let mut levels = Self(Vec::new());
        for (side, far) in LEVELS {
            let counts = (lattice.node_count - 1).map(|cells| cells.div_ceil(side)) + 1;
            let nearest = vec![Nearest::NONE; (counts.x * counts.y * counts.z) as usize];
            let mut level = Level { side, far, counts, nearest };
            level.search(tree, lattice, budget, &levels);
            levels.0.push(level);
        }
        Some(levels)
    }

    /// Lower bound of the distance of a node and a triangle near it, from the corners of its block, if these
    /// are far; for a corner what is nearest.
    pub fn at(&self, node: UVec3, lattice: &Lattice) -> Option<Nearest> {
        let between = self.0.iter().find_map(|level| level.at(node, lattice));
        between.or_else(|| self.0.last().and_then(|level| level.at_corner(node)))
    }
}

impl Level {
    /// Searches for what is nearest to each corner, but for corners far from the surface by larger blocks.
    fn search(&mut self, tree: &TriangleTree, lattice: &Lattice, budget: u64, larger: &FarNodes) {
        let (side, counts, last) = (self.side, self.counts, lattice.node_count - 1);
        self.nearest.par_chunks_mut(counts.x as usize).enumerate().for_each(|(row, nearest)| {
            let (y, z) = (row as u32 % counts.y, row as u32 / counts.y);
            let mut before = Nearest::NONE;
            for (x, nearest) in (0..).zip(nearest) {
                let node = (side * UVec3::new(x, y, z)).min(last);
                if let Some(known) = larger.at(node, lattice) {
                    (*nearest, before) = (known, known);
                    continue;
                }
                let point = node.as_dvec3();
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
    }

    fn corner(&self, corner: UVec3) -> Nearest {
        self.nearest[(corner.x + self.counts.x * (corner.y + self.counts.y * corner.z)) as usize]
    }

    /// The nearest place to a node that is a corner and was searched for with success.
    fn at_corner(&self, node: UVec3) -> Option<Nearest> {
        let is_corner = node % self.side == UVec3::ZERO;
        is_corner.then(|| self.corner(node / self.side)).filter(|nearest| nearest.squared > 0.0)
    }

    /// Lower bound between corners that are all far.
    fn at(&self, node: UVec3, lattice: &Lattice) -> Option<Nearest> {
        let block = (node / self.side).min(self.counts - 2);
        let [low, high] =
            [block, block + 1].map(|corner| (self.side * corner).min(lattice.node_count - 1).as_dvec3());
        let share = (node.as_dvec3() - low) / (high - low);
        let mut least = f64::INFINITY;
        let mut sum = 0.0;
        let mut triangle = Nearest::NONE.triangle;
        for corner in 0..8 {
            let step = UVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
            let nearest = self.corner(block + step);
            if nearest.squared < self.far * self.far {
                return None;
            }
            let weight = DVec3::select(step.cmpeq(UVec3::ONE), share, 1.0 - share).element_product();
            let distance = nearest.squared.sqrt();
            sum += weight * distance;
            if distance < least {
                (least, triangle) = (distance, nearest.triangle);
            }
        }
        let side = f64::from(self.side);
        let above = side * side / 8.0 * 2.0 / (least - HALF * side);
        Some(Nearest { squared: (sum - above).powi(2), triangle })
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
        let levels = |budget| FarNodes::new(&tree, &lattice, budget).expect("a large lattice");
        let (all, at) = (levels(u64::MAX), |budget| levels(budget).at(node, &lattice));
        let known: Vec<_> = (0..lattice.len()).step_by(4999).map(|index| lattice.node(index)).collect();
        let few = known.iter().filter(|node| all.at(**node, &lattice).is_none()).count();
        assert!(10 * few < known.len(), "{few} of {} nodes are left to be searched for", known.len());
        let found = all.at(node, &lattice).expect("all corners of its block are far").squared.sqrt();
        assert!(found <= nearest.squared.sqrt() && found > nearest.squared.sqrt() - 0.5, "{found}");
        assert!(at(16).is_none(), "after 16 triangles of 2,000 a corner is sure of nothing");
    }
}
