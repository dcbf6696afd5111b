//! Moves drawn points between the points of bound strands, and about them, out of the body.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::PlacedSolids;

use super::interpolate::differentiate;
use crate::cpu::Curves;
use crate::strands::Strands;

/// Times that a point is moved at most.
const MOVES: usize = 8;
/// Rounding of parameters.
const ROUNDING: f32 = 1e-3;

/// Moves points of strands that lie inside solids onto their surface; not those of the first span, which leads out of
/// the skin. `curves` are those that the strands were grown about, `points_per_strand` is that of the guides.
pub fn keep_outside(strands: &mut Strands, curves: &Curves, points_per_strand: usize, solids: &PlacedSolids) {
    let span = 1.0 / (points_per_strand - 1) as f32;
    let first = curves.parameters.iter().position(|parameter| *parameter > (1.0 - ROUNDING) * span);
    let Some(first) = first.filter(|_| !solids.is_empty()) else { return };
    let count = strands.points_per_strand;
    strands.positions.par_chunks_mut(count).zip_eq(strands.tangents.par_chunks_mut(count)).for_each(
        |(positions, tangents)| {
            if keep_strand_outside(&mut positions[first..], solids) {
                differentiate(positions, tangents);
            }
        },
    );
}

/// Moves points of a strand out; whether there were such.
fn keep_strand_outside(points: &mut [Vec3], solids: &PlacedSolids) -> bool {
    // Lower bound of the distance [m] to the surface.
    let (mut clear, mut before) = (0.0, points[0]);
    let mut moved = false;
    for point in points {
        clear -= point.distance(before);
        before = *point;
        if clear <= 0.0 {
            clear = solids.at_least(before);
        }
        if clear <= 0.0 {
            (*point, clear) = outside(before, solids);
            moved |= *point != before;
        }
    }
    moved
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
