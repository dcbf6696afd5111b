//! `gather`: points take their velocities from the faces.

use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::faces::{Faces, Stencil};
use super::volume::Volume;
use crate::VolumeSettings;
use crate::cells::{Kind, NO_CELL};
use strandline_base::vec3x8::Vec3x8;

/// Updates the velocities of free points: `a` times (the velocity plus its change on the faces)
/// plus (1 - `a`) times the velocity on the faces, with `a` the FLIP share of a step
/// of `time_step` \[s\] [Chen2011 eq. 5]. A short step takes a part of the change. In a one-sided volume `a` is 1 but in
/// packed cells, where hair rubs.
///
/// Every face in the stencil of a point carries weight, at least its own. Points outside the box
/// and those that the head moves, whose inverse mass is 0, keep their velocities. Shapes are
/// `[block][point]` of lanes, world space.
pub fn gather(
    volume: &Volume,
    time_step: f32,
    inverse_mass: &[Lanes],
    positions: &[Vec3Lanes],
    velocities: &mut [Vec3Lanes],
) {
    let points = volume.points_per_strand;
    let (share, strides) = (volume.settings.flip_share_in(time_step), volume.grid.strides());
    let is_one_sided = volume.settings.is_one_sided();
    let taken_share = VolumeSettings::pressure_share_in(time_step);
    velocities
        .par_chunks_mut(points)
        .zip(positions.par_chunks(points).zip(inverse_mass.par_chunks(points)))
        .with_min_len(16)
        .enumerate()
        .for_each(|(block, (velocities, (positions, inverse_mass)))| {
            for ((velocity, position), weight) in velocities.iter_mut().zip(positions).zip(inverse_mass) {
                let places = volume.grid.places(Vec3x8::load(position));
                let taken = |lane: &usize| {
                    volume.is_live(block, *lane) && weight.0[*lane] > 0.0 && places.cell[*lane] != NO_CELL
                };
                let places_within = places.share.map(f32x8::to_array);
                for lane in (0..LANES).filter(taken) {
                    let (cell, within) = (places.cell[lane] as usize, places_within.map(|axis| axis[lane]));
                    let old = velocity.get(lane);
                    let (x, x_change) = at::<0>(&volume.faces, cell, within, strides);
                    let (y, y_change) = at::<1>(&volume.faces, cell, within, strides);
                    let (z, z_change) = at::<2>(&volume.faces, cell, within, strides);
                    let change = glam::Vec3::new(x_change, y_change, z_change);
                    let flip = old + change * taken_share;
                    let pic = glam::Vec3::new(x, y, z) - change * (1.0 - taken_share);
                    let smoothed = share * flip + (1.0 - share) * pic;
                    let is_loose = is_one_sided && volume.kind(cell) != Kind::Fluid;
                    velocity.set(lane, if is_loose { flip } else { smoothed });
                }
            }
        });
}

/// Velocity and change of a component at a place.
#[inline]
fn at<const AXIS: usize>(faces: &Faces, cell: usize, within: [f32; 3], strides: [usize; 3]) -> (f32, f32) {
    Stencil::new::<AXIS>(cell, within, strides).interpolate(&faces.components[AXIS], strides)
}
