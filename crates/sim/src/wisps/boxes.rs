//! Pairs of segments whose boxes meet, by cells.

use glam::{IVec3, Vec3, Vec4};
use strandline_base::par::prelude::*;

use crate::cells::grid::REACH;

/// Most cells that a box takes along an axis: of a larger one those about its middle.
const MOST_CELLS: i32 = 8;
/// Factors of the hash of a cell \[Teschner2003\].
const HASH_X: u32 = 73_856_093;
const HASH_Y: u32 = 19_349_663;
const HASH_Z: u32 = 83_492_791;
/// Boxes whose pairs one thread looks for at a time.
const CHUNK: usize = 256;
/// Entries of buckets that a thread copies at a time.
const ENTRIES: usize = 4096;

/// A box about the way of a segment.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    /// Corners \[m\].
    pub low: Vec3,
    pub high: Vec3,
    /// Number of the segment, and of its strand.
    pub segment: u32,
    pub strand: u32,
}

/// Cells that boxes take, from the first to the last along each axis.
#[derive(Clone, Copy, Debug)]
struct Range {
    first: IVec3,
    last: IVec3,
}

/// Boxes sorted by buckets of cells, and the room for it.
#[derive(Clone, Debug, Default)]
pub struct Boxes {
    ranges: Vec<Range>,
    /// First box of each bucket.
    starts: Vec<u32>,
    /// Indices of boxes, bucket after bucket, rising, and their corners \[m\].
    order: Vec<u32>,
    corners: Vec<[Vec4; 2]>,
    found: Vec<Vec<Met>>,
}

/// Two segments whose boxes meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Their numbers, the lower one first.
    pub segments: [u32; 2],
    /// Distance \[m\] that the search for pairs gives them.
    pub distance: f32,
}

impl Boxes {
    /// Replaces `pairs` by the segments of all boxes of different strands that meet and have a distance by `judge`, each
    /// pair once, the lower number first, in rising order. Segments of boxes rise.
    pub fn pairs(
        &mut self,
        boxes: &[Around],
        judge: impl Fn([u32; 2]) -> Option<f32> + Sync,
        pairs: &mut Vec<Met>,
    ) {
        pairs.clear();
        let Some(per_metre) = cells_per_metre(boxes) else { return };
        let mut ranges = std::mem::take(&mut self.ranges);
        boxes.par_iter().map(|one| range(one, per_metre)).collect_into_vec(&mut ranges);
        let buckets = self.sort(&ranges);
        let corners = |index: &u32| {
            let one = &boxes[*index as usize];
            [one.low.extend(0.0), one.high.extend(0.0)]
        };
        self.order.par_iter().with_min_len(ENTRIES).map(corners).collect_into_vec(&mut self.corners);
        let mut found = std::mem::take(&mut self.found);
        found.resize_with(boxes.len().div_ceil(CHUNK), Vec::new);
        found.par_iter_mut().enumerate().for_each(|(chunk, found)| {
            found.clear();
            for one in chunk * CHUNK..((chunk + 1) * CHUNK).min(boxes.len()) {
                self.partners(one, (boxes, &ranges), buckets, &judge, found);
            }
        });
        found.iter().for_each(|found| pairs.extend_from_slice(found));
        (self.ranges, self.found) = (ranges, found);
    }

    /// Sorts boxes by the buckets of their cells; returns the number of buckets less one.
    fn sort(&mut self, ranges: &[Range]) -> u32 {
        let entries: usize = ranges.iter().map(|range| cells(range).count()).sum();
        let buckets = entries.max(1).next_power_of_two();
        let mask = buckets as u32 - 1;
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        for cell in ranges.iter().flat_map(cells) {
            self.starts[bucket(cell, mask) as usize + 1] += 1;
        }
        for index in 0..buckets {
            self.starts[index + 1] += self.starts[index];
        }
        self.order.clear();
        self.order.resize(entries, 0);
        for (index, range) in ranges.iter().enumerate().rev() {
            for cell in cells(range) {
                let end = &mut self.starts[bucket(cell, mask) as usize + 1];
                *end -= 1;
                self.order[*end as usize] = index as u32;
            }
        }
        // Each end is now the start of its own bucket.
        self.starts.remove(0);
        self.starts.push(entries as u32);
        mask
    }

    fn partners(
        &self,
        one: usize,
        (boxes, ranges): (&[Around], &[Range]),
        mask: u32,
        judge: &impl Fn([u32; 2]) -> Option<f32>,
        found: &mut Vec<Met>,
    ) {
        let (own, first) = (&boxes[one], found.len());
        let (low, high) = (own.low.extend(0.0), own.high.extend(0.0));
        for cell in cells(&ranges[one]) {
            let bucket = bucket(cell, mask) as usize;
            let entries = self.starts[bucket] as usize..self.starts[bucket + 1] as usize;
            // Indices rise within a bucket.
            for (corners, &other) in self.corners[entries.clone()].iter().zip(&self.order[entries]).rev() {
                let other = other as usize;
                if other <= one {
                    break;
                }
                // Found in the cell of the higher of both lower corners alone.
                if (low.cmple(corners[1]) & corners[0].cmple(high)).all()
                    && boxes[other].strand != own.strand
                    && ranges[one].first.max(ranges[other].first) == cell
                    && let segments = [own.segment, boxes[other].segment]
                    && let Some(distance) = judge(segments)
                {
                    found.push(Met { segments, distance });
                }
            }
        }
        found[first..].sort_unstable_by_key(|met| met.segments);
        // Two cells of a box may have one bucket.
        let mut kept = first;
        for index in first..found.len() {
            if kept == first || found[kept - 1].segments != found[index].segments {
                found[kept] = found[index];
                kept += 1;
            }
        }
        found.truncate(kept);
    }
}

/// Cells per metre: a cell is as long as the mean of the longest sides.
fn cells_per_metre(boxes: &[Around]) -> Option<f32> {
    let sides: f64 = boxes.iter().map(|one| f64::from((one.high - one.low).max_element())).sum();
    let mean = (sides / boxes.len() as f64) as f32;
    (mean > 0.0 && mean.is_finite()).then(|| 1.0 / mean)
}

fn range(one: &Around, per_metre: f32) -> Range {
    let most = REACH * per_metre.min(1e5);
    let cell =
        |point: Vec3| (point * per_metre).clamp(Vec3::splat(-most), Vec3::splat(most)).floor().as_ivec3();
    let (first, last) = (cell(one.low), cell(one.high));
    let middle = cell(0.5 * (one.low + one.high));
    let half = IVec3::splat(MOST_CELLS / 2);
    Range { first: first.max(middle - half), last: last.min(middle + half) }
}

fn cells(range: &Range) -> impl Iterator<Item = IVec3> + use<> {
    let Range { first, last } = *range;
    (first.z..=last.z).flat_map(move |z| {
        (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| IVec3::new(x, y, z)))
    })
}

/// Bucket of a cell [Teschner2003]. Products are added: joined by exclusive or, as published, cells on both sides of the
/// origin share buckets.
fn bucket(cell: IVec3, mask: u32) -> u32 {
    let [x, y, z] = cell.to_array().map(|number| number as u32);
    x.wrapping_mul(HASH_X).wrapping_add(y.wrapping_mul(HASH_Y)).wrapping_add(z.wrapping_mul(HASH_Z)) & mask
}

#[cfg(test)]
mod tests {
    use strandline_body::Random;

    use super::*;

    impl Around {
        fn meets(&self, other: &Self) -> bool {
            self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
        }
    }

    #[test]
    fn each_pair_of_boxes_that_meet_is_found_once() {
        let mut random = Random::new(7, 0);
        let boxes: Vec<Around> = (0..700)
            .map(|segment| {
                let mut vector = |size: f32| Vec3::new(random.unit(), random.unit(), random.unit()) * size;
                let low = vector(1.0) - Vec3::splat(0.5);
                let side = if segment % 50 == 0 { 0.4 } else { 0.12 };
                Around { low, high: low + vector(side), segment, strand: segment / 10 }
            })
            .collect();
        let mut expected = Vec::new();
        for one in &boxes {
            for other in boxes.iter().filter(|other| other.segment > one.segment) {
                if one.strand != other.strand && one.meets(other) {
                    expected.push([one.segment, other.segment]);
                }
            }
        }
        let mut found = Vec::new();
        let mut room = Boxes::default();
        for _ in 0..2 {
            room.pairs(&boxes, |_| Some(0.0), &mut found);
            assert!(expected.len() > 100);
            assert_eq!(found.iter().map(|met| met.segments).collect::<Vec<_>>(), expected);
        }
        // Few boxes have few buckets, and several cells of one box the same.
        for count in 2..9 {
            for seed in 0..40 {
                let mut random = Random::new(seed, count);
                let mut vector = |size: f32| Vec3::new(random.unit(), random.unit(), random.unit()) * size;
                let few: Vec<Around> = (0..count as u32)
                    .map(|segment| {
                        let low = vector(0.5);
                        Around { low, high: low + 0.3 + vector(0.8), segment, strand: segment }
                    })
                    .collect();
                let meets = |one: &Around, other: &Around| one.segment < other.segment && one.meets(other);
                let expected: usize =
                    few.iter().map(|one| few.iter().filter(|other| meets(one, other)).count()).sum();
                room.pairs(&few, |_| Some(0.0), &mut found);
                assert_eq!(found.len(), expected, "{count} boxes, seed {seed}");
            }
        }
        room.pairs(&boxes, |_| Some(0.0), &mut found);
        let odd = |segments: [u32; 2]| (segments[0] % 2 == 1).then_some(3.0);
        room.pairs(&boxes, odd, &mut found);
        expected.retain(|segments| segments[0] % 2 == 1);
        assert_eq!(found.iter().map(|met| met.segments).collect::<Vec<_>>(), expected);
        room.pairs(&[], |_| Some(0.0), &mut found);
        assert!(found.is_empty());
    }
}
