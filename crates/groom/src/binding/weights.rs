//! Guides that a strand follows, and how much it follows each.

use super::influence::MOST_INFLUENCES;
use crate::{
    Groom,
    choice::{Feature, Roots},
};

/// Distance \[m\] below which guides count as equally near: weights fall with the square of the distance.
const NEAREST: f32 = 1e-4;

/// The guides that a groom names for a strand, and how much it follows each.
pub(super) fn named(groom: &Groom, strands_of_guides: &[usize], strand: usize) -> Vec<(usize, f32)> {
    let Some(influences) = &groom.influences else { return Vec::new() };
    let place = |guide: usize| strands_of_guides.binary_search(&guide).ok();
    let mut named: Vec<(usize, f32)> = influences
        .of(strand)
        .filter(|(_, weight)| *weight > 0.0)
        .filter_map(|(guide, weight)| Some((place(guide)?, weight)))
        .collect();
    named.sort_by(|one, two| two.1.total_cmp(&one.1));
    shares(named)
}

/// The guides that are most like a strand, and how much it follows each.
pub(super) fn nearest(feature: &Feature, guides: &[Feature], roots: &Roots) -> Vec<(usize, f32)> {
    let mut nearest = [(0, f32::INFINITY); MOST_INFLUENCES];
    roots.outward(feature.root(), |guide| {
        let distance = feature.distance_squared(&guides[guide]);
        if distance < nearest[MOST_INFLUENCES - 1].1 {
            let place = nearest.partition_point(|known| known.1 <= distance);
            nearest[place..].rotate_right(1);
            nearest[place] = (guide, distance);
        }
        nearest[MOST_INFLUENCES - 1].1.sqrt()
    });
    let found = nearest.iter().filter(|(_, distance)| distance.is_finite());
    shares(found.map(|(guide, distance)| (*guide, 1.0 / (distance + NEAREST * NEAREST))).collect())
}

/// The first few guides with weights that sum to 1.
fn shares(mut weights: Vec<(usize, f32)>) -> Vec<(usize, f32)> {
    weights.truncate(MOST_INFLUENCES);
    let sum: f32 = weights.iter().map(|(_, weight)| weight).sum();
    weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
    weights
}
