//! Triangles that lie within another shell.

use glam::{DVec3, UVec3};

use crate::lattice::Lattice;
use crate::layers::Corners;

/// Counts nodes of any box of a lattice that are outside, at the cost of eight look-ups.
pub(crate) struct OutsideCounts<'a> {
    lattice: &'a Lattice,
    /// Nodes outside in the box from the first node to each one, both included, modulo 2^32.
    sums: Vec<u32>,
}

impl<'a> OutsideCounts<'a> {
    pub fn new(inside: &[bool], lattice: &'a Lattice) -> Self {
        let mut sums: Vec<u32> = inside.iter().map(|inside| u32::from(!inside)).collect();
        let columns = lattice.node_count.x as usize;
        let layer_len = lattice.layer_len();
        for row in sums.chunks_mut(columns) {
            running_sum(row, 1);
        }
        for layer in sums.chunks_mut(layer_len) {
            running_sum(layer, columns);
        }
        running_sum(&mut sums, layer_len);
        Self { lattice, sums }
    }

    /// True if all nodes within a cell of a triangle are inside: it then belongs to a shell within another
    /// one and is no part of the skin.
    pub fn is_buried(&self, corners: &Corners) -> bool {
        let last = (self.lattice.node_count - 1).as_dvec3();
        let low = corners.iter().fold(last, |low, corner| low.min(*corner));
        let high = corners.iter().fold(DVec3::ZERO, |high, corner| high.max(*corner));
        let low = (low.floor() - 1.0).max(DVec3::ZERO).as_uvec3();
        let high = (high.ceil() + 1.0).min(last).as_uvec3();
        self.count(low, high) == 0
    }

    /// Nodes outside in a box, both corners included.
    fn count(&self, low: UVec3, high: UVec3) -> u32 {
        (0..8).fold(0_u32, |sum, corner| {
            let mut node = high;
            for axis in 0..3 {
                if corner >> axis & 1 == 1 {
                    if low[axis] == 0 {
                        return sum;
                    }
                    node[axis] = low[axis] - 1;
                }
            }
            let part = self.sums[self.lattice.index(node)];
            // Of the eight boxes those with an odd number of lower sides are taken away.
            if i32::count_ones(corner) % 2 == 0 { sum.wrapping_add(part) } else { sum.wrapping_sub(part) }
        })
    }
}

/// Adds to each number the one `stride` before it.
fn running_sum(numbers: &mut [u32], stride: usize) {
    for index in stride..numbers.len() {
        numbers[index] = numbers[index].wrapping_add(numbers[index - stride]);
    }
}
