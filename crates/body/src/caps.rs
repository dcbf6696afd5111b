//! The planes that cut a part of the neck out of the bust: how far a point lies beyond them tells that the part is far.

use glam::Vec3;

use crate::neck::SLOPE;

/// Bounds of a part of the bust, head space. Levels are those of planes across the neck: level = y + SLOPE z.
#[derive(Clone, Copy, Debug)]
pub struct Caps {
    /// Levels \[m\] between which the part lies.
    pub levels: [f32; 2],
    /// Half its width along x \[m\].
    pub half_width: f32,
    /// Places \[m\] along z between which it lies.
    pub depths: [f32; 2],
}

impl Caps {
    /// Slope of the planes of a level.
    pub const SLOPE: f32 = SLOPE;

    /// Difference of the levels of two planes over their distance.
    pub fn steepness() -> f32 {
        Vec3::new(0.0, 1.0, SLOPE).length()
    }

    /// Lower bound \[m\] of the distance of a point \[m\] from the part; below 0 between all planes.
    #[inline]
    pub fn beyond(&self, point: Vec3) -> f32 {
        let level = point.y + SLOPE * point.z;
        let [low, high] = self.levels;
        let along = (level - high).max(low - level) / Self::steepness();
        let [back, front] = self.depths;
        along.max(point.x.abs() - self.half_width).max((point.z - front).max(back - point.z))
    }
}
