//! Strands that have no others beside them: nothing but their own hairs rubs against them.

use std::collections::HashMap;

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::Guides;

/// Distance \[m\] within which the hairs of two strands rub.
const BESIDE: f32 = 0.03;

/// A cube of space: what lies beside a place is in the same one or in one that touches it.
type Cell = [i64; 3];

fn cell(place: Vec3) -> Cell {
    place.to_array().map(|along| (along / BESIDE).floor() as i64)
}

/// True for each strand that has no point of another beside one of its own.
pub(crate) fn alone(guides: &Guides) -> Vec<bool> {
    let points = guides.points_per_strand();
    let mut cells: HashMap<Cell, Vec<(usize, Vec3)>> = HashMap::new();
    for strand in 0..guides.strand_count() {
        for point in 0..points {
            let place = guides.position(strand, point);
            cells.entry(cell(place)).or_default().push((strand, place));
        }
    }
    let among = |cell: Cell, strand: usize, place: Vec3| {
        let beside = |(other, there): &(usize, Vec3)| *other != strand && there.distance(place) < BESIDE;
        cells.get(&cell).is_some_and(|places| places.iter().any(beside))
    };
    let has_others = |strand: usize, place: Vec3| {
        let own = cell(place);
        // Most neighbours lie in the same cell.
        among(own, strand, place)
            || (0..27).any(|side: i64| {
                let aside = [side % 3 - 1, side / 3 % 3 - 1, side / 9 - 1];
                among(std::array::from_fn(|axis| own[axis].saturating_add(aside[axis])), strand, place)
            })
    };
    let is_alone =
        |strand: usize| !(0..points).any(|point| has_others(strand, guides.position(strand, point)));
    (0..guides.strand_count()).into_par_iter().map(is_alone).collect()
}

#[cfg(test)]
mod tests {
    use glam::vec3;
    use strandline_groom::Groom;

    use super::*;

    #[test]
    fn strands_are_alone_that_no_other_comes_near() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::NEG_Y * 0.3]);
        // Across an edge of cells beside the lower end of the first, twice the distance away, and far away.
        groom.push([vec3(-0.01, -0.3, 0.0), vec3(-0.2, -0.3, 0.0)]);
        groom.push([Vec3::X * 0.06, vec3(0.06, -0.3, 0.0)]);
        groom.push([Vec3::X, vec3(1.0, -0.3, 0.0)]);
        let found = alone(&Guides::resample(&groom, 31).unwrap());
        assert_eq!(found, [false, false, true, true]);
    }
}
