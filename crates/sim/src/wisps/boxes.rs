//! Pairs of segments whose boxes meet: boxes in strips, swept along an axis, eight at a time.

use std::ops::Range;

use strandline_base::par::prelude::*;
use strandline_groom::LANES;
use wide::f32x8;

use super::strips::{BoxBins, Layout, SegmentBox};

/// Entries that a thread takes at a time.
const CHUNK: usize = 256;
/// Bits of eight lanes.
const ALL: u32 = 0xff;
/// Groups of eight entries, and boxes, that a thread copies at a time.
const COPIES: usize = 512;

/// Two segments whose boxes meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Their numbers, the lower one first.
    pub segments: [u32; 2],
    /// Distance \[m\] that the search for pairs gives them.
    pub distance: f32,
}

/// Tests of segments whose boxes meet.
pub trait Sieve: Sync {
    /// Numbers of a segment that others are tested against.
    type One;
    /// Numbers of eight segments, one in each lane.
    type Eight: Send + Sync;

    fn one(&self, eight: &Self::Eight, lane: usize) -> Self::One;

    fn eight(&self, segments: [u32; LANES]) -> Self::Eight;

    /// Bits of those of the segments in some lanes that may be near the one.
    fn may_meet(&self, one: &Self::One, eight: &Self::Eight, lanes: u32) -> u32;

    /// Adds the groups of a row in which boxes meet and segments may be near its own, in the fastest way here.
    fn scan(&self, row: &Row<Self::Eight>, hits: &mut Vec<Hit>) {
        self.scan_plain(row, hits);
    }

    /// As [`Sieve::scan`], on any processor.
    fn scan_plain(&self, row: &Row<Self::Eight>, hits: &mut Vec<Hit>) {
        let (eight, lane) = row.own();
        let one = self.one(eight, lane);
        row.scan(|eight, lanes| self.may_meet(&one, eight, lanes), hits);
    }

    /// Distance \[m\] of two segments, the lower number first; none for those that are no pair.
    fn judge(&self, segments: [u32; 2]) -> Option<f32>;
}

/// Corners of eight boxes \[m\], by the axes of the layout.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    pub low: [f32x8; 3],
    pub high: [f32x8; 3],
}

/// An entry and those behind it in its strip.
pub struct Row<'a, E> {
    pub entry: usize,
    /// The one behind the last of these.
    pub end: usize,
    /// Of all entries, in groups of eight.
    pub corners: &'a [Corners],
    pub eights: &'a [E],
}

/// A group of eight entries, and the bits of those that are found.
#[derive(Debug, PartialEq)]
pub struct Hit {
    pub group: usize,
    pub lanes: u32,
}

impl<E> Row<'_, E> {
    /// Groups in which it has entries.
    #[inline]
    pub fn groups(&self) -> Range<usize> {
        (self.entry + 1) / LANES..self.end.div_ceil(LANES)
    }

    /// Group and lane of its own entry.
    #[inline]
    pub fn own(&self) -> (&E, usize) {
        (&self.eights[self.entry / LANES], self.entry % LANES)
    }

    /// Corners of its own box \[m\].
    #[inline]
    pub fn corners(&self) -> [[f32; 3]; 2] {
        let (own, lane) = (&self.corners[self.entry / LANES], self.entry % LANES);
        [&own.low, &own.high].map(|corner| corner.each_ref().map(|axis| axis.as_array()[lane]))
    }

    /// Bits of its entries in one of them.
    #[inline]
    pub fn lanes(&self, group: usize) -> u32 {
        let begin = group * LANES;
        let (before, behind) =
            ((self.entry + 1).saturating_sub(begin), (begin + LANES).saturating_sub(self.end));
        (ALL << before) & (ALL >> behind)
    }

    /// Adds the groups of entries whose boxes meet and that `may_meet` leaves.
    #[inline]
    pub fn scan(&self, may_meet: impl Fn(&E, u32) -> u32, hits: &mut Vec<Hit>) {
        let [low, high] = self.corners().map(|corner| corner.map(f32x8::splat));
        for group in self.groups() {
            let mut lanes = self.lanes(group) & self.corners[group].meet(&low, &high);
            if lanes != 0 {
                lanes = may_meet(&self.eights[group], lanes);
            }
            if lanes != 0 {
                hits.push(Hit { group, lanes });
            }
        }
    }
}

/// Scratch of the search, kept.
#[derive(Clone, Debug, Default)]
pub struct Boxes {
    places: Vec<BoxBins>,
    /// First entry of each bin of each strip.
    starts: Vec<u32>,
    /// Box and strip of each entry.
    order: Vec<[u32; 2]>,
    corners: Vec<Corners>,
    found: Vec<Vec<Met>>,
}

/// Sorted boxes of a search, and how their segments are tested.
struct Search<'a, S: Sieve> {
    boxes: &'a [SegmentBox],
    sorted: &'a Boxes,
    layout: Layout,
    sieve: &'a S,
    eights: &'a [S::Eight],
}

impl Boxes {
    /// Replaces `pairs` by the segments of all boxes of different strands that meet and pass the sieve, each pair once, the
    /// lower number first, in rising order. Segments of boxes rise; `eights` is scratch.
    pub fn pairs<S: Sieve>(
        &mut self,
        boxes: &[SegmentBox],
        sieve: &S,
        eights: &mut Vec<S::Eight>,
        pairs: &mut Vec<Met>,
    ) {
        pairs.clear();
        let Some(layout) = Layout::new(boxes) else { return };
        boxes.par_iter().with_min_len(COPIES).map(|one| layout.place(one)).collect_into_vec(&mut self.places);
        layout.sort(&self.places, &mut self.starts, &mut self.order);
        let order = &self.order;
        let groups = || (0..order.len().div_ceil(LANES)).into_par_iter().with_min_len(COPIES);
        groups().map(|group| Corners::of(group, order, boxes, &layout)).collect_into_vec(&mut self.corners);
        groups()
            .map(|group| {
                let box_of = |lane: usize| order[(group * LANES + lane).min(order.len() - 1)][0] as usize;
                sieve.eight(std::array::from_fn(|lane| boxes[box_of(lane)].segment))
            })
            .collect_into_vec(eights);
        let mut found = std::mem::take(&mut self.found);
        found.resize_with(order.len().div_ceil(CHUNK), Vec::new);
        let search = Search { boxes, sorted: self, layout, sieve, eights };
        found.par_iter_mut().enumerate().for_each(|(chunk, found)| {
            found.clear();
            let mut hits = Vec::new();
            for entry in chunk * CHUNK..((chunk + 1) * CHUNK).min(search.sorted.order.len()) {
                search.partners(entry, &mut hits, found);
            }
        });
        found.iter().for_each(|found| pairs.extend_from_slice(found));
        pairs.sort_unstable_by_key(|met| u64::from(met.segments[0]) << 32 | u64::from(met.segments[1]));
        self.found = found;
    }
}

impl Corners {
    /// Corners of the boxes of a group of entries; lanes behind the last are empty.
    fn of(group: usize, order: &[[u32; 2]], boxes: &[SegmentBox], layout: &Layout) -> Self {
        let mut low = [[f32::MAX; LANES]; 3];
        let mut high = [[f32::MIN; LANES]; 3];
        for (lane, [index, _]) in order[group * LANES..].iter().take(LANES).enumerate() {
            let one = &boxes[*index as usize];
            for (row, axis) in layout.axes.into_iter().enumerate() {
                (low[row][lane], high[row][lane]) = (one.low[axis], one.high[axis]);
            }
        }
        Self { low: low.map(f32x8::new), high: high.map(f32x8::new) }
    }
}

impl<S: Sieve> Search<'_, S> {
    /// Finds the pairs of an entry with those behind it in its strip.
    fn partners(&self, entry: usize, hits: &mut Vec<Hit>, found: &mut Vec<Met>) {
        let [index, strip] = self.sorted.order[entry];
        let place = &self.sorted.places[index as usize];
        let end = self.sorted.starts[self.layout.bucket(strip, place.last_bin) + 1] as usize;
        if entry + 1 >= end {
            return;
        }
        let row = Row { entry, end, corners: &self.sorted.corners, eights: self.eights };
        self.sieve.scan(&row, hits);
        for Hit { group, mut lanes } in hits.drain(..) {
            while lanes != 0 {
                self.judge(index, strip, group * LANES + lanes.trailing_zeros() as usize, found);
                lanes &= lanes - 1;
            }
        }
    }

    #[inline]
    fn judge(&self, index: u32, strip: u32, entry: usize, found: &mut Vec<Met>) {
        let other = self.sorted.order[entry][0];
        let [one, two] = [index, other].map(|index| &self.boxes[index as usize]);
        let places = [index, other].map(|index| &self.sorted.places[index as usize]);
        // Found in the first strip alone that both take.
        if one.strand == two.strand || self.layout.first_of_both(places) != strip {
            return;
        }
        let segments = [one.segment.min(two.segment), one.segment.max(two.segment)];
        if let Some(distance) = self.sieve.judge(segments) {
            found.push(Met { segments, distance });
        }
    }
}

impl Corners {
    /// Bits of the boxes that meet one.
    #[inline]
    fn meet(&self, low: &[f32x8; 3], high: &[f32x8; 3]) -> u32 {
        let axis = |axis: usize| self.low[axis].simd_le(high[axis]) & low[axis].simd_le(self.high[axis]);
        (axis(0) & axis(1) & axis(2)).to_bitmask()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_body::Random;

    use super::*;

    /// Takes boxes as they are; of segments of one sort.
    struct Boxed(fn([u32; 2]) -> Option<f32>);

    impl Sieve for Boxed {
        type One = ();
        type Eight = ();

        fn one(&self, (): &(), _: usize) {}

        fn eight(&self, _: [u32; LANES]) {}

        fn may_meet(&self, (): &(), (): &(), lanes: u32) -> u32 {
            lanes
        }

        fn judge(&self, segments: [u32; 2]) -> Option<f32> {
            self.0(segments)
        }
    }

    impl SegmentBox {
        fn meets(&self, other: &Self) -> bool {
            self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
        }
    }

    #[test]
    fn boxes_far_from_all_others_leave_them_their_strips() {
        let mut random = Random::new(3, 0);
        let mut boxes: Vec<SegmentBox> = (0..4000)
            .map(|segment| {
                let low = Vec3::new(random.unit(), random.unit(), random.unit()) * 0.5;
                SegmentBox { low, high: low + 0.01, segment, strand: segment }
            })
            .collect();
        (boxes[7].low, boxes[7].high) = (Vec3::splat(1e4), Vec3::splat(1e4 + 1.0));
        (boxes[9].low, boxes[9].high) = (Vec3::splat(-90.0), Vec3::splat(-89.0));
        let layout = Layout::new(&boxes).unwrap();
        let places: Vec<_> = boxes.iter().map(|one| layout.place(one)).collect();
        let (mut starts, mut order) = (Vec::new(), Vec::new());
        layout.sort(&places, &mut starts, &mut order);
        let fullest = starts.windows(2).map(|ends| ends[1] - ends[0]).max();
        assert!(fullest < Some(60), "{fullest:?}");
    }

    #[test]
    fn each_pair_of_boxes_that_meet_is_found_once() {
        let mut random = Random::new(7, 0);
        let boxes: Vec<SegmentBox> = (0..700)
            .map(|segment| {
                let mut vector = |size: f32| Vec3::new(random.unit(), random.unit(), random.unit()) * size;
                let low = vector(1.0) - Vec3::splat(0.5);
                let side = if segment % 50 == 0 { 0.4 } else { 0.12 };
                SegmentBox { low, high: low + vector(side), segment, strand: segment / 10 }
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
            room.pairs(&boxes, &Boxed(|_| Some(0.0)), &mut Vec::new(), &mut found);
            assert!(expected.len() > 100);
            assert_eq!(found.iter().map(|met| met.segments).collect::<Vec<_>>(), expected);
        }
        // Few boxes have few buckets, and several cells of one box the same.
        for count in 2..9 {
            for seed in 0..40 {
                let mut random = Random::new(seed, count);
                let mut vector = |size: f32| Vec3::new(random.unit(), random.unit(), random.unit()) * size;
                let few: Vec<SegmentBox> = (0..count as u32)
                    .map(|segment| {
                        let low = vector(0.5);
                        SegmentBox { low, high: low + 0.3 + vector(0.8), segment, strand: segment }
                    })
                    .collect();
                let meets =
                    |one: &SegmentBox, other: &SegmentBox| one.segment < other.segment && one.meets(other);
                let expected: usize =
                    few.iter().map(|one| few.iter().filter(|other| meets(one, other)).count()).sum();
                room.pairs(&few, &Boxed(|_| Some(0.0)), &mut Vec::new(), &mut found);
                assert_eq!(found.len(), expected, "{count} boxes, seed {seed}");
            }
        }
        room.pairs(&boxes, &Boxed(|_| Some(0.0)), &mut Vec::new(), &mut found);
        let odd = Boxed(|segments| (segments[0] % 2 == 1).then_some(3.0));
        room.pairs(&boxes, &odd, &mut Vec::new(), &mut found);
        expected.retain(|segments| segments[0] % 2 == 1);
        assert_eq!(found.iter().map(|met| met.segments).collect::<Vec<_>>(), expected);
        room.pairs(&[], &odd, &mut Vec::new(), &mut found);
        assert!(found.is_empty());
    }
}
