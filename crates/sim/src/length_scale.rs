//! Strands of another length than at rest [Chen2011 fig. 45].

use std::ops::Range;

use glam::Vec3;
use strandline_groom::{LANES, Lanes, RestShape, Vec3Lanes};

/// Least length of a segment over its rest length: a segment of no length has no direction.
const SHORTEST: f32 = 0.05;
/// Greatest length of a segment over its rest length; with it half of the segments make a strand twice as long.
const LONGEST: f32 = 3.0;

/// Gives the strands of a block their share of the length at rest: the last segments change first, as far
/// as they may, and those near the root stay.
pub(crate) fn scale(rest: &RestShape, lengths: &mut RestShape, range: Range<usize>, scale: &Lanes) {
    let points = range.len();
    let first = range.start;
    for lane in 0..LANES {
        let total: f32 = range.clone().map(|index| rest.stretch[index].0[lane]).sum();
        let mut missing = (scale.0[lane] - 1.0) * total;
        for index in range.clone().skip(1).rev() {
            let own = rest.stretch[index].0[lane];
            let added = missing.clamp((SHORTEST - 1.0) * own, (LONGEST - 1.0) * own);
            lengths.stretch[index].0[lane] = own + added;
            missing -= added;
        }
        let share = |lengths: &[Lanes], span: usize, point: usize| {
            let sum = |lanes: &[Lanes]| (0..span).map(|k| lanes[first + point + k].0[lane]).sum::<f32>();
            sum(lengths) / sum(&rest.stretch)
        };
        for point in 0..points - 2 {
            lengths.bend[first + point].0[lane] =
                rest.bend[first + point].0[lane] * share(&lengths.stretch, 2, point);
        }
        for point in 0..points - 3 {
            lengths.torsion[first + point].0[lane] =
                rest.torsion[first + point].0[lane] * share(&lengths.stretch, 3, point);
        }
    }
}

/// Moves the points of a block to the given lengths along the directions that its segments have.
pub(crate) fn slide(positions: &mut [Vec3Lanes], lengths: &[Lanes]) {
    for lane in 0..LANES {
        let mut before = positions[0].get(lane);
        let mut moved = before;
        for point in 1..positions.len() {
            let here = positions[point].get(lane);
            let along = here - before;
            let length = if point == 1 { along.length() } else { lengths[point - 1].0[lane] };
            moved += along.normalize_or(Vec3::NEG_Y) * length;
            before = here;
            positions[point].set(lane, moved);
        }
    }
}
