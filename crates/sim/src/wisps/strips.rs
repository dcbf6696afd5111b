//! Boxes in strips along an axis.

use glam::{DVec3, Vec3};

/// Width of a strip, and of a bin along it, over the mean of the sides of boxes.
const WIDE: f32 = 2.0;
const BIN: f32 = 0.25;
/// Most strips along each axis, and most bins of a strip.
const MOST_STRIPS: u32 = 64;
const MOST_BINS: u32 = 1024;
/// Distance from the middle of all, over their root mean square, beyond which a box is far, and rounds that look for it.
const FAR: f64 = 4.0;
const ROUNDS: usize = 3;
/// Most strips that a box takes along an axis: of a larger one those about its middle.
const MOST_TAKEN: u32 = 8;

/// A box about the way of a segment; it is left out if a corner is not finite.
#[derive(Clone, Copy, Debug)]
pub struct SegmentBox {
    /// Corners \[m\].
    pub low: Vec3,
    pub high: Vec3,
    /// Number of the segment, and of its strand.
    pub segment: u32,
    pub strand: u32,
}

/// Bins of a box's lower and upper corners, and the strips that it takes, from the first to the last along two axes. A
/// box that is left out takes none.
#[derive(Clone, Copy, Debug)]
pub struct BoxBins {
    bin: u32,
    pub last_bin: u32,
    first: [u16; 2],
    last: [u16; 2],
}

/// Axes of a search: boxes are swept along the first, in strips across the other two.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    pub axes: [usize; 3],
    /// Least corner \[m\], and bins or strips of a metre, by these axes.
    low: [f32; 3],
    per_metre: [f32; 3],
    counts: [u32; 3],
}

impl Layout {
    /// Axes along which boxes are short, first; none without boxes.
    pub fn new(boxes: &[SegmentBox]) -> Option<Self> {
        let (low, high) = most_of(boxes);
        let (mut sides, mut count) = ([0.0_f64; 3], 0_u32);
        for one in boxes.iter().filter(|one| is_whole(one)) {
            let side = (one.high - one.low).to_array();
            sides.iter_mut().zip(side).for_each(|(sum, side)| *sum += f64::from(side));
            count += 1;
        }
        if count == 0 {
            return None;
        }
        let extent = (high - low).to_array();
        let mean = sides.map(|sum| (sum / f64::from(count)) as f32);
        let mut axes = [0, 1, 2];
        let share = |axis: &usize| mean[*axis] / extent[*axis].max(f32::MIN_POSITIVE);
        axes.sort_by(|one, other| share(one).total_cmp(&share(other)));
        // At most four buckets a box.
        let strips = |axis: usize| pieces(extent[axis] / (WIDE * mean[axis]), MOST_STRIPS);
        let (rows, columns) = (strips(axes[1]), strips(axes[2]));
        let most = (4 * count / (rows * columns)).clamp(1, MOST_BINS);
        let counts = [pieces(extent[axes[0]] / (BIN * mean[axes[0]]), most), rows, columns];
        let per = |row: usize| counts[row] as f32 / extent[axes[row]].max(f32::MIN_POSITIVE);
        let per_metre = [0, 1, 2].map(|row| per(row).min(f32::MAX));
        Some(Self { axes, low: axes.map(|axis| low[axis]), per_metre, counts })
    }

    /// Bin or strip of a place \[m\] along an axis: it never falls where the place rises.
    fn piece(&self, row: usize, place: f32) -> u32 {
        (((place - self.low[row]) * self.per_metre[row]) as u32).min(self.counts[row] - 1)
    }

    pub fn place(&self, one: &SegmentBox) -> BoxBins {
        if !is_whole(one) {
            return BoxBins { bin: 0, last_bin: 0, first: [1; 2], last: [0; 2] };
        }
        let at = |row: usize, corner: Vec3| self.piece(row, corner[self.axes[row]]);
        let mut place =
            BoxBins { bin: at(0, one.low), last_bin: at(0, one.high), first: [0; 2], last: [0; 2] };
        let middle = 0.5 * one.low + 0.5 * one.high;
        for row in 1..3 {
            let (first, last, middle) = (at(row, one.low), at(row, one.high), at(row, middle));
            place.first[row - 1] = first.max(middle.saturating_sub(MOST_TAKEN / 2)) as u16;
            place.last[row - 1] = last.min(middle + MOST_TAKEN / 2) as u16;
        }
        place
    }

    /// Strips that a box takes.
    fn strips(&self, place: &BoxBins) -> impl Iterator<Item = u32> + use<> {
        let (rows, BoxBins { first, last, .. }) = (self.counts[1], *place);
        (first[1]..=last[1]).flat_map(move |column| {
            (first[0]..=last[0]).map(move |row| u32::from(column) * rows + u32::from(row))
        })
    }

    /// The first strip of those that two boxes take, which may be of none.
    pub fn first_of_both(&self, [one, other]: [&BoxBins; 2]) -> u32 {
        let [row, column] = [0, 1].map(|axis| u32::from(one.first[axis].max(other.first[axis])));
        column * self.counts[1] + row
    }

    /// Number of a bin in a strip.
    pub fn bucket(&self, strip: u32, bin: u32) -> usize {
        (strip * self.counts[0] + bin) as usize
    }

    /// Sorts boxes by strips and bins: the first entry of each bin, and box and strip of each entry.
    pub fn sort(&self, places: &[BoxBins], starts: &mut Vec<u32>, order: &mut Vec<[u32; 2]>) {
        let [bins, rows, columns] = self.counts.map(|count| count as usize);
        starts.clear();
        starts.resize(bins * rows * columns + 1, 0);
        let mut entries = 0;
        for place in places {
            for strip in self.strips(place) {
                starts[self.bucket(strip, place.bin) + 1] += 1;
                entries += 1;
            }
        }
        for bucket in 1..starts.len() {
            starts[bucket] += starts[bucket - 1];
        }
        order.clear();
        order.resize(entries, [0; 2]);
        for (index, place) in places.iter().enumerate().rev() {
            for strip in self.strips(place) {
                let end = &mut starts[self.bucket(strip, place.bin) + 1];
                *end -= 1;
                order[*end as usize] = [index as u32, strip];
            }
        }
        // Each end is now the start of its own bin.
        starts.remove(0);
        starts.push(entries as u32);
    }
}

/// Corners \[m\] about boxes, those far from all others left out: their places are taken for the nearest within.
fn most_of(boxes: &[SegmentBox]) -> (Vec3, Vec3) {
    let (mut low, mut high) = (Vec3::splat(f32::MIN), Vec3::splat(f32::MAX));
    // Beside a box that is very far all others lie at one place: each round leaves out what is far on its own scale.
    for _ in 0..ROUNDS {
        let within =
            |one: &&SegmentBox| is_whole(one) && one.low.cmpge(low).all() && one.high.cmple(high).all();
        let (mut sum, mut squares, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        let (mut least, mut most) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
        for one in boxes.iter().filter(within) {
            let middle = 0.5 * one.low.as_dvec3() + 0.5 * one.high.as_dvec3();
            (sum, squares, count) = (sum + middle, squares + middle * middle, count + 1.0);
            (least, most) = (least.min(one.low), most.max(one.high));
        }
        if count == 0.0 {
            break;
        }
        let mean = sum / count;
        let reach = FAR * (squares / count - mean * mean).max(DVec3::ZERO).map(f64::sqrt);
        (low, high) = (least.max((mean - reach).as_vec3()), most.min((mean + reach).as_vec3()));
    }
    (low, high.max(low))
}

fn is_whole(one: &SegmentBox) -> bool {
    one.low.is_finite() && one.high.is_finite()
}

/// A number of pieces.
fn pieces(number: f32, most: u32) -> u32 {
    (number as u32).clamp(1, most)
}
