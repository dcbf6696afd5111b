//! The parts of a neck, which lie one upon the other: the parts that points have to look at.

use std::ops::Range;

use strandline_base::vec3x8::{Rigid, Vec3x8, splat};
use strandline_body::{Caps, CommonCaps};
use strandline_groom::LANES;
use wide::f32x8;

/// The parts of a neck among the groups of solids.
pub(super) struct Parts<'a> {
    common: &'a CommonCaps,
    /// Leads into the space of the planes about all parts.
    from_world: Rigid,
    /// Their groups, the lowest part first.
    pub groups: Range<usize>,
    /// Levels \[m\] between neighbouring parts, rising.
    ends: Vec<f32>,
}

impl<'a> Parts<'a> {
    /// The parts with these planes, the lowest first, whose groups begin with the one of number `first`.
    pub fn new(common: &'a CommonCaps, first: usize, caps: &[Caps]) -> Self {
        let end = |pair: &[Caps]| 0.5 * (pair[0].levels[1] + pair[1].levels[0]);
        Self {
            common,
            from_world: Rigid::new(&common.from_world),
            groups: first..first + caps.len(),
            ends: caps.windows(2).map(end).collect(),
        }
    }

    /// The groups of parts in the order in which points of one index look at them: from the part at their level on, then
    /// those below it. None where no point comes within `reach` \[m\] of a part, nor from `start` \[m\] through one.
    #[inline(always)]
    pub fn order(&self, position: Vec3x8, start: Option<Vec3x8>, reach: f32x8) -> [Range<usize>; 2] {
        let local = self.from_world.points(position);
        let beyond = beyond(&self.common.caps, local);
        if beyond.simd_gt(reach).all() && beyond.simd_gt(self.way(position, start)).all() {
            return [0..0, 0..0];
        }
        let level = (local.y + local.z * splat(Caps::SLOPE)).reduce_add() / LANES as f32;
        let own = self.groups.start + self.ends.partition_point(|end| *end < level);
        [own..self.groups.end, self.groups.start..own]
    }

    /// Upper bounds \[m\] of the ways of points to `position` \[m\] from where points that lay at `start` \[m\] and stuck to a part
    /// are.
    #[inline(always)]
    fn way(&self, position: Vec3x8, start: Option<Vec3x8>) -> f32x8 {
        start.map_or(splat(0.0), |start| {
            let away = (start - Vec3x8::splat(self.common.middle)).length();
            (position - start).length() + splat(self.common.way) + away * splat(self.common.turn)
        })
    }
}

/// Lower bounds \[m\] of the distances of points \[m\] from what planes bound.
#[inline(always)]
pub(super) fn beyond(caps: &Caps, Vec3x8 { x, y, z }: Vec3x8) -> f32x8 {
    let level = y + z * splat(Caps::SLOPE);
    let [low, high] = caps.levels.map(splat);
    let [back, front] = caps.depths.map(splat);
    let along = (level - high).fast_max(low - level) * splat(Caps::STEEP);
    along.fast_max(x.abs() - splat(caps.half_width)).fast_max((z - front).fast_max(back - z))
}
