//! Nodes of a lattice that are inside a closed surface.

use glam::DVec3;
use strandline_base::par::prelude::*;

use crate::lattice::{Lattice, SLAB};
use crate::layers::{Corners, Layers};

/// For each node, in the order of storage: true if the surface winds around it. `turned` reverses every
/// triangle.
///
/// Triangles are given in cells. Each line of nodes along x counts the triangles that it passes, with their
/// direction: the winding number \[Jacobson2013\] of a closed surface, as an integer. A line through an edge
/// or a corner counts exactly one of the triangles that meet there, because each edge decides alone, from its
/// two ends, on which side the line passes it.
pub(crate) fn inside_nodes(layers: &Layers, turned: bool, lattice: &Lattice) -> Vec<bool> {
    let mut inside = vec![false; lattice.len()];
    let (layer_len, columns) = (lattice.layer_len(), lattice.node_count.x as usize);
    inside.par_chunks_mut(layer_len * SLAB).enumerate().for_each(|(slab, inside)| {
        let first = slab * SLAB;
        let last = first + inside.len() / layer_len - 1;
        let reached = layers.between(first as f64, last as f64);
        // Change of the winding number at each node of a layer from the one before it in its row.
        let mut changes = vec![0_i32; layer_len];
        for (layer, inside) in inside.chunks_mut(layer_len).enumerate() {
            changes.fill(0);
            let z = (first + layer) as f64;
            for index in &reached {
                add_changes(&layers.triangles()[*index as usize], z, columns, &mut changes);
            }
            let rows = inside.chunks_mut(columns).zip(changes.chunks(columns));
            rows.for_each(|(inside, changes)| mark_row(inside, changes, turned));
        }
    });
    inside
}

fn add_changes(corners: &Corners, z: f64, columns: usize, changes: &mut [i32]) {
    let [a, b, c] = *corners;
    if a.z.min(b.z).min(c.z) > z || a.z.max(b.z).max(c.z) < z {
        return;
    }
    let first = a.y.min(b.y).min(c.y).ceil().max(0.0) as usize;
    let count = (a.y.max(b.y).max(c.y).floor() + 1.0).max(0.0) as usize;
    for (y, row) in changes.chunks_mut(columns).enumerate().take(count).skip(first) {
        let y = y as f64;
        // Around a line along x: once forward, once back, or not at all.
        let turns = edge_turn(a, b, y, z) + edge_turn(b, c, y, z) + edge_turn(c, a, y, z);
        if turns != 0
            && let Some(change) = row.get_mut(place(corners, y, z).ceil().max(0.0) as usize)
        {
            // A triangle that turns forward around +x faces +x: the line leaves there.
            *change -= turns;
        }
    }
}

/// Direction in which an edge passes the half-line from y, z towards larger y: upwards (1), downwards (-1) or
/// not at all (0).
///
/// The two triangles of an edge see it in opposite directions and get exactly opposite numbers, since the
/// place is computed from the lower end in both.
fn edge_turn(start: DVec3, end: DVec3, y: f64, z: f64) -> i32 {
    let up = start.z <= z && end.z > z;
    let down = end.z <= z && start.z > z;
    if !up && !down {
        return 0;
    }
    let (low, high) = if up { (start, end) } else { (end, start) };
    let passes_at = low.y + (z - low.z) / (high.z - low.z) * (high.y - low.y);
    if passes_at <= y {
        return 0;
    }
    if up { 1 } else { -1 }
}

/// Place at which the plane of a triangle passes the line y, z; within the triangle also if it holds the
/// line.
fn place(corners: &Corners, y: f64, z: f64) -> f64 {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let x = a.x - ((y - a.y) * normal.y + (z - a.z) * normal.z) / normal.x;
    let (low, high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
    if x.is_nan() { 0.5 * (low + high) } else { x.clamp(low, high) }
}

fn mark_row(inside: &mut [bool], changes: &[i32], turned: bool) {
    let mut winding = 0;
    for (inside, change) in inside.iter_mut().zip(changes) {
        winding += change;
        *inside = if turned { winding < 0 } else { winding > 0 };
    }
}
