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
    /// Distance of two planes over the difference of their levels.
    pub const STEEP: f32 = 0.894_427_2;

    /// Difference of the levels of two planes over their distance.
    pub fn steepness() -> f32 {
        Vec3::new(0.0, 1.0, SLOPE).length()
    }

    /// True for a part with planes on all sides.
    pub fn is_bounded(&self) -> bool {
        self.half_width.is_finite() && self.levels.iter().chain(&self.depths).all(|place| place.is_finite())
    }

    /// Corners of the body that the planes bound \[m\].
    pub(crate) fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            let [level, z] = [self.levels[corner & 1], self.depths[corner >> 1 & 1]];
            let x = if corner < 4 { self.half_width } else { -self.half_width };
            Vec3::new(x, level - SLOPE * z, z)
        })
    }

    /// The planes about places \[m\].
    pub(crate) fn around(places: impl Iterator<Item = Vec3>) -> Self {
        let none = [f32::INFINITY, f32::NEG_INFINITY];
        let wider = |[low, high]: [f32; 2], place: f32| [low.min(place), high.max(place)];
        places.fold(Self { levels: none, half_width: 0.0, depths: none }, |all, place| Self {
            levels: wider(all.levels, place.y + SLOPE * place.z),
            half_width: all.half_width.max(place.x.abs()),
            depths: wider(all.depths, place.z),
        })
    }

    /// Lower bound \[m\] of the distance of a point \[m\] from the part; below 0 between all planes.
    #[inline]
    pub fn beyond(&self, point: Vec3) -> f32 {
        let level = point.y + SLOPE * point.z;
        let [low, high] = self.levels;
        let along = (level - high).max(low - level) * Self::STEEP;
        let [back, front] = self.depths;
        along.max(point.x.abs() - self.half_width).max((point.z - front).max(back - point.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_planes_are_those_of_their_slope() {
        assert!((Caps::STEEP * Caps::steepness() - 1.0).abs() < 1e-6);
    }
}
