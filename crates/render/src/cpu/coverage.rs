//! One ribbon segment in one tile: how much of each sample it covers, composited under what is there.
//!
//! Along the axis in which a segment is longer, it is cut into steps one sample wide; across, at each
//! step, the ribbon is a box as wide as the ribbon is along that axis, and at least one sample wide,
//! smoothed over one sample. Summed over the samples of a step this is the ribbon's width, whatever
//! its angle and place. Steps belong to the segment that holds their middle, so that the segments of
//! a strand neither overlap nor leave gaps; at the two ends of a strand a step counts by the share
//! that is covered.

use glam::{Vec2, Vec4};

use super::samples::TILE;

/// Samples with less than this left to show are done.
pub const OPAQUE: f32 = 1.0 - 1.0 / 512.0;

/// One end of a segment: x and y relative to the tile \[sample\], one over the view depth \[1/m\], width
/// \[sample\].
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Screen point.
    pub point: Vec4,
    /// Radiance, linear RGB, and 1.
    pub color: Vec4,
    /// What happens here.
    pub joint: Joint,
}

/// What happens at an end of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// The neighbour runs along the same axis.
    Straight,
    /// The strand ends.
    Tip,
    /// The neighbour runs along the other axis: the line through this point across this direction
    /// (which points from the root to the tip) divides them.
    Turn(Vec2),
}

/// The samples of one tile, rows of [`TILE`].
pub struct TileSamples<'a> {
    /// Radiance times opacity, and opacity.
    pub colors: &'a mut [Vec4],
    /// One over the body's view depth \[1/m\]; `None` when the tile shows no body.
    pub depths: Option<&'a [f32]>,
}

impl TileSamples<'_> {
    /// Composites a segment, from `first` to `last` along its strand, under what is there.
    pub fn add(&mut self, first: &End, last: &End, along_y: bool) {
        match (along_y, self.depths.is_some()) {
            (false, false) => self.fill::<false, false>(first, last),
            (false, true) => self.fill::<false, true>(first, last),
            (true, false) => self.fill::<true, false>(first, last),
            (true, true) => self.fill::<true, true>(first, last),
        }
    }

    fn fill<const ALONG_Y: bool, const BODY: bool>(&mut self, first: &End, last: &End) {
        let along = |end: &End| if ALONG_Y { end.point.y } else { end.point.x };
        let across = |end: &End| if ALONG_Y { end.point.x } else { end.point.y };
        // `low` and `high` in order along the axis; the strand may run either way.
        let (low, high) = if along(first) <= along(last) { (first, last) } else { (last, first) };
        let (start, end) = (along(low), along(high));
        let length = end - start;
        let per_step = 1.0 / length.max(1e-6);
        let slope = ((across(high) - across(low)) * per_step).clamp(-2.0, 2.0);
        // Width along the other axis [sample].
        let slant = (1.0 + slope * slope).sqrt();
        let widest = slant * low.point.w.max(high.point.w);
        let turn = Turns::of(first, last);
        let reach = if turn.is_some() { 0.5 * widest.max(1.0) + 1.0 } else { 0.0 };
        let lowest = match low.joint {
            Joint::Straight => (start - 0.5).ceil(),
            Joint::Tip => start.floor(),
            Joint::Turn(_) => (start - reach).floor(),
        };
        let highest = match high.joint {
            Joint::Straight => (end - 0.5).ceil(),
            Joint::Tip => end.ceil(),
            Joint::Turn(_) => (end + reach).ceil(),
        };
        let steps = lowest.max(0.0) as usize..highest.clamp(0.0, TILE as f32) as usize;
        for step in steps {
            let left = step as f32;
            let share = ((left + 0.5 - start) * per_step).clamp(0.0, 1.0);
            let from = if low.joint == Joint::Tip { start.max(left) } else { left };
            let to = if high.joint == Joint::Tip { end.min(left + 1.0) } else { left + 1.0 };
            let point = low.point + (high.point - low.point) * share;
            let color = low.color + (high.color - low.color) * share;
            let center = across(low) + slope * (left + 0.5 - start);
            let stroke = Stroke { step, center, width: slant * point.w, share: to - from, depth: point.z };
            self.stroke::<ALONG_Y, BODY>(&stroke, color, turn.as_ref());
        }
    }

    /// One step: the samples across the ribbon.
    #[inline]
    fn stroke<const ALONG_Y: bool, const BODY: bool>(
        &mut self,
        stroke: &Stroke,
        color: Vec4,
        turns: Option<&Turns>,
    ) {
        let Stroke { step, center, width, share, depth } = *stroke;
        // Thinner than a sample: drawn one sample wide and as much fainter.
        let strength = width.min(1.0) * share;
        let reach = 0.5 * width.max(1.0) + 0.5;
        let low = (center - reach + 0.5).floor().max(0.0) as usize;
        let end = (center + reach - 0.5).ceil().clamp(0.0, TILE as f32) as usize;
        for place in low..end {
            let sample = if ALONG_Y { step * TILE + place } else { place * TILE + step };
            if BODY && self.depths.is_some_and(|depths| depths[sample] > depth) {
                continue;
            }
            if turns.is_some_and(|turns| !turns.own(sample)) {
                continue;
            }
            let distance = (place as f32 + 0.5 - center).abs();
            let coverage = strength * (reach - distance).clamp(0.0, 1.0);
            let below = &mut self.colors[sample];
            *below += color * (coverage * (1.0 - below.w));
        }
    }
}

/// One step of a segment.
struct Stroke {
    /// Index along the axis.
    step: usize,
    /// Middle of the ribbon on the other axis \[sample\].
    center: f32,
    /// Width along the other axis \[sample\].
    width: f32,
    /// Covered share of the step.
    share: f32,
    /// One over the view depth \[1/m\].
    depth: f32,
}

/// The lines that bound a segment whose neighbours run along the other axis.
struct Turns {
    /// A point of each line and the direction across it, root to tip.
    first: Option<(Vec2, Vec2)>,
    last: Option<(Vec2, Vec2)>,
}

impl Turns {
    fn of(first: &End, last: &End) -> Option<Self> {
        let line = |end: &End| match end.joint {
            Joint::Turn(direction) => Some((end.point.truncate().truncate(), direction)),
            _ => None,
        };
        let (first, last) = (line(first), line(last));
        (first.is_some() || last.is_some()).then_some(Self { first, last })
    }

    /// Whether a sample is this segment's: on the tip's side of the first line, not of the last.
    fn own(&self, sample: usize) -> bool {
        let middle = Vec2::new((sample % TILE) as f32 + 0.5, (sample / TILE) as f32 + 0.5);
        let is_past = |(point, direction): (Vec2, Vec2)| (middle - point).dot(direction) >= 0.0;
        self.first.is_none_or(is_past) && !self.last.is_some_and(is_past)
    }
}
