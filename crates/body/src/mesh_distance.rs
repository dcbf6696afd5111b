//! Signed distance from a closed mesh to the nodes of a lattice.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec3, Vec3};
use strandline_base::par::prelude::*;

use crate::buried::OutsideCounts;
use crate::far_nodes::FarNodes;
use crate::inside::inside_nodes;
use crate::lattice::{Lattice, SLAB};
use crate::layers::{Corners, Layers};
use crate::near_surface::{REACH, paint};
use crate::triangle_tree::{Nearest, TriangleTree};
use crate::{Aabb, BodyError, Mesh};

/// Triangles that are looked at for all nodes together, and for each node, on the average: more than meshes of bodies
/// need. Where triangles overlap so much that it does not suffice, as thousands of thin ones that meet in one vertex,
/// [`spread`] finds what is nearest beyond [`REACH`] of the surface, to about a quarter of a cell.
const LOOKS: u64 = 100_000_000;
const LOOKS_OF_A_NODE: std::ops::RangeInclusive<u64> = 32..=128;

/// Most cells along a side of the lattice that finds shells within others.
const SIDE_OF_SHELLS: f32 = 256.0;

/// Signed distance \[m\] at each node, in the order of storage.
///
/// The distance is exact, from the nearest triangle; of a large lattice it may be less more than seven cells from the
/// surface, by a seventh of a cell, and by 0.4 more than ten cells ([`FarNodes`]). Its sign comes from counting the surface along
/// lines of nodes, since the sign that the nearest triangle gives is wrong near its edges. With the looks of all
/// searches ([`TriangleTree::looks`]).
pub(crate) fn at_nodes(mesh: &Mesh, lattice: &Lattice) -> (Vec<f32>, [u64; 2]) {
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
    let far = FarNodes::new(&tree, lattice, LOOKS / lattice.len() as u64 * LOOKS_OF_A_NODE.start());
    let mut found = vec![NodeDistance::default(); lattice.len()];
    let sufficed = AtomicBool::new(true);
    found.par_chunks_mut(lattice.layer_len() * SLAB).enumerate().for_each(|(slab, found)| {
        if !nearest_in_slab(&tree, &layers, far.as_ref(), lattice, slab * SLAB, found) {
            sufficed.store(false, Ordering::Relaxed);
        }
    });
    if !sufficed.into_inner() {
        spread(&tree, lattice, &mut found);
    }
    let mut distances: Vec<f32> = found.iter().map(|found| found.distance * lattice.spacing).collect();
    distances.par_iter_mut().zip(inside).for_each(|(distance, inside)| {
        *distance = if inside { -*distance } else { *distance };
    });
    (distances, tree.looks())
}

/// Indices of the triangles of a closed mesh that are not within another of its shells, found at a spacing \[m\] at least,
/// and -1 for a mesh that is inside out, else 1.
pub(crate) fn skin_triangles(mesh: &Mesh, spacing: f32) -> Result<(Vec<u32>, f32), BodyError> {
    let bounds = mesh.bounds().unwrap_or(Aabb { min: Vec3::ZERO, max: Vec3::ZERO });
    let finest = (bounds.max - bounds.min).max_element() / SIDE_OF_SHELLS;
    let lattice = Lattice::around(bounds, spacing.max(finest), 0.0)?;
    let triangles = corners_in_cells(mesh, &lattice);
    let mut skin: Vec<u32> = (0..triangles.len() as u32).collect();
    let is_turned = signed_volume(&triangles) < 0.0;
    let inside = inside_nodes(&Layers::new(&triangles, skin.clone()), is_turned, &lattice);
    let outside = OutsideCounts::new(&inside, &lattice);
    skin.retain(|index| !outside.is_buried(&triangles[*index as usize]));
    Ok((skin, if is_turned { -1.0 } else { 1.0 }))
}

/// Distance of a node from the nearest triangle.
#[derive(Clone, Copy, Default)]
struct NodeDistance {
    /// \[cells\].
    distance: f32,
    triangle: u32,
}

/// The nearest triangle of each node of some layers, and whether there were looks enough to be sure of it.
fn nearest_in_slab(
    tree: &TriangleTree,
    layers: &Layers,
    far: Option<&FarNodes>,
    lattice: &Lattice,
    first_layer: usize,
    found: &mut [NodeDistance],
) -> bool {
    let layer_len = lattice.layer_len();
    let strides = [1, lattice.node_count.x as usize, layer_len];
    let mut nearest = vec![Nearest::NONE; found.len()];
    paint(layers, lattice, first_layer, &mut nearest);
    let (least, most) = LOOKS_OF_A_NODE.into_inner();
    let mut looks = found.len() as u64 * (LOOKS / lattice.len() as u64).clamp(least, most);
    let mut sufficed = true;
    for index in 0..found.len() {
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
        // The nearest triangle of a neighbour is nearly the nearest here: it bounds the search.
        let mut here = nearest[index];
        for (place, stride) in place.into_iter().zip(strides) {
            if place > 0 && nearest[index - stride].triangle != here.triangle {
                tree.offer(nearest[index - stride].triangle, point, &mut here);
            }
        }
        // None takes so much that nothing is left to the others.
        let budget = (looks / 128).max(least);
        let seen = tree.search(point, budget, &mut here);
        sufficed &= seen < budget;
        looks = looks.saturating_sub(seen);
        nearest[index] = here;
    }
    for (found, nearest) in found.iter_mut().zip(nearest) {
        *found = NodeDistance { distance: nearest.squared.sqrt() as f32, triangle: nearest.triangle };
    }
    sufficed
}

/// Offers every node the triangles that are nearest to its neighbours, through the lattice and back: from what is
/// near the surface, which is exact, the nearest spreads to all others \[Danielsson1980\].
fn spread(tree: &TriangleTree, lattice: &Lattice, found: &mut [NodeDistance]) {
    let strides = [1, lattice.node_count.x as usize, lattice.layer_len()];
    let last = (lattice.node_count - 1).to_array();
    let mut offer = |index: usize, back: bool| {
        let node = lattice.node(index);
        let mut here = found[index];
        for ((place, last), stride) in node.to_array().into_iter().zip(last).zip(strides) {
            let beside = match back {
                false if place > 0 => found[index - stride],
                true if place < last => found[index + stride],
                _ => continue,
            };
            if beside.triangle != here.triangle {
                let mut nearest =
                    Nearest { squared: f64::from(here.distance).powi(2), triangle: here.triangle };
                tree.offer(beside.triangle, node.as_dvec3(), &mut nearest);
                here = NodeDistance { distance: nearest.squared.sqrt() as f32, triangle: nearest.triangle };
            }
        }
        found[index] = here;
    };
    for _ in 0..2 {
        (0..lattice.len()).for_each(|index| offer(index, false));
        (0..lattice.len()).rev().for_each(|index| offer(index, true));
    }
}

/// Work that the extent of triangles causes at a spacing \[m\], in nodes that look at a triangle: long and
/// large triangles pass many cells.
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
