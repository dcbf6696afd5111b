//! Pairs of segments that touch or may come to touch in a part of a step.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Vec3Lanes};

use super::rod_strands::Hair;
use crate::wisps::boxes::{Around, Boxes};
use crate::wisps::pair::{Near, Pair};
use crate::wisps::place::{Ends, look};
use crate::wisps::radii::number;

/// Way of hair against the head in a part over which a list of candidates is kept for some of them, and the least and the
/// greatest such way \[m\].
const KEPT_PARTS: f32 = 3.0;
const LEAST_MARGIN: f32 = 1e-3;
const MOST_MARGIN: f32 = 6e-3;
/// Radius over a wisp's own within which pairs are candidates: a little more than `look` asks for.
const WIDER: f32 = 1.4;
/// Stiffness with which a round holds a place over its mass and the square of the part.
const HELD: f32 = 1.0;
/// Share of a depth that a part takes back, and the speed \[m/s\] with which it does so at most.
const TAKEN_BACK: f32 = 0.3;
const FASTEST_BACK: f32 = 0.1;
/// Candidates that a thread takes at a time.
const CHUNK: usize = 512;

/// Candidates, kept while no point moves far against the head.
#[derive(Clone, Default)]
pub(super) struct Neighbours {
    boxes: Boxes,
    around: Vec<Around>,
    candidates: Vec<[u32; 2]>,
    /// Places \[m\] when they were found, in the frame of the head, and the way that a point may move from there.
    built: Vec<Vec3Lanes>,
    margin: f32,
}

impl Neighbours {
    /// Replaces `near` by the pairs that touch, or may come to touch in a part whose strands lie at `start` and go on by
    /// `coast` \[m\]; `pairs` are those of the part before.
    pub(super) fn find(
        &mut self,
        hair: &Hair,
        (start, coast): (&[Vec3Lanes], &[Vec3Lanes]),
        part: u32,
        pairs: &[Pair],
        near: &mut Vec<Near>,
    ) {
        self.refresh(hair, (start, coast), part);
        let look = Look { hair, start, coast, pairs, time_step: hair.parts.time_step as f32 };
        let found: Vec<Vec<Near>> = self
            .candidates
            .par_chunks(CHUNK)
            .map(|candidates| candidates.iter().filter_map(|pair| look.at(*pair)).collect())
            .collect();
        near.clear();
        found.iter().for_each(|found| near.extend_from_slice(found));
    }

    /// Finds the candidates again where hair has moved too far.
    fn refresh(&mut self, hair: &Hair, (start, coast): (&[Vec3Lanes], &[Vec3Lanes]), part: u32) {
        let [before, after] = hair.parts.head_through(part).map(|pose| pose.inverse());
        let points = hair.model.points_per_strand;
        let local = |index: usize, lane: usize| {
            let here = start[index].get(lane);
            [before.point(here), after.point(here + coast[index].get(lane))]
        };
        let moved = |way: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            let of_block = |block: usize| {
                let live = hair.model.live_lanes(block);
                let indices = block * points..(block + 1) * points;
                indices
                    .flat_map(|index| (0..live).map(move |lane| (index, lane)))
                    .fold(0.0_f32, |most, (index, lane)| most.max(way(index, lane)))
            };
            (0..start.len() / points).into_par_iter().map(of_block).reduce(|| 0.0, f32::max)
        };
        if self.built.len() == start.len() {
            let built = &self.built;
            let far = moved(&|index, lane| {
                let [from, to] = local(index, lane);
                let built = built[index].get(lane);
                from.distance(built).max(to.distance(built))
            });
            if far <= self.margin {
                return;
            }
        }
        let fastest = moved(&|index, lane| {
            let [from, to] = local(index, lane);
            from.distance(to)
        });
        self.margin = (KEPT_PARTS * fastest).clamp(LEAST_MARGIN, MOST_MARGIN);
        self.build(hair, &local);
    }

    fn build(&mut self, hair: &Hair, local: &dyn Fn(usize, usize) -> [Vec3; 2]) {
        let Self { boxes, around, candidates, built, margin } = self;
        let (points, model) = (hair.model.points_per_strand, hair.model);
        built.resize(model.positions.len(), Vec3Lanes::default());
        around.clear();
        for block in 0..built.len() / points {
            let live = model.live_lanes(block);
            for point in 0..points {
                let index = block * points + point;
                for lane in 0..live {
                    let [from, to] = local(index, lane);
                    built[index].set(lane, to);
                    let (low, high) = (from.min(to), from.max(to));
                    if point > 0
                        && let Some(before) = around.len().checked_sub(live)
                    {
                        let before = &mut around[before];
                        // The box of the segment that ends here.
                        (before.low, before.high) = (before.low.min(low), before.high.max(high));
                    }
                    if point + 1 < points {
                        let segment = number(block, point, points, lane);
                        let strand = (block * LANES + lane) as u32;
                        around.push(Around { low, high, segment, strand });
                    }
                }
            }
        }
        for one in around.iter_mut() {
            let radius = model.radii[one.segment as usize / LANES].0[one.segment as usize % LANES];
            let wider = Vec3::splat(WIDER * radius + *margin);
            (one.low, one.high) = (one.low - wider, one.high + wider);
        }
        around.retain(|one| one.low.is_finite() && one.high.is_finite());
        boxes.pairs(around, candidates);
        let rigid = |segment: u32| {
            let (index, lane) = (segment as usize / LANES, segment as usize % LANES);
            [index, index + 1].iter().all(|at| model.inverse_mass[*at].0[lane] == 0.0)
        };
        candidates.retain(|[one, other]| !(rigid(*one) && rigid(*other)));
    }
}

/// Hair in a part of a step, as its pairs are looked at.
struct Look<'a> {
    hair: &'a Hair<'a>,
    start: &'a [Vec3Lanes],
    coast: &'a [Vec3Lanes],
    pairs: &'a [Pair],
    time_step: f32,
}

impl Look<'_> {
    fn at(&self, segments: [u32; 2]) -> Option<Near> {
        let places = segments.map(|segment| (segment as usize / LANES, segment as usize % LANES));
        let ends = |vectors: &[Vec3Lanes]| -> Ends {
            let [(one, lane), (other, beside)] = places;
            [
                vectors[one].get(lane),
                vectors[one + 1].get(lane),
                vectors[other].get(beside),
                vectors[other + 1].get(beside),
            ]
        };
        let radius = |(index, lane): (usize, usize)| self.hair.model.radii[index].0[lane];
        let touch = radius(places[0]) + radius(places[1]);
        let known = || {
            let found = self.pairs.binary_search_by_key(&segments, |pair| pair.segments);
            found.ok().map(|found| &self.pairs[found])
        };
        let (start, ways) = (ends(self.start), ends(self.coast));
        let place = look(&start, &ways, touch, || known().map(|pair| Vec3::from(pair.normal)))?;
        let inverse = |side: usize| {
            let (index, lane) = places[side];
            let [one, other] = [index, index + 1].map(|at| self.hair.masses.inverse_mass[at].0[lane]);
            let share = place.shares[side];
            one * (1.0 - share) * (1.0 - share) + other * share * share
        };
        let square = self.time_step * self.time_step;
        let inverse = [inverse(0), inverse(1)];
        let holds = inverse.map(|inverse| if inverse > 0.0 { HELD / (square * inverse) } else { 0.0 });
        let missing = touch - place.gap;
        let (force, slides) =
            known().map_or((Vec3::ZERO, false), |pair| (turned(pair, place.normal), pair.slides > 0.0));
        Some(Near {
            segments,
            shares: place.shares,
            normal: place.normal,
            touch,
            gap: place.gap,
            needs: missing.min((TAKEN_BACK * missing).max(0.0)).min(FASTEST_BACK * self.time_step),
            holds,
            stiffness: HELD / (square * (inverse[0] + inverse[1])),
            force,
            given: force,
            change: Vec3::ZERO,
            slid: slides,
            slides,
        })
    }
}

/// Force of a pair that has turned to another normal: what pushes goes on to push.
fn turned(pair: &Pair, normal: Vec3) -> Vec3 {
    let (force, before) = (Vec3::from(pair.force), Vec3::from(pair.normal));
    let push = before.dot(force).max(0.0);
    let rubs = force - before * push;
    normal * push + (rubs - normal * normal.dot(rubs))
}
