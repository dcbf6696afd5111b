//! The nearest triangle of every node that is near the surface.

use glam::{DVec3, UVec3};

use crate::lattice::Lattice;
use crate::layers::{Corners, Layers};
use crate::triangle::{distance_squared, is_beyond_plane};
use crate::triangle_tree::Nearest;

/// Nodes within this distance \[cells\] of the surface are painted.
pub(crate) const REACH: f64 = 1.0;
/// Longest edge \[cells\] of a piece whose box is not divided any more.
const PIECE: f64 = 2.0;

/// Tells the nodes of some layers, from the first one on, about every triangle within [`REACH`] of them: what
/// is then known no further than that is the nearest of all.
pub(crate) fn paint(layers: &Layers, lattice: &Lattice, first_layer: usize, nearest: &mut [Nearest]) {
    let layer_len = lattice.layer_len();
    let last_layer = first_layer + nearest.len() / layer_len - 1;
    let low = DVec3::new(0.0, 0.0, first_layer as f64);
    let high = (lattice.node_count - 1).as_dvec3().with_z(last_layer as f64);
    let mut pieces: Vec<Corners> = Vec::new();
    for triangle in layers.between(low.z - REACH, high.z + REACH) {
        let corners = &layers.triangles()[triangle as usize];
        pieces.push(*corners);
        while let Some(piece) = pieces.pop() {
            let Some([first, last]) = nodes_around(&piece, low, high) else { continue };
            if let Some(halves) = halves(&piece) {
                pieces.extend(halves);
                continue;
            }
            let [least, most] = corners_of_box(&piece);
            for_each_node(first, last, |node| {
                let point = node.as_dvec3();
                let known = &mut nearest[lattice.index(node) - first_layer * layer_len];
                let beside = (point - point.clamp(least, most)).length_squared();
                if beside >= known.squared.min(REACH * REACH) || is_beyond_plane(corners, point, REACH) {
                    return;
                }
                let squared = distance_squared(corners, point);
                if squared < known.squared {
                    *known = Nearest { squared, triangle };
                }
            });
        }
    }
}

/// The nodes between two corners that may be within reach of a piece.
fn nodes_around(piece: &Corners, low: DVec3, high: DVec3) -> Option<[UVec3; 2]> {
    let [least, most] = corners_of_box(piece);
    let first = (least - REACH).ceil().max(low);
    let last = (most + REACH).floor().min(high);
    first.cmple(last).all().then(|| [first.as_uvec3(), last.as_uvec3()])
}

fn corners_of_box([a, b, c]: &Corners) -> [DVec3; 2] {
    [a.min(*b).min(*c), a.max(*b).max(*c)]
}

/// A piece divided at the middle of its longest edge, unless it is small.
fn halves(piece: &Corners) -> Option<[Corners; 2]> {
    let [a, b, c] = *piece;
    let squares = [(b - a), (c - b), (a - c)].map(|edge| edge.length_squared());
    let longest = (0..3).fold(0, |best, edge| if squares[edge] > squares[best] { edge } else { best });
    if squares[longest] <= PIECE * PIECE {
        return None;
    }
    let [start, end, apex] = [piece[longest], piece[(longest + 1) % 3], piece[(longest + 2) % 3]];
    let middle = 0.5 * (start + end);
    Some([[start, middle, apex], [middle, end, apex]])
}

fn for_each_node(first: UVec3, last: UVec3, mut visit: impl FnMut(UVec3)) {
    for z in first.z..=last.z {
        for y in first.y..=last.y {
            (first.x..=last.x).for_each(|x| visit(UVec3::new(x, y, z)));
        }
    }
}
