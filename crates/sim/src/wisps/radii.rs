//! Radii of wisps.

use glam::Vec3;
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use super::boxes::{Boxes, Sieve};
use super::place::{between, nearest};
use super::strips::SegmentBox;

/// Hair at rest as radii are measured on it, shapes `[block][point]` of lanes.
pub(crate) struct AtRest<'a> {
    pub strand_count: usize,
    pub points_per_strand: usize,
    /// Places \[m\], head space.
    pub positions: &'a [Vec3Lanes],
    /// Length of segments \[m\].
    pub lengths: &'a [Lanes],
}

/// Number of a segment's lane.
pub(crate) fn number(block: usize, point: usize, points: usize, lane: usize) -> u32 {
    ((block * points + point) * LANES + lane) as u32
}

impl AtRest<'_> {
    /// Radius \[m\] of each segment, shape `[block][point]` of lanes: that of the wisp, `thick(strand, share of its
    /// length)`, and at most half of the distance to the nearest segment of another strand.
    pub fn radii(&self, thick: impl Fn(usize, f32) -> f32) -> Vec<Lanes> {
        let points = self.points_per_strand;
        let mut radii = vec![Lanes::default(); self.positions.len()];
        let mut boxes = Vec::with_capacity(self.strand_count * (points - 1));
        for block in 0..self.positions.len() / points {
            let live = (self.strand_count - block * LANES).min(LANES);
            let mut passed = [0.0; LANES];
            let whole: [f32; LANES] = std::array::from_fn(|lane| {
                (0..points - 1).map(|point| self.lengths[block * points + point].0[lane]).sum()
            });
            for point in 0..points - 1 {
                for lane in 0..live {
                    let index = block * points + point;
                    let length = self.lengths[index].0[lane];
                    let strand = block * LANES + lane;
                    let radius = thick(strand, (passed[lane] + 0.5 * length) / whole[lane]);
                    passed[lane] += length;
                    radii[index].0[lane] = radius;
                    let [a, b] = self.ends(index as u32 * LANES as u32 + lane as u32);
                    boxes.push(SegmentBox {
                        low: a.min(b) - Vec3::splat(radius),
                        high: a.max(b) + Vec3::splat(radius),
                        segment: number(block, point, points, lane),
                        strand: strand as u32,
                    });
                }
            }
        }
        let mut pairs = Vec::new();
        Boxes::default().pairs(&boxes, self, &mut Vec::new(), &mut pairs);
        for met in pairs {
            for segment in met.segments {
                let radius = &mut radii[segment as usize / LANES].0[segment as usize % LANES];
                *radius = radius.min(0.5 * met.distance);
            }
        }
        radii
    }

    fn ends(&self, segment: u32) -> [Vec3; 2] {
        let (index, lane) = (segment as usize / LANES, segment as usize % LANES);
        [self.positions[index].get(lane), self.positions[index + 1].get(lane)]
    }
}

/// All pairs have a distance.
impl Sieve for AtRest<'_> {
    type One = ();
    type Eight = ();

    fn one(&self, (): &(), _: usize) {}

    fn eight(&self, _: [u32; LANES]) {}

    fn may_meet(&self, (): &(), (): &(), lanes: u32) -> u32 {
        lanes
    }

    fn judge(&self, [one, other]: [u32; 2]) -> Option<f32> {
        let ([a, b], [c, d]) = (self.ends(one), self.ends(other));
        let ends = [a, b, c, d];
        Some(between(&ends, nearest(&ends)).length())
    }
}
