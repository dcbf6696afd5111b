//! Eight strands at a time, as they lie in memory.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Strands in a block: one SIMD lane is one strand.
pub const LANES: usize = 8;

/// Blocks needed for a number of strands.
pub const fn block_count(strand_count: usize) -> usize {
    strand_count.div_ceil(LANES)
}

/// One number for each strand of a block.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Lanes(pub [f32; LANES]);

/// One vector for each strand of a block, component by component.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vec3Lanes {
    /// First components.
    pub x: [f32; LANES],
    /// Second components.
    pub y: [f32; LANES],
    /// Third components.
    pub z: [f32; LANES],
}

impl Vec3Lanes {
    /// The same vector in every lane.
    pub fn splat(vector: Vec3) -> Self {
        Self { x: [vector.x; LANES], y: [vector.y; LANES], z: [vector.z; LANES] }
    }

    /// The vector of one strand.
    #[inline]
    pub fn get(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// Sets the vector of one strand.
    #[inline]
    pub fn set(&mut self, lane: usize, vector: Vec3) {
        self.x[lane] = vector.x;
        self.y[lane] = vector.y;
        self.z[lane] = vector.z;
    }
}
