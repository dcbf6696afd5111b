//! Strands of a list whose roots lie near a place.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::{IVec3, Vec3};

/// Side of a cell over the mean distance of roots.
const CELL: f32 = 2.0;
/// Most rings of cells around a place that are searched: further away lies no root worth to follow.
const RINGS: i32 = 12;

/// Factor that spreads the bits of a cell.
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// A hash of cells: they come from no stranger, and are looked up by the million.
#[derive(Default)]
struct OfCell(u64);

impl Hasher for OfCell {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_i32(i32::from(*byte)));
    }

    fn write_i32(&mut self, number: i32) {
        self.0 = (self.0.rotate_left(21) ^ u64::from(number.cast_unsigned())).wrapping_mul(SPREAD);
    }

    fn finish(&self) -> u64 {
        // The table takes the lowest bits first.
        self.0 ^ (self.0 >> 32)
    }
}

/// Places by their cells.
type Cells = HashMap<IVec3, Vec<u32>, BuildHasherDefault<OfCell>>;

/// Roots sorted into cells.
pub(super) struct Near {
    side: f32,
    cells: Cells,
    places: Vec<Vec3>,
}

impl Near {
    /// Of places \[m\] on an area \[m^2\].
    pub fn new(places: Vec<Vec3>, area: f32) -> Self {
        let side = CELL * (area / places.len().max(1) as f32).sqrt();
        let mut cells = Cells::default();
        for (index, place) in places.iter().enumerate() {
            cells.entry((*place / side).floor().as_ivec3()).or_default().push(index as u32);
        }
        Self { side, cells, places }
    }

    /// The `COUNT` nearest places by their distance \[m\] and what `more` adds to it, nearest first: indices and
    /// distances, infinite where there are fewer places. Of places that are equally near the first counts.
    pub fn nearest<const COUNT: usize>(
        &self,
        at: Vec3,
        more: impl Fn(usize) -> f32,
    ) -> [(usize, f32); COUNT] {
        let mut found = [(0, f32::INFINITY); COUNT];
        let middle = (at / self.side).floor().as_ivec3();
        for ring in 0..=RINGS {
            // Cells of this ring and beyond lie at least so far away.
            if found[COUNT - 1].1 < (ring - 1) as f32 * self.side {
                break;
            }
            self.look_around(middle, ring, |index| {
                let distance = self.places[index].distance(at) + more(index);
                let place = found.partition_point(|known| (known.1, known.0) <= (distance, index));
                if place < COUNT {
                    found[place..].rotate_right(1);
                    found[place] = (index, distance);
                }
            });
        }
        found
    }

    /// Every place in the cells that lie `ring` cells from another.
    fn look_around(&self, middle: IVec3, ring: i32, mut look: impl FnMut(usize)) {
        for z in -ring..=ring {
            for y in -ring..=ring {
                let inner = z.abs() < ring && y.abs() < ring;
                let step = if inner && ring > 0 { 2 * ring } else { 1 };
                for x in (-ring..=ring).step_by(step as usize) {
                    let cell = self.cells.get(&(middle + IVec3::new(x, y, z)));
                    cell.into_iter().flatten().for_each(|index| look(*index as usize));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use strandline_base::random::Random;

    use super::*;

    #[test]
    fn the_nearest_are_those_of_a_whole_search() {
        let mut random = Random::new(5, 1);
        let places: Vec<Vec3> =
            (0..300).map(|_| 0.1 * Vec3::new(random.signed(), random.signed(), 0.0)).collect();
        let near = Near::new(places.clone(), 0.04);
        let more = |index: usize| if index.is_multiple_of(5) { 0.02 } else { 0.0 };
        for _ in 0..50 {
            let at = 0.12 * Vec3::new(random.signed(), random.signed(), 0.1);
            let found = near.nearest::<3>(at, more);
            let far = |index: usize| places[index].distance(at) + more(index);
            let mut all: Vec<usize> = (0..300).collect();
            all.sort_by(|one, two| far(*one).total_cmp(&far(*two)));
            assert_eq!(found.map(|(index, _)| index), [all[0], all[1], all[2]]);
        }
        assert!(near.nearest::<3>(Vec3::splat(50.0), |_| 0.0)[0].1.is_infinite());
    }
}
