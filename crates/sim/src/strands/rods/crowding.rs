//! Crowding of strands: hair that others pass beside rubs against them.

use std::collections::HashMap;

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::Guides;

/// Distance \[m\] within which the hairs of two strands rub: a strand stands for a wisp, and a hundred of them cover a
/// head.
const BESIDE: f32 = 0.03;

/// Cell of space of which a strand's neighbours lie in the same one or beside it.
type Cell = [i64; 3];

fn cell(place: Vec3) -> Cell {
    place.to_array().map(|along| (along / BESIDE).floor() as i64)
}

/// Share of the points of each strand that have a point of another strand beside them, 0 to 1.
pub(crate) fn crowding(guides: &Guides) -> Vec<f32> {
    let points = guides.points_per_strand();
    let mut cells: HashMap<Cell, Vec<(usize, Vec3)>> = HashMap::new();
    for strand in 0..guides.strand_count() {
        for point in 0..points {
            let place = guides.position(strand, point);
            cells.entry(cell(place)).or_default().push((strand, place));
        }
    }
    let among = |cell: Cell, strand: usize, place: Vec3| {
        let near = |(other, there): &(usize, Vec3)| *other != strand && there.distance(place) < BESIDE;
        cells.get(&cell).is_some_and(|places| places.iter().any(near))
    };
    let crowded = |strand: usize, place: Vec3| {
        let own = cell(place);
        // Most neighbours lie in the same cell.
        among(own, strand, place)
            || (0..27).any(|side: i64| {
                let aside = [side % 3 - 1, side / 3 % 3 - 1, side / 9 - 1];
                let beside = std::array::from_fn(|axis| own[axis].saturating_add(aside[axis]));
                among(beside, strand, place)
            })
    };
    let share = |strand: usize| {
        let count = (0..points).filter(|point| crowded(strand, guides.position(strand, *point))).count();
        count as f32 / points as f32
    };
    (0..guides.strand_count()).into_par_iter().map(share).collect()
}

#[cfg(test)]
mod tests {
    use glam::vec3;
    use strandline_groom::Groom;

    use super::*;

    #[test]
    fn strands_are_crowded_where_others_pass_beside_them() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::NEG_Y * 0.3]);
        // Beside the upper half, and far away, across an edge of cells.
        groom.push([Vec3::X * -0.01, vec3(-0.01, -0.15, 0.0)]);
        groom.push([Vec3::X, vec3(1.0, -0.3, 0.0)]);
        let found = crowding(&Guides::resample(&groom, 31).unwrap());
        // 0.15 m and what is nearer than 3 cm to its end.
        assert_eq!(found, [18.0 / 31.0, 1.0, 0.0]);
    }
}
