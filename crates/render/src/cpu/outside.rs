//! What `tessellate` draws between the points of bound strands is kept out of the body.

use glam::Vec3;
use rayon::prelude::*;
use strandline_body::PlacedSolids;
use strandline_groom::LANES;

use super::Curves;

/// Times that a point is moved at most.
const MOVES: usize = 8;
/// Rounding of parameters.
const ROUNDING: f32 = 1e-3;

/// Moves points of curves that lie inside solids onto their surface; not those of the first span, which leads out of
/// the skin. `points_per_strand` is that of the guides. Tangents and normals stay.
pub fn keep_outside(curves: &mut Curves, points_per_strand: usize, solids: &PlacedSolids) {
    let Curves { points_per_curve, parameters, positions, .. } = curves;
    let span = 1.0 / (points_per_strand - 1) as f32;
    let first = parameters.iter().position(|parameter| *parameter > (1.0 - ROUNDING) * span);
    let Some(first) = first.filter(|_| !solids.is_empty()) else { return };
    positions.par_chunks_mut(*points_per_curve).for_each(|curve| {
        for lane in 0..LANES {
            // How far [m] the surface is at least.
            let (mut clear, mut before) = (0.0, curve[first].get(lane));
            for point in &mut curve[first..] {
                let here = point.get(lane);
                clear -= here.distance(before);
                before = here;
                if clear <= 0.0 {
                    clear = solids.at_least(here);
                }
                if clear <= 0.0 {
                    let (placed, distance) = outside(here, solids);
                    clear = distance;
                    point.set(lane, placed);
                }
            }
        }
    });
}

/// A point that is not inside, and how far \[m\] the surface was, 0 from within.
fn outside(point: Vec3, solids: &PlacedSolids) -> (Vec3, f32) {
    let (mut distance, mut normal) = solids.at(point);
    let clear = distance.max(0.0);
    let mut placed = point;
    for _ in 0..MOVES {
        if distance >= 0.0 {
            break;
        }
        placed -= normal * distance;
        (distance, normal) = solids.at(placed);
    }
    (placed, clear)
}
