use std::collections::HashMap;

use glam::Vec3;
use strandline_base::par::prelude::*;

/// Splits the edges whose middle lies where `is_fine` says, all triangles about them with them, so that a closed
/// surface stays closed. Returns the ends of the edge of each new vertex, which come behind the others.
pub(super) fn split(
    positions: &[Vec3],
    triangles: &mut Vec<[u32; 3]>,
    is_fine: impl Fn(Vec3) -> bool + Sync,
) -> Vec<[u32; 2]> {
    let middle = |[a, b]: [u32; 2]| 0.5 * (positions[a as usize] + positions[b as usize]);
    let fine: Vec<[bool; 3]> =
        triangles.par_iter().map(|corners| edges(*corners).map(|edge| is_fine(middle(edge)))).collect();
    let (mut known, mut ends) = (HashMap::new(), Vec::new());
    let mut found = Vec::with_capacity(triangles.len());
    for (corners, fine) in triangles.iter().zip(fine) {
        let mut middles = [None; 3];
        for (side, edge) in edges(*corners).into_iter().enumerate().filter(|(side, _)| fine[*side]) {
            middles[side] = Some(*known.entry(edge).or_insert_with(|| {
                ends.push(edge);
                (positions.len() + ends.len() - 1) as u32
            }));
        }
        parts(*corners, middles, &mut found);
    }
    *triangles = found;
    ends
}

/// Edges of a triangle, the lower index first, so that both of its triangles see the same one.
fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
}

/// The parts of a triangle some of whose edges have a new vertex in their middle.
fn parts([a, b, c]: [u32; 3], middles: [Option<u32>; 3], found: &mut Vec<[u32; 3]>) {
    match middles {
        [None, None, None] => found.push([a, b, c]),
        [Some(ab), None, None] => found.extend([[a, ab, c], [ab, b, c]]),
        [None, Some(_), None] => parts([b, c, a], [middles[1], None, None], found),
        [None, None, Some(_)] => parts([c, a, b], [middles[2], None, None], found),
        [Some(ab), Some(bc), None] => found.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
        [None, Some(_), Some(_)] => parts([b, c, a], [middles[1], middles[2], None], found),
        [Some(_), None, Some(_)] => parts([c, a, b], [middles[2], middles[0], None], found),
        [Some(ab), Some(bc), Some(ca)] => {
            found.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
    }
}
