//! `splat`: points become velocities on the faces of the staggered grid.

use glam::Vec3;
use strandline_base::par::{self, prelude::*};
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::faces::{Carried, Faces, Stencil};
use super::volume::Volume;
use crate::cells::NO_CELL;
use crate::cells::grid::REACH;
use strandline_base::vec3x8::{Vec3x8, load, splat as all};

/// Sorts the points by cell [Chen2011 fig. 26-30] and gives every face that they reach their mean
/// velocity, weighted by mass and trilinearly \[Zhu2005\]. Momentum is kept exactly.
///
/// All shapes are `[block][point]` of lanes, world space. Lanes beyond the last strand and points
/// without mass or too far away take no part. Faces of a one-sided volume keep their masses \[kg\] in place of changes
/// until `mark`. A task sums layers of cells of its own, each face in the order
/// of the cells of its points, so that sums do not depend on the number of threads.
pub fn splat(volume: &mut Volume, positions: &[Vec3Lanes], velocities: &[Vec3Lanes], mass: &[Lanes]) {
    follow(volume, positions, mass);
    bring(volume, positions, velocities, mass);
    let Volume { sort, cell_of_point, faces, touched, .. } = volume;
    par::join(|| sort.sort(cell_of_point), || clear(faces, touched));
    touch(volume);
    let Volume { grid, sort, brought, carried, faces, touched, .. } = volume;
    let sorted = sort.order().par_iter().with_min_len(1024).map(|&point| brought[point as usize]);
    sorted.collect_into_vec(carried);
    let components = faces.components.each_mut().map(Vec::as_mut_slice);
    let kept = if volume.settings.is_one_sided() { 1.0 } else { 0.0 };
    Layers { first: 0, components, carried, touched, strides: grid.strides(), kept }
        .sum(par::current_num_threads());
}

/// Mask of the points that take part: they have a mass and lie somewhere. False for coordinates that are not numbers.
#[inline]
fn take_part(points: Vec3x8, mass: f32x8) -> f32x8 {
    let [x, y, z] = points.array().map(|coordinate| coordinate.abs().simd_lt(all(REACH)));
    mass.simd_gt(f32x8::ZERO) & x & y & z
}

/// Mask of the lanes of a block that are strands.
fn live_lanes(volume: &Volume, block: usize) -> f32x8 {
    let lane = |lane| if volume.is_live(block, lane) { 1.0 } else { 0.0 };
    f32x8::from(std::array::from_fn::<f32, LANES, _>(lane)).simd_gt(f32x8::ZERO)
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
            let live = live_lanes(volume_ref, block);
            let (mut low, mut high) = (Vec3x8::splat(Vec3::INFINITY), Vec3x8::splat(Vec3::NEG_INFINITY));
            for (point, mass) in positions.iter().zip(mass) {
                let place = Vec3x8::load(point);
                let counts = take_part(place, load(mass)) & live;
                low = least(low, place.or(counts, low));
                high = -least(-high, -place.or(counts, high));
            }
            let lanes = |of: Vec3x8| of.array().map(f32x8::to_array);
            let fold = |of: Vec3x8, pick: fn(f32, f32) -> f32, first: f32| {
                Vec3::from(lanes(of).map(|lanes| lanes.into_iter().fold(first, pick)))
            };
            (fold(low, f32::min, f32::INFINITY), fold(high, f32::max, f32::NEG_INFINITY))
        })
        // Smallest and largest do not depend on the order.
        .reduce(outside_in, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    if low.x <= high.x {
        volume.grid.follow(low, high);
    }
}

/// The smaller coordinates of two.
#[inline]
fn least(one: Vec3x8, other: Vec3x8) -> Vec3x8 {
    Vec3x8::new(one.x.fast_min(other.x), one.y.fast_min(other.y), one.z.fast_min(other.z))
}

/// Finds the cells of the points, and what each brings there.
fn bring(volume: &mut Volume, positions: &[Vec3Lanes], velocities: &[Vec3Lanes], mass: &[Lanes]) {
    let mut cell_of_point = std::mem::take(&mut volume.cell_of_point);
    let mut brought = std::mem::take(&mut volume.brought);
    cell_of_point.resize(positions.len() * LANES, NO_CELL);
    brought.resize(positions.len() * LANES, bytemuck::Zeroable::zeroed());
    let (points, volume_ref) = (volume.points_per_strand, &*volume);
    cell_of_point
        .par_chunks_mut(LANES)
        .zip(brought.par_chunks_mut(LANES))
        .zip(positions.par_iter().zip(velocities))
        .zip(mass)
        .with_min_len(512)
        .enumerate()
        .for_each(|(index, (((cells, brought), (position, velocity)), mass))| {
            let (position, velocity, mass) = (Vec3x8::load(position), Vec3x8::load(velocity), load(mass));
            let counts = take_part(position, mass) & live_lanes(volume_ref, index / points);
            let counts = counts.to_bitmask();
            let places = volume_ref.grid.places(position);
            let [a, b, c] = places.share;
            let Vec3x8 { x, y, z } = velocity;
            let numbers: [f32x8; LANES] = [bytemuck::cast(places.cell), a, b, c, mass, x, y, z];
            for (lane, numbers) in f32x8::transpose(numbers).into_iter().enumerate() {
                cells[lane] = if counts & (1 << lane) != 0 { places.cell[lane] } else { NO_CELL };
                brought[lane] = bytemuck::cast(numbers);
            }
        });
    (volume.cell_of_point, volume.brought) = (cell_of_point, brought);
}

/// Forgets what the last step summed.
fn clear(faces: &mut Faces, touched: &[u32]) {
    for component in &mut faces.components {
        for &cell in touched {
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

/// Faces on the lower sides of whole layers of cells along z, with the points that may reach them.
struct Layers<'a> {
    /// The first cell.
    first: usize,
    components: [&'a mut [f32]; 3],
    /// The points in the order of their cells, some of which may reach other layers alone.
    carried: &'a [Carried],
    /// Cells of these layers whose lower faces points may reach, ascending.
    touched: &'a [u32],
    strides: [usize; 3],
    /// Share of its mass that a face keeps.
    kept: f32,
}

impl Layers<'_> {
    /// Sums momentum and mass of the points in a number of tasks, at most one for each layer.
    fn sum(self, tasks: usize) {
        let layer = self.strides[2];
        let middle = self.carried.get(self.carried.len() * (tasks / 2) / tasks.max(1));
        let cut = middle.map_or(0, |middle| middle.cell as usize / layer * layer);
        if tasks < 2 || cut <= self.first || cut >= self.first + self.components[0].len() / 2 {
            return self.sum_alone();
        }
        let first = |cell: usize| self.carried.partition_point(|carried| (carried.cell as usize) < cell);
        // A point reaches the layer of its cell, the one before and the one behind.
        let (before, behind) = (first(cut - layer), first(cut + layer));
        let touched = self.touched.split_at(self.touched.partition_point(|cell| (*cell as usize) < cut));
        let ([mut near, mut far], strides) = (<[[&mut [f32]; 3]; 2]>::default(), self.strides);
        for (axis, component) in self.components.into_iter().enumerate() {
            (near[axis], far[axis]) = component.split_at_mut(2 * (cut - self.first));
        }
        let (carried, near_carried) = (&self.carried[before..], &self.carried[..behind]);
        let kept = self.kept;
        let near = Layers {
            first: self.first,
            components: near,
            carried: near_carried,
            touched: touched.0,
            strides,
            kept,
        };
        let far = Layers { first: cut, components: far, carried, touched: touched.1, strides, kept };
        par::join(|| near.sum(tasks / 2), || far.sum(tasks - tasks / 2));
    }

    fn sum_alone(self) {
        let Self { first, components: [u, v, w], carried, touched, strides, kept } = self;
        for Carried { cell, share, mass, velocity: [x, y, z] } in carried {
            let (cell, mass) = (*cell as usize, *mass);
            Stencil::new::<0>(cell, *share, strides).add(u, first, strides, mass, *x);
            Stencil::new::<1>(cell, *share, strides).add(v, first, strides, mass, *y);
            Stencil::new::<2>(cell, *share, strides).add(w, first, strides, mass, *z);
        }
        for component in [u, v, w] {
            for &cell in touched {
                let pair = &mut component[2 * (cell as usize - first)..][..2];
                let velocity = if pair[1] > 0.0 { pair[0] / pair[1] } else { 0.0 };
                pair.copy_from_slice(&[velocity, kept * pair[1]]);
            }
        }
    }
}
