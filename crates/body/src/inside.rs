//! Which nodes of a lattice are inside a closed surface.

use glam::{DVec3, UVec3};
use rayon::prelude::*;

use crate::lattice::Lattice;

/// Where a line of nodes passes the surface.
struct Crossing {
    /// Place along the line \[cells\].
    x: f64,
    /// How much more often the surface winds around the nodes beyond.
    turns: i32,
}

/// Whether the surface winds around each node, in the order of storage.
///
/// Triangles are given in cells. Each line of nodes along x counts the triangles that it
/// passes, with their direction: the winding number \[Jacobson2013\] of a closed surface, as an integer.
/// A line through an edge or a corner counts one of the triangles that meet there, never two and
/// never none, because each edge decides alone, from its two ends, on which side the line passes it.
pub(crate) fn inside_nodes(triangles: &[[DVec3; 3]], lattice: &Lattice) -> Vec<bool> {
    let layers = triangles_by_layer(triangles, lattice);
    let mut inside = vec![false; lattice.len()];
    inside.par_chunks_mut(lattice.layer_len()).zip(layers).enumerate().for_each(|(z, (layer, indices))| {
        let mut lines: Vec<Vec<Crossing>> = (0..lattice.node_count.y).map(|_| Vec::new()).collect();
        for index in indices {
            add_crossings(&triangles[index as usize], z as f64, &mut lines);
        }
        for (row, crossings) in layer.chunks_mut(lattice.node_count.x as usize).zip(&mut lines) {
            mark_row(row, crossings);
        }
    });
    inside
}

/// For each layer of equal z, the triangles that reach over it.
fn triangles_by_layer(triangles: &[[DVec3; 3]], lattice: &Lattice) -> Vec<Vec<u32>> {
    let UVec3 { z: layer_count, .. } = lattice.node_count;
    let mut layers = vec![Vec::new(); layer_count as usize];
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        let first = a.z.min(b.z).min(c.z).ceil().max(0.0) as usize;
        let last = a.z.max(b.z).max(c.z).floor();
        for layer in layers.iter_mut().take((last + 1.0).max(0.0) as usize).skip(first) {
            layer.push(index as u32);
        }
    }
    layers
}

fn add_crossings(corners: &[DVec3; 3], z: f64, lines: &mut [Vec<Crossing>]) {
    let [a, b, c] = *corners;
    let first = a.y.min(b.y).min(c.y).ceil().max(0.0) as usize;
    let count = (a.y.max(b.y).max(c.y).floor() + 1.0).max(0.0) as usize;
    for (y, line) in lines.iter_mut().enumerate().take(count).skip(first) {
        let y = y as f64;
        // Around a line along x: once forward, once back, or not at all.
        let turns = edge_turn(a, b, y, z) + edge_turn(b, c, y, z) + edge_turn(c, a, y, z);
        if turns != 0 {
            line.push(Crossing { x: place(corners, y, z), turns });
        }
    }
}

/// Whether an edge passes the half-line from y, z towards larger y upwards (1), downwards (-1) or not (0).
///
/// The two triangles of an edge see it in opposite directions and get opposite numbers exactly, since
/// the place is computed from the lower end in both.
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

/// Where the plane of a triangle passes the line y, z; within the triangle also when it holds the line.
fn place(corners: &[DVec3; 3], y: f64, z: f64) -> f64 {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let x = a.x - ((y - a.y) * normal.y + (z - a.z) * normal.z) / normal.x;
    let (low, high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
    if x.is_nan() { 0.5 * (low + high) } else { x.clamp(low, high) }
}

fn mark_row(row: &mut [bool], crossings: &mut [Crossing]) {
    crossings.sort_by(|one, other| one.x.total_cmp(&other.x).then(one.turns.cmp(&other.turns)));
    let (mut winding, mut next) = (0, 0);
    for (x, inside) in row.iter_mut().enumerate() {
        while next < crossings.len() && crossings[next].x <= x as f64 {
            // A triangle that turns forward around +x faces +x: the line leaves there.
            winding -= crossings[next].turns;
            next += 1;
        }
        *inside = winding > 0;
    }
}
