//! Nodes of the tree over a skin as searches read them: a box and what lies below it in half a line of the cache.

use std::ops::Range;

use glam::{Vec3A, Vec4};

/// Bits of 1.0: numbers behind it are finite and none is too small for quick arithmetic.
const FIRST: u32 = 0x3f80_0000;
/// Bits of the number of triangles of a leaf.
const COUNT_BITS: u32 = 3;

/// A box of a node: its least and greatest corners \[m\], and in their fourth numbers the right child, 0 for a leaf, and the
/// triangles of a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkinBox([Vec4; 2]);

impl SkinBox {
    pub const EMPTY: Self = Self([Vec4::ONE; 2]);

    /// The box of a node with these corners, its right child, 0 for a leaf, and the range of its triangles.
    pub fn new([min, max]: [Vec3A; 2], right: u32, [first, behind]: [u32; 2]) -> Self {
        let triangles = if right == 0 { first << COUNT_BITS | (behind - first) } else { 0 };
        let [right, triangles] = [right, triangles].map(|number| f32::from_bits(FIRST + number));
        Self([min.extend(right), max.extend(triangles)])
    }

    /// Its least and greatest corners \[m\].
    #[inline(always)]
    pub fn corners(&self) -> [Vec3A; 2] {
        self.0.map(Vec3A::from_vec4)
    }

    /// Index of the right child; 0 for a leaf.
    #[inline(always)]
    pub fn right(&self) -> u32 {
        self.0[0].w.to_bits() - FIRST
    }

    /// The triangles of a leaf.
    #[inline(always)]
    pub fn triangles(&self) -> Range<u32> {
        let triangles = self.0[1].w.to_bits() - FIRST;
        let first = triangles >> COUNT_BITS;
        first..first + (triangles & ((1 << COUNT_BITS) - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_keeps_what_lies_below_it() {
        let corners = [Vec3A::new(-1.0, f32::MIN, 0.0), Vec3A::new(1e-30, 2.0, f32::MAX)];
        for (range, right) in [([0, 4], 0), ([100_000_000, 100_000_004], 0), ([7, 90], 1_000_000_000)] {
            let found = SkinBox::new(corners, right, range);
            assert_eq!((found.corners(), found.right()), (corners, right));
            assert_eq!(found.triangles(), if right == 0 { range[0]..range[1] } else { 0..0 });
        }
    }
}
