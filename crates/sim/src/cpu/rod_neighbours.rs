//! Segments that may come to touch: a list that is kept while hair moves little against the head, and one for each part
//! while it moves much.

use bytemuck::cast_slice;
use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::Pose;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::rod_pairs::{Look, Point};
use super::rod_sieve::{Across, Eight, ROUNDING};
use super::rod_strands::Hair;
use crate::strands::rods::real::{Real, Vector};
use crate::strands::rods::workspace::Carry;
use crate::wisps::boxes::{Boxes, Met};
use crate::wisps::pair::{Near, Pair};
use crate::wisps::place::NEAR;
use crate::wisps::radii::number;
use crate::wisps::strips::SegmentBox;

/// Parts of a step for which a margin lasts while a point goes on as it does, the least margin \[m\], and the most for more
/// than one part: boxes that are much wider than others are cut.
const LASTS: f32 = 4.0;
const LEAST_MARGIN: f32 = 3e-4;
const MOST_MARGIN: f32 = 6e-3;
/// Mean way of points in a part \[m\] beyond which no list is kept.
const CALM: f32 = 2e-4;
/// Candidates and blocks of strands that a thread takes at a time.
const CHUNK: usize = 1024;
const BLOCKS: usize = 16;

/// Two segments that may come to touch.
#[derive(Clone, Copy)]
struct Candidate {
    segments: [u32; 2],
    /// Sum of the ways of both \[m\] from which they have to be looked at again.
    until: f32,
}

/// Candidates, and the motion of hair against the head since they were found. The contacts that are found do not
/// depend on when that was.
#[derive(Clone, Default)]
pub(super) struct Neighbours {
    boxes: Boxes,
    around: Vec<SegmentBox>,
    met: Vec<Met>,
    candidates: Vec<Candidate>,
    /// Radii \[m\] of the list.
    radii: Vec<Lanes>,
    motions: Vec<Motion>,
    /// Places of points \[m\] when the list was made and in the part before, and their ways in the part, in the frame of the
    /// head, shape `[block][point]` of lanes.
    built: Vec<Vec3Lanes>,
    last: Vec<Vec3Lanes>,
    ahead: Vec<Vec3Lanes>,
    /// Way that a point may move from where it was then \[m\].
    margins: Vec<Lanes>,
    /// Way of a segment since then to the start of a part, and to its end \[m\].
    gone: Vec<Lanes>,
    reach: Vec<Lanes>,
    /// Points in the part, by the number of their lane.
    points: Vec<Point>,
    eights: Vec<Eight>,
    /// Way of a segment \[m\] by which its box is wider.
    wider: Vec<f32>,
    found: Vec<Vec<Near>>,
}

/// Motion of hair against the head in a part.
#[derive(Clone, Copy)]
struct Motion {
    /// True if all points are within their margins.
    stays: bool,
    /// Sum of the ways of all points \[m\].
    ways: f64,
}

impl Motion {
    /// Motion of all blocks: in one order, whatever the threads.
    fn of_all(blocks: &[Self]) -> Self {
        let nothing = Self { stays: true, ways: 0.0 };
        blocks
            .iter()
            .fold(nothing, |one, other| Self { stays: one.stays && other.stays, ways: one.ways + other.ways })
    }
}

impl Neighbours {
    /// Replaces `near` by the pairs that touch, or may come to touch in a part whose strands lie at `start` and go on by
    /// `coast` \[m\]; `pairs` are those of the part before.
    pub(super) fn find(
        &mut self,
        hair: &Hair,
        motion: (&[Vec3Lanes], &[Vec3Lanes]),
        part: u32,
        pairs: &[Pair],
        near: &mut Vec<Near>,
    ) {
        let poses = hair.parts.head_through(part);
        let turn = poses[0].rotation.angle_between(poses[1].rotation);
        // Rise of the arc on which a turn of the head takes two segments, which are looked at along its chord.
        let bow = 0.75 * turn * turn * longest(hair) + ROUNDING;
        let bent = 1.0 + 0.25 * turn;
        let Motion { stays, ways } = self.follow(hair, motion, poses, (bow, bent));
        if !stays {
            let points = hair.model.strand_count * hair.model.points_per_strand;
            // Ways that are no numbers are not calm.
            if ways <= f64::from(CALM) * points as f64 {
                self.build(hair, bow);
            } else {
                self.search(hair, bow, bent);
            }
        }
        let look = Look::new(hair, &self.points, pairs);
        let [gone, reach]: [&[f32]; 2] = [cast_slice(&self.gone), cast_slice(&self.reach)];
        self.found.resize_with(self.candidates.len().div_ceil(CHUNK), Vec::new);
        self.candidates.par_chunks_mut(CHUNK).zip(self.found.par_iter_mut()).for_each(
            |(candidates, found)| {
                found.clear();
                let mut known = look.known_from(candidates[0].segments);
                for candidate in candidates {
                    let [one, other] = candidate.segments.map(|segment| segment as usize);
                    if reach[one] + reach[other] + bow < candidate.until {
                        continue;
                    }
                    let (least, near) = look.at(candidate.segments, &mut known);
                    candidate.until = gone[one] + gone[other] + least;
                    found.extend(near);
                }
            },
        );
        near.clear();
        self.found.iter().for_each(|found| near.extend_from_slice(found));
    }

    /// Takes note of the motion in a part.
    fn follow(
        &mut self,
        hair: &Hair,
        (start, coast): (&[Vec3Lanes], &[Vec3Lanes]),
        poses: [Pose; 2],
        (bow, bent): (f32, f32),
    ) -> Motion {
        let points = hair.model.points_per_strand;
        self.fit(start.len(), &hair.model.radii);
        let mut motions = std::mem::take(&mut self.motions);
        let carries = poses.map(|pose| Carry::new(&pose.inverse()));
        let (built, margins) = (&self.built, &self.margins);
        self.last
            .par_chunks_mut(points)
            .zip(self.ahead.par_chunks_mut(points))
            .zip(self.gone.par_chunks_mut(points))
            .zip(self.reach.par_chunks_mut(points))
            .zip(self.points.par_chunks_mut(points * LANES))
            .enumerate()
            .with_min_len(BLOCKS)
            .map(|(block, ((((last, ahead), gone), reach), ends))| {
                let (mut stays, mut sum) = (f32x8::of(1.0), f32x8::ZERO);
                let [mut stepped, mut goes] = [f32x8::ZERO; 2];
                for point in 0..points {
                    let index = block * points + point;
                    let (here, way) = (Vector::load(&start[index]), Vector::load(&coast[index]));
                    for lane in 0..LANES {
                        ends[point * LANES + lane] =
                            Point { start: start[index].get(lane), coast: coast[index].get(lane) };
                    }
                    let [from, to] = [carries[0].point(here), carries[1].point(here + way)];
                    let was = Vector::load(&built[index]);
                    let far = (from - was).length().fast_max((to - was).length());
                    let (step, on) = ((from - Vector::load(&last[point])).length(), (to - from).length());
                    let aside = f32x8::splat(bow) + on * f32x8::splat(bent - 1.0);
                    let left = f32x8::new(margins[index].0) - far - aside;
                    stays = left.choose(stays, f32x8::ZERO);
                    from.store(&mut last[point]);
                    (to - from).store(&mut ahead[point]);
                    sum += on;
                    if let Some(segment) = point.checked_sub(1) {
                        let more = f32x8::new(gone[segment].0) + step.fast_max(stepped);
                        gone[segment] = Lanes(more.to_array());
                        let end = more + on.fast_max(goes) * f32x8::splat(bent);
                        reach[segment] = Lanes(end.to_array());
                    }
                    (stepped, goes) = (step, on);
                }
                let live = hair.model.live_lanes(block);
                let stays = stays.to_array()[..live].iter().all(|stays| *stays > 0.0);
                Motion { stays, ways: sum.to_array()[..live].iter().copied().map(f64::from).sum() }
            })
            .collect_into_vec(&mut motions);
        let all = Motion::of_all(&motions);
        self.motions = motions;
        all
    }

    fn fit(&mut self, places: usize, radii: &[Lanes]) {
        if self.built.len() != places {
            *self = Self {
                built: vec![Vec3Lanes::default(); places],
                last: vec![Vec3Lanes::default(); places],
                ahead: vec![Vec3Lanes::default(); places],
                // No point is within.
                margins: vec![Lanes([-1.0; LANES]); places],
                gone: vec![Lanes::default(); places],
                reach: vec![Lanes::default(); places],
                points: vec![Point::default(); places * LANES],
                ..Self::default()
            };
        }
        if self.radii != radii {
            self.radii = radii.to_vec();
            self.margins.fill(Lanes([-1.0; LANES]));
        }
    }

    /// Finds the candidates of hair where it is at the start of a part, to be kept.
    fn build(&mut self, hair: &Hair, bow: f32) {
        self.begin_margins(bow);
        let margins: &[f32] = cast_slice(&self.margins);
        self.wider.clear();
        // The last segment of a block has no margin of its own.
        self.wider.extend(
            (0..margins.len()).map(|end| margins[end].max(margins.get(end + LANES).copied().unwrap_or(0.0))),
        );
        self.find_met(hair, false);
    }

    /// Finds the candidates for a part alone.
    fn search(&mut self, hair: &Hair, bow: f32, bent: f32) {
        self.margins.fill(Lanes([-1.0; LANES]));
        let [gone, reach]: [&[f32]; 2] = [cast_slice(&self.gone), cast_slice(&self.reach)];
        self.wider.clear();
        self.wider.extend(gone.iter().zip(reach).map(|(gone, reach)| bow + (bent - 1.0) * (reach - gone)));
        self.find_met(hair, true);
    }

    /// Finds the segments that may come to touch, of those that are `wider`; if they are moving, on all of their way.
    fn find_met(&mut self, hair: &Hair, moving: bool) {
        let (mut around, mut met) = (std::mem::take(&mut self.around), std::mem::take(&mut self.met));
        self.find_boxes(hair, moving, &mut around);
        let sieve = Across {
            radii: &hair.model.radii,
            inverse_mass: &hair.model.inverse_mass,
            points: &self.points,
            wider: &self.wider,
            moving,
        };
        self.boxes.pairs(&around, &sieve, &mut self.eights, &mut met);
        self.candidates.clear();
        self.candidates
            .extend(met.iter().map(|met| Candidate { segments: met.segments, until: met.distance }));
        (self.around, self.met) = (around, met);
    }

    /// Margins of hair that goes on as it does, from where it is.
    fn begin_margins(&mut self, bow: f32) {
        let Self { built, last, ahead, margins, gone, reach, .. } = self;
        built.copy_from_slice(last);
        for (margin, ahead) in margins.iter_mut().zip(ahead) {
            let way = Vector::load(ahead).length();
            let lasts = way * f32x8::splat(LASTS);
            let kept = lasts.fast_min(way.fast_max(f32x8::splat(MOST_MARGIN)));
            *margin = Lanes((kept + f32x8::splat(LEAST_MARGIN + bow)).to_array());
        }
        for (gone, reach) in gone.iter_mut().zip(reach) {
            let ahead = f32x8::new(reach.0) - f32x8::new(gone.0);
            (*gone, *reach) = (Lanes::default(), Lanes(ahead.to_array()));
        }
    }

    /// Boxes about the segments of all strands in the frame of the head, and about their ways if they are moving, wider by
    /// what is near them and what segments are wider on each side.
    fn find_boxes(&self, hair: &Hair, moving: bool, around: &mut Vec<SegmentBox>) {
        let points = hair.model.points_per_strand;
        let segments = hair.model.strand_count.div_ceil(LANES) * LANES * (points - 1);
        let box_of = |index: usize| {
            let (row, lane) = (index / LANES, index % LANES);
            let (block, point) = (row / (points - 1), row % (points - 1));
            let segment = number(block, point, points, lane);
            let [a, b] = [0, 1].map(|end| {
                let index = block * points + point + end;
                let here = self.last[index].get(lane);
                let there = if moving { here + self.ahead[index].get(lane) } else { here };
                [here.min(there), here.max(there)]
            });
            let radius = hair.model.radii[segment as usize / LANES].0[lane];
            let more = if lane < hair.model.live_lanes(block) {
                Vec3::splat(NEAR * radius + self.wider[segment as usize])
            } else {
                Vec3::NAN
            };
            let (low, high) = (a[0].min(b[0]) - more, a[1].max(b[1]) + more);
            SegmentBox { low, high, segment, strand: (block * LANES + lane) as u32 }
        };
        (0..segments).into_par_iter().with_min_len(CHUNK).map(box_of).collect_into_vec(around);
    }
}

/// Length \[m\] of the longest segment.
fn longest(hair: &Hair) -> f32 {
    hair.lengths.stretch.iter().flat_map(|lanes| lanes.0).fold(0.0, f32::max)
}
