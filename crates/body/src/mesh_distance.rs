//! Signed distance from a closed mesh to the nodes of a lattice.

use glam::DVec3;
use rayon::prelude::*;

use crate::Mesh;
use crate::buried::OutsideCounts;
use crate::far_nodes::FarNodes;
use crate::inside::inside_nodes;
use crate::lattice::{Lattice, SLAB};
use crate::layers::{Corners, Layers};
use crate::near_surface::{REACH, paint};
use crate::triangle_tree::{Nearest, TriangleTree};

/// Triangles that are looked at for all nodes together, and for each node, on the average: far more than
/// meshes of bodies need. Where triangles overlap so much that it does not suffice, as thousands of thin
/// ones that meet in one vertex, what is found beyond [`REACH`] of the surface may be further than the nearest.
const LOOKS: u64 = 100_000_000;
const LOOKS_OF_A_NODE: u64 = 32;

/// Signed distance \[m\] at each node, in the order of storage.
///
/// The distance is exact, from the nearest triangle; of a large lattice it may be less more than ten cells from the
/// surface, by half a cell where the surface is smooth ([`FarNodes`]). Its sign comes from counting the surface along
/// lines of nodes, since the sign that the nearest triangle gives is wrong near its edges.
pub(crate) fn at_nodes(mesh: &Mesh, lattice: &Lattice) -> Vec<f32> {
    let triangles = corners_in_cells(mesh, lattice);
    let all = || (0..triangles.len() as u32).collect();
    let inside = inside_nodes(&Layers::new(&triangles, all()), signed_volume(&triangles) < 0.0, lattice);
    let outside = OutsideCounts::new(&inside, lattice);
    let mut skin: Vec<u32> = all();
    skin.retain(|index| !outside.is_buried(&triangles[*index as usize]));
    drop(outside);
    if skin.is_empty() {
        // No node lies outside near the surface only when no triangle has an extent.
        skin = all();
    }
    let tree = TriangleTree::new(&triangles, skin.clone());
    let layers = Layers::new(&triangles, skin);
    let far = FarNodes::new(&tree, lattice, LOOKS / lattice.len() as u64 * LOOKS_OF_A_NODE);
    let mut distances = vec![0.0; lattice.len()];
    distances.par_chunks_mut(lattice.layer_len() * SLAB).enumerate().for_each(|(slab, distances)| {
        let nearest = nearest_in_slab(&tree, &layers, far.as_ref(), lattice, slab * SLAB, distances.len());
        for (distance, nearest) in distances.iter_mut().zip(nearest) {
            *distance = (nearest.squared.sqrt() * f64::from(lattice.spacing)) as f32;
        }
    });
    distances.par_iter_mut().zip(inside).for_each(|(distance, inside)| {
        *distance = if inside { -*distance } else { *distance };
    });
    distances
}

/// The nearest triangle of each node of some layers.
fn nearest_in_slab(
    tree: &TriangleTree,
    layers: &Layers,
    far: Option<&FarNodes>,
    lattice: &Lattice,
    first_layer: usize,
    count: usize,
) -> Vec<Nearest> {
    let layer_len = lattice.layer_len();
    let strides = [1, lattice.node_count.x as usize, layer_len];
    let mut nearest = vec![Nearest::NONE; count];
    paint(layers, lattice, first_layer, &mut nearest);
    let mut looks = count as u64 * (LOOKS / lattice.len() as u64).max(LOOKS_OF_A_NODE);
    for index in 0..count {
        if nearest[index].squared <= REACH * REACH {
            continue;
        }
        let node = lattice.node(first_layer * layer_len + index);
        if let Some(known) = far.and_then(|far| far.at(node, lattice)) {
            nearest[index] = known;
            continue;
        }
        let point = node.as_dvec3();
        let place = [node.x as usize, node.y as usize, node.z as usize - first_layer];
        // What is nearest to a neighbour is nearly the nearest here: the search only has to make sure.
        let mut found = nearest[index];
        for (place, stride) in place.into_iter().zip(strides) {
            if place > 0 && nearest[index - stride].triangle != found.triangle {
                tree.offer(nearest[index - stride].triangle, point, &mut found);
            }
        }
        // None takes so much that nothing is left to the others.
        let seen = tree.search(point, (looks / 128).max(LOOKS_OF_A_NODE), &mut found);
        looks = looks.saturating_sub(seen);
        nearest[index] = found;
    }
    nearest
}

/// How much work the extent of triangles is at a spacing \[m\], in nodes that look at one: long and large
/// triangles pass many cells.
pub(crate) fn work(mesh: &Mesh, spacing: f32) -> f64 {
    let of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize].as_dvec3());
        let longest = (b - a).length().max((c - b).length()).max((a - c).length()) / f64::from(spacing);
        let area = (b - a).cross(c - a).length() / f64::from(spacing).powi(2);
        40.0 * (0.5 * longest + 0.25 * area)
    };
    mesh.triangles.iter().map(of).sum()
}

/// Corners of the triangles in cells from the first node: numbers near 1 stay sharp, wherever and however
/// large the mesh is.
fn corners_in_cells(mesh: &Mesh, lattice: &Lattice) -> Vec<Corners> {
    let in_cells = |index: u32| {
        (mesh.positions[index as usize].as_dvec3() - lattice.origin.as_dvec3()) / f64::from(lattice.spacing)
    };
    mesh.triangles.iter().map(|corners| corners.map(in_cells)).collect()
}

/// Volume inside the surface, in cells; negative when it is inside out.
fn signed_volume(triangles: &[Corners]) -> f64 {
    triangles.iter().map(|[a, b, c]: &[DVec3; 3]| a.dot(b.cross(*c)) / 6.0).sum()
}
