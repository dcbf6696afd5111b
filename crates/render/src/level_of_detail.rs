use strandline_base::{Group, LaneSet, settings};

use crate::{Camera, RenderError};

settings! {
    /// Detail by viewing distance [Chen2011 table 5] and the size of a pixel.
    ///
    /// Distances are those of a picture of 600 rows and a field of view of 30 degrees: where more rows or a
    /// narrower view make pixels smaller, hair counts as nearer (`by_pixel`). Up to `full_distance` everything is
    /// drawn, and where the nearest hair is nearer than a third of it, segments become more with the square root of
    /// the nearness, up to `most_segments`. Beyond it the share of follow strands falls in inverse
    /// proportion to the distance, and that of segments with its square root (a segment strays from the
    /// curve by the square of its length, so it strays by the same number of pixels), down to their least shares. Both
    /// numbers are continuous, so nothing jumps: the last follow strand fades by its width while the
    /// others widen (their sum stays), and the last segment of a strand shrinks to nothing at the tip. Strands without
    /// follow strands stand for themselves: of each eight as many are left out, in the same way.
    pub struct LevelOfDetail: Copy {
        /// Segments on each span between two guide points at full detail.
        segments_per_span: u32 = 4, in [1, 16], more "rounder strands, at a cost that grows with it";
        /// Distance from the camera to the hair's middle up to which all is drawn.
        full_distance: f32 = 1.5, in [1e-3, 1e6] "m", slider [0.2, 10.0],
            more "detail that falls later";
        /// Least share of the strands that is drawn from afar: of follow strands where there are some.
        least_strands: f32 = 0.125, in [0.0, 1.0], more "more, thinner strands from afar";
        /// Least share of the segments that is drawn from afar.
        least_segments: f32 = 0.5, in [0.0, 1.0], more "rounder strands from afar";
        /// Most segments close up, as a multiple of `segments_per_span`, while all strands together have no more
        /// than 4,000,000 points.
        most_segments: f32 = 4.0, in [1.0, 16.0], more "rounder strands close up";
        /// Relates distances to a picture of 600 rows and a field of view of 30 degrees, so that more rows or
        /// a narrower view count as nearness; without it distance alone counts.
        by_pixel: bool = true;
    }
}

impl LevelOfDetail {
    /// Full detail at any distance.
    pub fn full() -> Self {
        Self { least_strands: 1.0, least_segments: 1.0, most_segments: 1.0, ..Self::default() }
    }

    /// Detail that falls from 0.2 m on, as the thesis measured it [Chen2011 table 5]: at 3 m a fifteenth of
    /// the follow strands, with a quarter of their segments.
    pub fn thesis() -> Self {
        Self {
            segments_per_span: 4,
            full_distance: 0.2,
            least_strands: 0.05,
            least_segments: 0.25,
            most_segments: 1.0,
            by_pixel: false,
        }
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// The first setting outside its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        Ok(self.check_as("level_of_detail")?)
    }

    /// Factor of distances in a picture of a number of rows: pixels are as large as from there in a picture
    /// of 600 rows and 30 degrees.
    pub fn view_scale(&self, camera: &Camera, rows: u32) -> f32 {
        if !self.by_pixel {
            return 1.0;
        }
        (ROWS / rows.max(1) as f32) * (Camera::default().focal() / camera.focal())
    }

    /// The level for hair of `guide_count` guides with a number of points, at view distances \[m\] as for
    /// [`LevelOfDetail::level_from`]. Close up, the number of segments grows up to the memory that is set aside for them.
    pub(crate) fn level_of(
        &self,
        [distance, nearest]: [f32; 2],
        follow_strands: u32,
        [guide_count, points_per_strand]: [usize; 2],
    ) -> DetailLevel {
        let level = self.level_from(distance, nearest, follow_strands);
        let strands = (guide_count * level.strand_count()).max(1) as f32;
        let spans = points_per_strand.saturating_sub(1).max(1) as f32;
        let most = ((MOST_CLOSE / strands - 1.0) / spans).max(self.segments_per_span as f32);
        DetailLevel { segments_per_span: level.segments_per_span.min(most), ..level }
    }

    /// The level for hair that is all at one view distance \[m\] from the camera, of a look with `follow_strands`
    /// strands to a guide.
    pub fn level(&self, distance: f32, follow_strands: u32) -> DetailLevel {
        self.level_from(distance, distance, follow_strands)
    }

    /// The level for hair whose middle is at a view distance \[m\] from the camera. `nearest` \[m\] is the view distance
    /// of the nearest point of its box at rest.
    pub fn level_from(&self, distance: f32, nearest: f32, follow_strands: u32) -> DetailLevel {
        let share = self.full_distance / distance.max(self.full_distance);
        let nearness = CLOSE * self.full_distance / nearest.max(f32::MIN_POSITIVE);
        let more = nearness.sqrt().min(self.most_segments).max(1.0);
        let follow_strands = follow_strands.max(1) as f32;
        let drawn = share.max(self.least_strands);
        let left_out = if follow_strands > 1.0 { 0.0 } else { EIGHT - (EIGHT * drawn).max(1.0) };
        DetailLevel {
            segments_per_span: (self.segments_per_span as f32 * share.sqrt().max(self.least_segments) * more)
                .max(1.0),
            follow_strands: (follow_strands * drawn).max(1.0),
            full_follow_strands: follow_strands,
            left_out,
        }
    }
}

/// Drawn strands of each guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetailLevel {
    /// Segments on each span, at least 1; a fraction ends the strand with a shorter segment.
    pub segments_per_span: f32,
    /// Follow strands of each guide, the guide itself among them, at least 1; a fraction thins the last.
    pub follow_strands: f32,
    /// Follow strands of each guide at full detail.
    pub full_follow_strands: f32,
    /// Of each eight strands without follow strands, those that are not drawn, at most 7; a fraction thins one.
    pub left_out: f32,
}

/// Rows of the picture whose distances are as they are.
const ROWS: f32 = 600.0;
/// Share of the full distance below which segments become more.
const CLOSE: f32 = 1.0 / 3.0;
/// Points up to which segments become more: some 0.6 GB on a processor, buffers within WebGPU's limits on a GPU.
const MOST_CLOSE: f32 = 4e6;
/// Number of strands in a group from which some are left out.
const EIGHT: f32 = 8.0;
/// Ranks of eight strands: those of a higher rank are left out first, so that the rest stays evenly spread.
const RANKS: [f32; 8] = [0.0, 4.0, 2.0, 6.0, 1.0, 5.0, 3.0, 7.0];

/// Of eight guides those whose strands are drawn when a number of them are left out.
fn drawn_lanes(left_out: f32) -> LaneSet {
    LaneSet::of(|lane| RANKS[lane] < EIGHT - left_out)
}

/// Number of strands that represent any larger number: eight of them cross each cell of a grid of light.
const ENOUGH: usize = 4096;
/// Largest number of strands that one strand represents.
const EVERY: usize = 4;

/// Every n-th strand, spread evenly over guides and clumps, as a sample of all strands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EveryFew(u32);

impl Default for EveryFew {
    /// All strands.
    fn default() -> Self {
        Self(1)
    }
}

impl EveryFew {
    /// The sample for a number of strands at full detail, so that nothing jumps with distance. Of few strands it takes all:
    /// a smaller sample would depend on the choice.
    pub(crate) fn of(full_count: usize) -> Self {
        Self(1 << (full_count / ENOUGH).clamp(1, EVERY).ilog2())
    }

    /// Number of strands that each of them stands for.
    pub(crate) fn stands_for(self) -> u32 {
        self.0
    }

    /// True if strand `index` of a guide is one of them. Eights of guides take turns, so that detail that leaves some of
    /// eight out leaves as many of these.
    #[inline]
    pub(crate) fn holds(self, guide: usize, index: usize) -> bool {
        (guide / RANKS.len() + index).is_multiple_of(self.0 as usize)
    }
}

impl DetailLevel {
    /// Full detail: all segments of each span and all follow strands.
    pub fn full(segments_per_span: u32, follow_strands: u32) -> Self {
        Self {
            segments_per_span: segments_per_span as f32,
            follow_strands: follow_strands as f32,
            full_follow_strands: follow_strands as f32,
            left_out: 0.0,
        }
    }

    /// Segments of a strand whose guide has `points_per_strand` points.
    pub fn segment_count(&self, points_per_strand: usize) -> usize {
        // A remainder below this share of a segment is rounding, not a segment.
        const ROUNDING: f32 = 1e-3;
        let segments = (points_per_strand - 1) as f32 * self.segments_per_span;
        ((segments - ROUNDING).ceil() as usize).max(1)
    }

    /// Strands drawn of each guide.
    pub fn strand_count(&self) -> usize {
        (self.follow_strands.ceil() as usize).max(1)
    }

    /// Of each eight guides those whose strands are drawn.
    pub fn drawn_lanes(&self) -> LaneSet {
        drawn_lanes(self.left_out)
    }

    /// Strands drawn of `guide_count` guides.
    pub fn drawn_strands(&self, guide_count: usize) -> usize {
        self.drawn_lanes().count_of(guide_count) * self.strand_count()
    }

    /// Width of the strands of a guide, among `guide_count`, as a multiple of that at full detail. The multiples of each
    /// eight guides sum to eight.
    pub fn own_width_scale(&self, guide: usize, guide_count: usize) -> f32 {
        let first = guide / RANKS.len() * RANKS.len();
        let presence = |rank: f32| (EIGHT - self.left_out - rank).clamp(0.0, 1.0);
        let ranks = &RANKS[..(guide_count - first).min(RANKS.len())];
        let drawn: f32 = ranks.iter().map(|rank| presence(*rank)).sum();
        presence(RANKS[guide - first]) * ranks.len() as f32 / drawn
    }

    /// Width of follow strand `index` as a multiple of its width at full detail. Over a guide's
    /// strands the multiples sum to the full number of follow strands.
    pub fn width_scale(&self, index: usize) -> f32 {
        let presence = (self.follow_strands - index as f32).clamp(0.0, 1.0);
        presence * self.full_follow_strands / self.follow_strands
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_few_strands_are_spread_evenly() {
        let all = [2, 4].into_iter().flat_map(|times| [1, 3, 16].map(|per_guide| (times, per_guide)));
        for (times, per_guide) in all {
            let few = EveryFew::of(times * ENOUGH);
            assert_eq!(few.stands_for() as usize, times);
            for left_out in [0.0, 2.5, 7.0] {
                let lanes = drawn_lanes(left_out);
                let drawn = lanes.count_of(32 * 10);
                let held = |index: usize| {
                    let guide = lanes.strand(index);
                    (0..per_guide).filter(|index| few.holds(guide, *index)).count()
                };
                let found: usize = (0..drawn).map(held).sum();
                assert_eq!(few.stands_for() as usize * found, drawn * per_guide, "{per_guide}, {left_out}");
            }
        }
        assert_eq!(EveryFew::of(2 * ENOUGH - 1), EveryFew::default());
        assert!((0..100).all(|strand| EveryFew::default().holds(strand / 3, strand % 3)));
    }

    #[test]
    fn in_the_thesis_detail_falls_at_each_of_its_distances() {
        let level = |distance| LevelOfDetail::thesis().level(distance, 16);
        let segments = |distance| {
            let level: DetailLevel = level(distance);
            level.follow_strands * level.segments_per_span
        };
        assert!(LevelOfDetail::thesis().validate().is_ok());
        assert_eq!(level(0.2), DetailLevel::full(4, 16));
        for [near, far] in [[0.2, 0.4], [0.4, 0.6], [0.6, 1.0], [1.0, 1.5], [1.5, 3.0]] {
            assert!(segments(far) < 0.75 * segments(near), "{near} m and {far} m");
        }
    }

    #[test]
    fn widths_sum_to_the_full_number() {
        for follow_strands in [16.0, 11.3, 7.999, 4.0, 1.0] {
            let level = DetailLevel { follow_strands, ..DetailLevel::full(4, 16) };
            let sum: f32 = (0..level.strand_count()).map(|index| level.width_scale(index)).sum();
            // Sixteen roundings of single precision.
            assert!((sum - 16.0).abs() < 16.0 * 16.0 * f32::EPSILON, "{follow_strands}: {sum}");
        }
    }

    #[test]
    fn strands_that_stand_for_themselves_are_left_out_and_the_others_widen() {
        let mut last = 8;
        for step in 0..100 {
            let level = LevelOfDetail::default().level(0.2 * step as f32, 1);
            let drawn = level.drawn_strands(80);
            assert!(drawn <= 10 * last && drawn.is_multiple_of(10), "{drawn}");
            last = drawn / 10;
            for count in [1, 5, 8, 19] {
                let widths: Vec<f32> = (0..count).map(|guide| level.own_width_scale(guide, count)).collect();
                let sum: f32 = widths.iter().sum();
                assert!((sum - count as f32).abs() < 1e-5 * count as f32, "{count} at {step}: {sum}");
                assert_eq!(widths.iter().filter(|width| **width > 0.0).count(), level.drawn_strands(count));
            }
        }
        assert_eq!(last, 1, "least_strands is an eighth");
        let level = |share: f32| LevelOfDetail::default().level(1.5 / share, 1);
        let width = |strand: usize, share: f32| level(share).own_width_scale(strand, 8);
        // Strand 7 is the first to go and fades, strand 0 is the last.
        assert_eq!([width(7, 1.0), width(0, 1.0)], [1.0, 1.0]);
        assert!((width(7, 0.95) - 0.6 / 0.95).abs() < 1e-4 && (width(0, 0.95) - 1.0 / 0.95).abs() < 1e-4);
        assert!(width(7, 0.87) == 0.0 && width(0, 0.125) == 8.0);
    }

    #[test]
    fn detail_never_rises_with_distance() {
        let settings = LevelOfDetail::default();
        let mut last = settings.level(0.01, 16);
        assert_eq!(last, DetailLevel::full(16, 16));
        assert_eq!(
            [0.5, 1.0, 1.5].map(|distance| settings.level(distance, 16)),
            [DetailLevel::full(4, 16); 3]
        );
        for step in 1..200 {
            let level = settings.level(0.1 * step as f32, 16);
            assert!(level.follow_strands <= last.follow_strands);
            assert!(level.segments_per_span <= last.segments_per_span);
            last = level;
        }
        assert_eq!((last.follow_strands, last.segments_per_span), (2.0, 2.0));
    }

    #[test]
    fn what_counts_is_the_size_of_a_pixel() {
        let (by_pixel, front) = (LevelOfDetail::default(), Camera::front());
        let by_distance = LevelOfDetail { by_pixel: false, ..by_pixel };
        assert_eq!([300, 600, 1200].map(|rows| by_pixel.view_scale(&front, rows)), [2.0, 1.0, 0.5]);
        // A lens that shows a tenth of the height.
        let slope = 0.1 * 15f32.to_radians().tan();
        let long = Camera { field_of_view: 2.0 * slope.atan().to_degrees(), ..front };
        assert!((by_pixel.view_scale(&long, 600) - 0.1).abs() < 1e-5);
        assert_eq!([300, 1200].map(|rows| by_distance.view_scale(&long, rows)), [1.0; 2]);
    }

    #[test]
    fn close_up_segments_become_more_as_far_as_memory_is_meant_for_them() {
        let detail = LevelOfDetail::default();
        let segments = |distance, guides| detail.level_of([distance; 2], 16, [guides, 28]).segments_per_span;
        assert_eq!([0.5, 0.125, 0.02].map(|distance| segments(distance, 100)), [4.0, 8.0, 16.0]);
        let level = detail.level_of([0.02; 2], 16, [1500, 28]);
        let points = 1500 * level.strand_count() * (level.segment_count(28) + 1);
        assert!(level.segments_per_span > 5.0 && (3_900_000..=4_024_000).contains(&points), "{points}");
        let around = detail.level_of([0.5, 0.0], 16, [100, 28]);
        assert_eq!(around.segments_per_span, 16.0, "a camera within the hair");
        assert_eq!(segments(0.02, 50_000), 4.0, "what full detail has stays");
        assert_eq!(LevelOfDetail::full().level(0.02, 16), DetailLevel::full(4, 16));
    }

    #[test]
    fn settings_outside_their_range_are_refused() {
        assert!(LevelOfDetail::default().validate().is_ok());
        assert!(LevelOfDetail { segments_per_span: 0, ..Default::default() }.validate().is_err());
        assert!(LevelOfDetail { full_distance: f32::NAN, ..Default::default() }.validate().is_err());
        assert!(LevelOfDetail { most_segments: f32::NAN, ..Default::default() }.validate().is_err());
        assert!(LevelOfDetail { least_strands: 1.5, ..Default::default() }.validate().is_err());
    }
}
