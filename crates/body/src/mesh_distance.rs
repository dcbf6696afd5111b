//! Signed distance from a closed mesh to the nodes of a lattice.

use glam::{DVec3, UVec3};
use rayon::prelude::*;
use rstar::RTree;

use crate::Mesh;
use crate::inside::inside_nodes;
use crate::lattice::Lattice;
use crate::triangle::Triangle;

/// Signed distance \[m\] at each node, in the order of storage.
///
/// The distance is exact, from the nearest triangle. Its sign comes from counting the surface along
/// lines of nodes, since the sign that the nearest triangle gives is wrong near its edges.
pub(crate) fn at_nodes(mesh: &Mesh, lattice: &Lattice) -> Vec<f32> {
    let triangles = corners_in_cells(mesh, lattice);
    let mut inside = inside_nodes(&triangles, lattice);
    if signed_volume(&triangles) < 0.0 {
        let inverted: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        inside = inside_nodes(&inverted, lattice);
    }
    let mut skin: Vec<_> = triangles.iter().filter(|corners| !is_buried(corners, &inside, lattice)).collect();
    if skin.is_empty() {
        // No node lies outside near the surface only when no triangle has an extent.
        skin = triangles.iter().collect();
    }
    let skin = RTree::bulk_load(skin.into_iter().copied().map(Triangle::new).collect());
    let mut distances = vec![0.0; lattice.len()];
    distances.par_iter_mut().zip(&inside).enumerate().for_each(|(index, (distance, inside))| {
        let node = lattice.node(index).as_dvec3();
        // A body without triangles is refused before, so there is always a nearest one.
        let squared =
            skin.nearest_neighbor_iter_with_distance_2(&node.to_array()).next().map_or(0.0, |(_, d)| d);
        let length = (squared.sqrt() * f64::from(lattice.spacing)) as f32;
        *distance = if *inside { -length } else { length };
    });
    distances
}

/// Corners of the triangles in cells from the first node: numbers near 1 keep single precision
/// sharp, wherever and however large the mesh is.
fn corners_in_cells(mesh: &Mesh, lattice: &Lattice) -> Vec<[DVec3; 3]> {
    let in_cells = |index: u32| {
        (mesh.positions[index as usize].as_dvec3() - lattice.origin.as_dvec3()) / f64::from(lattice.spacing)
    };
    mesh.triangles.iter().map(|corners| corners.map(in_cells)).collect()
}

/// Volume inside the surface, in cells; negative when it is inside out.
fn signed_volume(triangles: &[[DVec3; 3]]) -> f64 {
    triangles.iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum()
}

/// Whether all nodes within a cell of a triangle are inside: then it is part of a shell within another
/// one and no place of the skin.
fn is_buried(corners: &[DVec3; 3], inside: &[bool], lattice: &Lattice) -> bool {
    let last = (lattice.node_count - 1).as_dvec3();
    let low = corners.iter().fold(last, |low, corner| low.min(*corner));
    let high = corners.iter().fold(DVec3::ZERO, |high, corner| high.max(*corner));
    let low = (low.floor() - 1.0).max(DVec3::ZERO).as_uvec3();
    let high = (high.ceil() + 1.0).min(last).as_uvec3();
    (low.z..=high.z).all(|z| {
        (low.y..=high.y).all(|y| {
            let row = lattice.index(UVec3::new(low.x, y, z))..=lattice.index(UVec3::new(high.x, y, z));
            inside[row].iter().all(|inside| *inside)
        })
    })
}
