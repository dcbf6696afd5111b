//! Strands on the screen: which of their segments are drawn, and in which order.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use strandline_base::par::prelude::*;

use super::occluders::Occluders;
use super::sort::{self, MAX_KEY};
use crate::frame::projection::Projection;
use crate::memory::MOST_POINTS;
use crate::strands::Strands;

/// Strands handled together by one thread. Fixed, so that nothing depends on the number of threads.
const CHUNK: usize = 256;
/// A segment runs along the axis of its predecessor unless the other axis is longer by this factor:
/// strands near a diagonal do not change axis from segment to segment.
const AXIS_HOLD: f32 = 1.25;

/// A drawn segment: the index of its first point on the screen and what its two ends are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Segment(u32);

impl From<u32> for Segment {
    fn from(word: u32) -> Self {
        Self(word)
    }
}

impl From<Segment> for u32 {
    fn from(segment: Segment) -> Self {
        segment.0
    }
}

impl Segment {
    /// Runs along y: one step is a row of samples, not a column.
    pub const ALONG_Y: u32 = 1 << 31;
    /// Its first point is the end of a strand.
    pub const FIRST_IS_END: u32 = 1 << 30;
    /// Its second point is the end of a strand.
    pub const LAST_IS_END: u32 = 1 << 29;
    /// Its predecessor runs along the other axis.
    pub const FIRST_TURNS: u32 = 1 << 28;
    /// Its successor runs along the other axis.
    pub const LAST_TURNS: u32 = 1 << 27;
    /// Most points that all drawn strands may have together.
    pub const MAX_POINTS: usize = MOST_POINTS;

    /// Index of its first point; the second follows it.
    #[inline]
    pub fn point(self) -> usize {
        self.0 as usize & (Self::MAX_POINTS - 1)
    }

    /// True if it is marked with one of the constants.
    #[inline]
    pub fn is(self, mark: u32) -> bool {
        self.0 & mark != 0
    }
}

/// All strands of a frame on the screen.
#[derive(Debug, Default)]
pub struct Ribbons {
    /// Screen points (see [`Projection`]), shape `[strand][point]`, then pairs of points for the
    /// segments cut by the near plane.
    points: Vec<Vec4>,
    /// Segments that the pairs belong to.
    cuts: Vec<Cut>,
    /// Sorted front to back: key and segment.
    order: Vec<u64>,
    spare: Vec<u64>,
    runs: Vec<Run>,
}

/// A segment that the near plane cuts.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// Its first point.
    point: u32,
    /// Place of the cut, as a share of the way to its last point, and whether the visible part lies behind
    /// it.
    share: f32,
    ahead: bool,
}

/// Result of a thread for a run of strands.
#[derive(Debug, Default)]
struct Run {
    /// Mean inverse depth \[1/m\] and segment.
    segments: Vec<(f32, Segment)>,
    cut_points: Vec<Vec4>,
    cuts: Vec<Cut>,
    nearest: f32,
    farthest: f32,
}

impl Ribbons {
    /// Projects every strand, leaves out the segments that cannot be seen and sorts the others.
    pub fn fill(&mut self, strands: &Strands, projection: &Projection, occluders: &Occluders) {
        let per_strand = strands.points_per_strand;
        let count = strands.strand_count * per_strand;
        // Cut pairs lie behind the strands' points and are replaced each frame.
        self.points.truncate(count);
        self.points.resize(count, Vec4::ZERO);
        let run_count = strands.strand_count.div_ceil(CHUNK);
        if self.runs.len() < run_count {
            self.runs.resize_with(run_count, Run::default);
        }
        let chunk = (CHUNK * per_strand).max(1);
        let runs = &mut self.runs[..run_count];
        self.points.par_chunks_mut(chunk).zip(runs).enumerate().for_each(|(index, (points, run))| {
            run.fill(strands, projection, occluders, index * chunk, points);
        });
        self.join(run_count);
        sort::sort_by_key(&mut self.order, &mut self.spare);
    }

    fn join(&mut self, run_count: usize) {
        self.order.clear();
        self.cuts.clear();
        let runs = &self.runs[..run_count];
        let nearest = runs.iter().fold(f32::MIN, |nearest, run| nearest.max(run.nearest));
        let farthest = runs.iter().fold(f32::MAX, |farthest, run| farthest.min(run.farthest));
        let scale = MAX_KEY as f32 / (nearest - farthest).max(f32::MIN_POSITIVE);
        for run in runs {
            let cut_start = self.points.len() as u32;
            let keyed = run.segments.iter().map(|&(inverse_depth, segment)| {
                let key = (((nearest - inverse_depth) * scale) as u32).min(MAX_KEY);
                // The points of a cut segment are counted from the run's first.
                let shift = if segment.is_cut() { cut_start } else { 0 };
                sort::keyed(key, segment.without_cut_mark() + shift)
            });
            self.order.extend(keyed);
            self.points.extend_from_slice(&run.cut_points);
            self.cuts.extend_from_slice(&run.cuts);
        }
    }

    /// Number of segments left.
    pub fn segment_count(&self) -> usize {
        self.order.len()
    }

    /// A segment, counted from the front.
    #[inline]
    pub fn segment(&self, index: usize) -> Segment {
        Segment(sort::payload(self.order[index]))
    }

    /// The two screen points of a segment.
    #[inline]
    pub fn ends(&self, segment: Segment) -> [Vec4; 2] {
        let point = segment.point();
        [self.points[point], self.points[point + 1]]
    }

    /// The radiances at the two ends of a segment, from those of a point and the next one.
    #[inline]
    pub fn radiances(
        &self,
        segment: Segment,
        pair: impl FnOnce(usize) -> Option<[Vec3; 2]>,
    ) -> Option<[Vec3; 2]> {
        let point = segment.point();
        let Some(cut) = point.checked_sub(self.points.len() - 2 * self.cuts.len()) else {
            return pair(point);
        };
        let Cut { point, share, ahead } = self.cuts[cut / 2];
        let [first, last] = pair(point as usize)?;
        let between = first.lerp(last, share);
        Some(if ahead { [between, last] } else { [first, between] })
    }

    /// The direction across the line that divides two segments at a joint, root to tip.
    pub fn across(&self, joint: usize) -> Vec2 {
        let [before, at, after] = [joint - 1, joint, joint + 1].map(|point| self.points[point].xy());
        (at - before).normalize_or_zero() + (after - at).normalize_or_zero()
    }
}

impl Segment {
    /// Marks a segment of a cut pair until its index is final.
    const CUT: u32 = 1 << 26;

    fn is_cut(self) -> bool {
        self.is(Self::CUT)
    }

    fn without_cut_mark(self) -> u32 {
        self.0 & !Self::CUT
    }
}

impl Run {
    fn fill(
        &mut self,
        strands: &Strands,
        projection: &Projection,
        occluders: &Occluders,
        first: usize,
        points: &mut [Vec4],
    ) {
        self.segments.clear();
        self.cut_points.clear();
        self.cuts.clear();
        self.nearest = f32::MIN;
        self.farthest = f32::MAX;
        let positions = &strands.positions[first..first + points.len()];
        let widths = &strands.widths[first..first + points.len()];
        for ((screen, &position), &width) in points.iter_mut().zip(positions).zip(widths) {
            *screen = projection.screen(position, width);
        }
        let per_strand = strands.points_per_strand;
        for (strand, points) in points.chunks_exact(per_strand).enumerate() {
            let start = first + strand * per_strand;
            self.strand(points, start, occluders);
            if points.iter().any(|point| point.z == 0.0) {
                self.cut(points, start, strands, projection);
            }
        }
    }

    /// Notes the segments of a strand that lie behind the near plane and may be seen.
    fn strand(&mut self, points: &[Vec4], start: usize, occluders: &Occluders) {
        let mut along_y = is_longer_in_y(points[0], points[1], 1.0);
        let mut turns = false;
        let last = points.len() - 2;
        for (index, pair) in points.windows(2).enumerate() {
            let next_along_y = match points.get(index + 2) {
                Some(&next) => {
                    is_longer_in_y(pair[1], next, if along_y { 1.0 / AXIS_HOLD } else { AXIS_HOLD })
                }
                None => along_y,
            };
            if pair[0].z > 0.0 && pair[1].z > 0.0 && !occluders.hide(pair[0], pair[1]) {
                let mark = |condition: bool, mark: u32| if condition { mark } else { 0 };
                let marks = mark(along_y, Segment::ALONG_Y)
                    | mark(index == 0, Segment::FIRST_IS_END)
                    | mark(index == last, Segment::LAST_IS_END)
                    | mark(turns, Segment::FIRST_TURNS)
                    | mark(next_along_y != along_y, Segment::LAST_TURNS);
                self.push(0.5 * (pair[0].z + pair[1].z), (start + index) as u32 | marks);
            }
            turns = next_along_y != along_y;
            along_y = next_along_y;
        }
    }

    /// Notes the visible part of every segment that crosses the near plane.
    fn cut(&mut self, points: &[Vec4], start: usize, strands: &Strands, projection: &Projection) {
        for (index, pair) in points.windows(2).enumerate() {
            let (near_first, near_last) = (pair[0].z == 0.0, pair[1].z == 0.0);
            let (first, last) = (start + index, start + index + 1);
            let ends = [strands.positions[first], strands.positions[last]];
            if near_first == near_last || !ends[0].is_finite() || !ends[1].is_finite() {
                continue;
            }
            let widths = [strands.widths[first], strands.widths[last]];
            let (share, screen) = projection.near_crossing(ends[0], ends[1], widths);
            let (points, end) = if near_first {
                ([screen, pair[1]], Segment::FIRST_IS_END)
            } else {
                ([pair[0], screen], Segment::LAST_IS_END)
            };
            let along_y = is_longer_in_y(points[0], points[1], 1.0);
            let axis = if along_y { Segment::ALONG_Y } else { 0 };
            let point = self.cut_points.len() as u32;
            self.push(0.5 * (points[0].z + points[1].z), point | axis | end | Segment::CUT);
            self.cut_points.extend(points);
            self.cuts.push(Cut { point: first as u32, share, ahead: near_first });
        }
    }

    fn push(&mut self, inverse_depth: f32, segment: u32) {
        self.nearest = self.nearest.max(inverse_depth);
        self.farthest = self.farthest.min(inverse_depth);
        self.segments.push((inverse_depth, Segment(segment)));
    }
}

/// True if a segment is longer in y than `hold` times its length in x.
fn is_longer_in_y(start: Vec4, end: Vec4, hold: f32) -> bool {
    (end.y - start.y).abs() > hold * (end.x - start.x).abs()
}
