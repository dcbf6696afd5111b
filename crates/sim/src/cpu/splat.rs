//! `splat`: points become velocities on the faces of the staggered grid.

use glam::Vec3;
use strandline_base::par::{self, prelude::*};
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use super::cell_sort::NO_CELL;
use super::faces::{Carried, Stencil};
use super::grid::REACH;
use super::volume::Volume;

/// Sorts the points by cell [Chen2011 fig. 26-30] and gives every face that they reach their mean
/// velocity, weighted by mass and trilinearly \[Zhu2005\]. Momentum is kept exactly.
///
/// All shapes are `[block][point]` of lanes, world space. Lanes beyond the last strand and points
/// without mass or too far away take no part. One task per component sums the points in the order
/// of their cells, so that sums do not depend on the number of threads.
pub fn splat(volume: &mut Volume, positions: &[Vec3Lanes], velocities: &[Vec3Lanes], mass: &[Lanes]) {
    follow(volume, positions, mass);
    find_cells(volume, positions, mass);
    volume.sort.sort(&volume.cell_of_point);
    clear(volume);
    touch(volume);
    carry(volume, positions, velocities, mass);
    let Volume { grid, carried, faces, touched, .. } = volume;
    let strides = grid.strides();
    let [u, v, w] = &mut faces.components;
    par::join(
        || component::<0>(strides, carried, touched, u),
        || {
            par::join(
                || component::<1>(strides, carried, touched, v),
                || component::<2>(strides, carried, touched, w),
            )
        },
    );
}

/// Whether a point takes part: it has a mass and lies somewhere.
#[inline]
fn takes_part(point: Vec3, mass: f32) -> bool {
    // False for coordinates that are not numbers.
    mass > 0.0 && point.abs().max_element() < REACH
}

/// Moves the box over the points.
fn follow(volume: &mut Volume, positions: &[Vec3Lanes], mass: &[Lanes]) {
    let points = volume.points_per_strand;
    let outside_in = || (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    let volume_ref = &*volume;
    let (low, high) = positions
        .par_chunks(points)
        .zip(mass.par_chunks(points))
        .with_min_len(64)
        .enumerate()
        .map(|(block, (positions, mass))| {
            let mut bounds = outside_in();
            for (point, mass) in positions.iter().zip(mass) {
                for lane in (0..LANES).filter(|lane| volume_ref.is_live(block, *lane)) {
                    let place = point.get(lane);
                    if takes_part(place, mass.0[lane]) {
                        bounds = (bounds.0.min(place), bounds.1.max(place));
                    }
                }
            }
            bounds
        })
        // Smallest and largest do not depend on the order.
        .reduce(outside_in, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    if low.x <= high.x {
        volume.grid.follow(low, high);
    }
}

fn find_cells(volume: &mut Volume, positions: &[Vec3Lanes], mass: &[Lanes]) {
    let (points, strands) = (volume.points_per_strand, volume.strand_count);
    volume.cell_of_point.resize(positions.len() * LANES, NO_CELL);
    let grid = &volume.grid;
    volume
        .cell_of_point
        .par_chunks_mut(LANES)
        .zip(positions)
        .zip(mass)
        .with_min_len(512)
        .enumerate()
        .for_each(|(index, ((cells, point), mass))| {
            for (lane, cell) in cells.iter_mut().enumerate() {
                let live =
                    index / points * LANES + lane < strands && takes_part(point.get(lane), mass.0[lane]);
                let place = if live { grid.place(point.get(lane)) } else { None };
                *cell = place.map_or(NO_CELL, |place| place.cell as u32);
            }
        });
}

/// Forgets what the last step summed.
fn clear(volume: &mut Volume) {
    for component in &mut volume.faces.components {
        for &cell in &volume.touched {
            component[2 * cell as usize..][..2].fill(0.0);
        }
    }
}

/// Lists the occupied cells and the 26 around each: all faces that a stencil may reach.
fn touch(volume: &mut Volume) {
    let Volume { grid, sort, touched, touched_set, spare_set, .. } = volume;
    touched_set.copy_from(sort.occupied());
    for stride in grid.strides() {
        spare_set.copy_from(touched_set);
        touched_set.insert_neighbours(spare_set, stride);
    }
    touched_set.list_into(touched);
}

/// Gathers what the points bring in the order of their cells: the components read it three times in a row.
fn carry(volume: &mut Volume, positions: &[Vec3Lanes], velocities: &[Vec3Lanes], mass: &[Lanes]) {
    let Volume { grid, sort, carried, .. } = volume;
    let bring = |&point: &u32| {
        let (index, lane) = (point as usize / LANES, point as usize % LANES);
        let place = grid.place(positions[index].get(lane)).expect("a point that is sorted has a cell");
        Carried { place, mass: mass[index].0[lane], velocity: velocities[index].get(lane) }
    };
    sort.order().par_iter().with_min_len(1024).map(bring).collect_into_vec(carried);
}

fn component<const AXIS: usize>(
    strides: [usize; 3],
    carried: &[Carried],
    touched: &[u32],
    component: &mut [f32],
) {
    for Carried { place, mass, velocity } in carried {
        Stencil::new::<AXIS>(place, strides).add(component, strides, *mass, velocity[AXIS]);
    }
    for &cell in touched {
        let pair = &mut component[2 * cell as usize..][..2];
        let velocity = if pair[1] > 0.0 { pair[0] / pair[1] } else { 0.0 };
        pair.copy_from_slice(&[velocity, 0.0]);
    }
}
