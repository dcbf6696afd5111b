//! Quantities that a model takes from guides at rest.

use glam::Vec3;
use strandline_base::{lane_place, par::prelude::*};
use strandline_body::{Carrier, Collider, Pose};
use strandline_groom::{Guides, LANES, Lanes, RestShape, Vec3Lanes};

use crate::SimError;

/// Rest positions of a block, each lane carried by its pose.
pub(crate) fn carried(lanes: &Vec3Lanes, world_from_root: &[Pose; LANES]) -> Vec3Lanes {
    let mut carried = Vec3Lanes::default();
    for (lane, world_from_root) in world_from_root.iter().enumerate() {
        carried.set(lane, world_from_root.point(lanes.get(lane)));
    }
    carried
}

/// Refuses a shape at rest that does not fit the guides.
pub(crate) fn check_rest(guides: &Guides, rest: &RestShape) -> Result<(), SimError> {
    let points = guides.points_per_strand();
    let refuse = |found: String, expected| Err(SimError::Rest { found, expected });
    for (name, lanes) in
        [("stretch", &rest.stretch), ("bend", &rest.bend), ("torsion", &rest.torsion), ("mass", &rest.mass)]
    {
        if lanes.len() != guides.positions().len() {
            return refuse(format!("{} blocks of {name}", lanes.len()), "one for each block and point");
        }
    }
    for strand in 0..guides.strand_count() {
        let at = |lanes: &[Lanes], point: usize| {
            let (index, lane) = lane_place(strand, point, points);
            lanes[index].0[lane]
        };
        for point in 0..points {
            let (length, mass) = (at(&rest.stretch, point), at(&rest.mass, point));
            if point + 1 < points && !(length > 0.0 && length.is_finite()) {
                return refuse(format!("length {length} m in strand {strand}"), "above 0");
            }
            if !(mass > 0.0 && mass.is_finite()) {
                return refuse(format!("mass {mass} kg in strand {strand}"), "above 0");
            }
        }
    }
    Ok(())
}

/// A number for each point and lane, from (index, block, point, lane).
pub(crate) fn by_lane(
    count: usize,
    points: usize,
    number: impl Fn(usize, usize, usize, usize) -> f32 + Sync,
) -> Vec<Lanes> {
    (0..count)
        .into_par_iter()
        .map(|index| Lanes(std::array::from_fn(|lane| number(index, index / points, index % points, lane))))
        .collect()
}

/// Unit directions of the segments above all points.
pub(crate) fn directions(guides: &Guides, rest: &RestShape) -> Vec<Vec3Lanes> {
    let points = guides.points_per_strand();
    let positions = guides.positions();
    (0..rest.stretch.len())
        .into_par_iter()
        .map(|index| {
            let mut directions = Vec3Lanes::splat(Vec3::Y);
            if index % points + 1 < points {
                for lane in 0..LANES {
                    let along = positions[index + 1].get(lane) - positions[index].get(lane);
                    directions.set(lane, along.normalize_or(Vec3::Y));
                }
            }
            directions
        })
        .collect()
}

/// Velocities with which points begin that nothing holds; empty where all rest.
pub(crate) fn velocities(guides: &Guides, rooted: impl Fn(usize, usize) -> bool) -> Vec<Vec3Lanes> {
    let Some(velocities) = guides.velocities() else { return Vec::new() };
    let (points, last) = (guides.points_per_strand(), guides.strand_count() - 1);
    let mut lanes = vec![Vec3Lanes::default(); guides.positions().len()];
    for (index, lanes) in lanes.iter_mut().enumerate() {
        for lane in 0..LANES {
            let (strand, point) = ((index / points * LANES + lane).min(last), index % points);
            if !rooted(strand, point) {
                lanes.set(lane, velocities[strand * points + point]);
            }
        }
    }
    lanes
}

/// Distance \[m\] of a point from the solids of the body at rest, 0 inside.
pub(crate) fn clearance(colliders: &[Collider], point: Vec3) -> f32 {
    colliders
        .iter()
        .filter(|collider| matches!(collider.carrier, Carrier::Piece(_)))
        .map(|collider| collider.shape.distance(point))
        .fold(f32::INFINITY, f32::min)
        .max(0.0)
}
