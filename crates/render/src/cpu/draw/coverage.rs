//! One ribbon segment in one tile: its coverage of each sample, composited under the segments before it.
//!
//! Along the axis in which a segment is longer, it is cut into steps one sample wide; across, at each
//! step, the ribbon is a box as wide as the ribbon is along that axis, and at least one sample wide,
//! smoothed over one sample. Summed over the samples of a step this is the ribbon's width, whatever
//! its angle and place. Steps belong to the segment that holds their middle, so that the segments of
//! a strand neither overlap nor leave gaps; at the two ends of a strand a step counts by the share
//! that is covered.

use glam::{Vec2, Vec4};

use crate::frame::samples::TILE;

/// Width \[sample\] from which on ribbons are drawn round, and from which on they are wholly so.
const ROUND_FROM: f32 = 2.0;
const ROUND_FULL: f32 = 6.0;
/// Roundness of wide ribbons: their middle has 1.3 times the light of a flat one, their edges 0.4 of it.
const ROUNDNESS: f32 = 0.9;

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
    /// Shape of this end.
    pub joint: Joint,
}

/// Shape of an end of a segment.
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
    /// True if wide ribbons are brighter in the middle than at their edges, as round fibres are.
    pub round: bool,
}

impl TileSamples<'_> {
    /// Composites a segment, from `first` to `last` along its strand, under the segments before it.
    pub fn add(&mut self, first: &End, last: &End, along_y: bool) {
        match (along_y, self.depths.is_some()) {
            (false, false) => self.fill::<false, false>(first, last),
            (false, true) => self.fill::<false, true>(first, last),
            (true, false) => self.fill::<true, false>(first, last),
            (true, true) => self.fill::<true, true>(first, last),
        }
    }

    fn fill<const ALONG_Y: bool, const BODY: bool>(&mut self, first: &End, last: &End) {
        let run = Run::of::<ALONG_Y>(first, last);
        let turns = Turns::of(first, last);
        if turns.is_none() && run.is_bare {
            for step in run.steps(0.0) {
                let (stroke, color) = run.stroke(step);
                if stroke.width <= 1.0 {
                    self.thin_stroke::<ALONG_Y, BODY>(&stroke, color);
                } else {
                    self.stroke::<ALONG_Y, BODY>(&stroke, color, None);
                }
            }
        } else {
            // A neighbour along the other axis is met on a slant, beyond the joint.
            let reach = if turns.is_some() { 0.5 * run.widest.max(1.0) + 1.0 } else { 0.0 };
            for step in run.steps(reach) {
                let (mut stroke, color) = run.stroke(step);
                stroke.share = run.covered(step);
                self.stroke::<ALONG_Y, BODY>(&stroke, color, turns.as_ref());
            }
        }
    }

    /// One step of a ribbon thinner than a sample: the two samples beside its middle.
    #[inline]
    fn thin_stroke<const ALONG_Y: bool, const BODY: bool>(&mut self, stroke: &Stroke, color: Vec4) {
        // Counted from one sample before the tile, so that cutting off rounds down.
        let place = (stroke.center + 0.5).clamp(0.0, TILE as f32 + 1.0);
        let after = place as i32;
        let share = place - after as f32;
        for (place, share) in [(after - 1, 1.0 - share), (after, share)] {
            if (0..TILE as i32).contains(&place) {
                let sample = index::<ALONG_Y>(stroke.step, place as usize);
                self.blend::<BODY>(sample, stroke.depth, color, stroke.width * share);
            }
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
        // Thinner than a sample: drawn one sample wide and as much fainter.
        let strength = stroke.width.min(1.0) * stroke.share;
        let reach = 0.5 * stroke.width.max(1.0) + 0.5;
        let low = (stroke.center - reach + 0.5).clamp(0.0, TILE as f32) as usize;
        let end = (stroke.center + reach + 0.5).clamp(0.0, TILE as f32) as usize;
        let round = if self.round { stroke.roundness() } else { 0.0 };
        for place in low..end {
            let sample = index::<ALONG_Y>(stroke.step, place);
            if turns.is_none_or(|turns| turns.own(sample)) {
                let distance = (place as f32 + 0.5 - stroke.center).abs();
                let coverage = strength * (reach - distance).clamp(0.0, 1.0);
                let color = if round > 0.0 { stroke.shaded(color, distance, round) } else { color };
                self.blend::<BODY>(sample, stroke.depth, color, coverage);
            }
        }
    }

    #[inline]
    fn blend<const BODY: bool>(&mut self, sample: usize, depth: f32, color: Vec4, coverage: f32) {
        if BODY && self.depths.is_some_and(|depths| depths[sample] > depth) {
            return;
        }
        let below = &mut self.colors[sample];
        *below += color * (coverage * (1.0 - below.w));
    }
}

#[inline]
fn index<const ALONG_Y: bool>(step: usize, place: usize) -> usize {
    if ALONG_Y { step * TILE + place } else { place * TILE + step }
}

/// A segment in the direction of its axis; the strand may run either way.
struct Run<'a> {
    low: &'a End,
    /// From `low` to the other end.
    point: Vec4,
    color: Vec4,
    high_joint: Joint,
    /// Neither end is a strand's.
    is_bare: bool,
    /// Begin and end on its axis, and begin on the other axis \[sample\].
    start: f32,
    end: f32,
    across: f32,
    slope: f32,
    /// Share of the segment in one step.
    per_step: f32,
    /// Width on the other axis over width.
    slant: f32,
    /// Greatest width on the other axis \[sample\].
    widest: f32,
}

impl<'a> Run<'a> {
    #[inline]
    fn of<const ALONG_Y: bool>(first: &'a End, last: &'a End) -> Self {
        let along = |end: &End| if ALONG_Y { end.point.y } else { end.point.x };
        let across = |end: &End| if ALONG_Y { end.point.x } else { end.point.y };
        let (low, high) = if along(first) <= along(last) { (first, last) } else { (last, first) };
        let (start, end) = (along(low), along(high));
        let per_step = 1.0 / (end - start).max(1e-6);
        let slope = ((across(high) - across(low)) * per_step).clamp(-2.0, 2.0);
        let slant = (1.0 + slope * slope).sqrt();
        Self {
            low,
            point: high.point - low.point,
            color: high.color - low.color,
            high_joint: high.joint,
            is_bare: low.joint != Joint::Tip && high.joint != Joint::Tip,
            start,
            end,
            across: across(low),
            slope,
            per_step,
            slant,
            widest: slant * low.point.w.max(high.point.w),
        }
    }

    /// The steps inside the tile.
    #[inline]
    fn steps(&self, reach: f32) -> std::ops::Range<usize> {
        let inside = |at: f32| at.clamp(0.0, TILE as f32);
        // The first step with its middle at or behind a place: half a sample on, rounded down after
        // one more, unless it is there exactly.
        let from = |at: f32| {
            let at = inside(at - 0.5);
            let whole = at as usize;
            whole + usize::from(at > whole as f32)
        };
        let low = match self.low.joint {
            Joint::Straight => from(self.start),
            Joint::Tip => inside(self.start) as usize,
            Joint::Turn(_) => inside(self.start - reach) as usize,
        };
        let high = match self.high_joint {
            Joint::Straight => from(self.end),
            Joint::Tip => from(self.end + 0.5),
            Joint::Turn(_) => from(self.end + reach + 0.5),
        };
        low..high
    }

    #[inline]
    fn stroke(&self, step: usize) -> (Stroke, Vec4) {
        let along = step as f32 + 0.5 - self.start;
        let share = (along * self.per_step).clamp(0.0, 1.0);
        let point = self.low.point + self.point * share;
        let stroke = Stroke {
            step,
            center: self.across + self.slope * along,
            width: self.slant * point.w,
            share: 1.0,
            depth: point.z,
        };
        (stroke, self.low.color + self.color * share)
    }

    /// Share of a step that is covered: less than all at the ends of a strand.
    fn covered(&self, step: usize) -> f32 {
        let left = step as f32;
        let from = if self.low.joint == Joint::Tip { self.start.max(left) } else { left };
        let to = if self.high_joint == Joint::Tip { self.end.min(left + 1.0) } else { left + 1.0 };
        (to - from).max(0.0)
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

impl Stroke {
    /// Roundness: thin ribbons are flat.
    #[inline]
    fn roundness(&self) -> f32 {
        ROUNDNESS * ((self.width - ROUND_FROM) / (ROUND_FULL - ROUND_FROM)).clamp(0.0, 1.0)
    }

    /// The colour of a round ribbon in a sample at a distance from its middle: 1 + roundness (1/3 - x^2) times its own
    /// at x half widths, whose mean over the width is 1; integrated over what of the sample is covered, so that the sum
    /// over all samples is that of a flat ribbon.
    #[inline]
    fn shaded(&self, color: Vec4, distance: f32, round: f32) -> Vec4 {
        let half = 0.5 * self.width;
        let (low, high) = ((distance - 0.5).max(-half), (distance + 0.5).min(half));
        let square = (high * high + high * low + low * low) / (3.0 * half * half);
        let light = 1.0 + round * (1.0 / 3.0 - square);
        color * Vec4::new(light, light, light, 1.0)
    }
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

    /// True if a sample belongs to this segment: on the tip's side of the first line, not of the last.
    fn own(&self, sample: usize) -> bool {
        let middle = Vec2::new((sample % TILE) as f32 + 0.5, (sample / TILE) as f32 + 0.5);
        let is_past = |(point, direction): (Vec2, Vec2)| (middle - point).dot(direction) >= 0.0;
        self.first.is_none_or(is_past) && !self.last.is_some_and(is_past)
    }
}
