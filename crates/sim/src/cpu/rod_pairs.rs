//! Pairs of segments that touch or may come to touch in a part of a step.

use glam::Vec3;
use strandline_groom::LANES;

use super::rod_strands::Hair;
use crate::wisps::pair::{Near, Pair};
use crate::wisps::place::{Approach, Ends, NEAR, between, least_distance, look, nearest};

/// Stiffness with which a round holds a place over its mass and the square of the part.
const HELD: f32 = 1.0;
/// Share of a depth that a part takes back, and the speed \[m/s\] with which it does so at most.
const TAKEN_BACK: f32 = 0.3;
const FASTEST_BACK: f32 = 0.1;

/// Distance over that of touching up to which water or lacquer takes hold of two strands.
const WETS: f32 = 1.05;

/// Inverse mass of both places of a pair over the largest of their points, below which nothing moves them.
const MOVES: f32 = 1e-6;

/// A point in a part of a step.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
pub(super) struct Point {
    /// Place \[m\] where the part begins, and way at the earlier velocity \[m\].
    pub(super) start: Vec3,
    pub(super) coast: Vec3,
}

impl Point {
    /// Ends of two segments and their ways, of points by the numbers of their lanes.
    #[inline]
    pub(super) fn ends(points: &[Self], segments: [u32; 2]) -> (Ends, Ends) {
        let [one, other] = segments.map(|segment| segment as usize);
        let all = [&points[one], &points[one + LANES], &points[other], &points[other + LANES]];
        (all.map(|point| point.start), all.map(|point| point.coast))
    }
}

/// Hair in a part of a step, as its pairs are looked at.
pub(super) struct Look<'a> {
    hair: &'a Hair<'a>,
    points: &'a [Point],
    pairs: &'a [Pair],
    time_step: f32,
}

impl<'a> Look<'a> {
    /// Of points by the numbers of their lanes, and pairs of the part before.
    pub(super) fn new(hair: &'a Hair, points: &'a [Point], pairs: &'a [Pair]) -> Self {
        Self { hair, points, pairs, time_step: hair.parts.time_step as f32 }
    }

    /// Index of the first earlier pair that is not below two segments.
    pub(super) fn known_from(&self, segments: [u32; 2]) -> usize {
        self.pairs.partition_point(|pair| pair.segments < segments)
    }

    /// Way \[m\] of two segments towards each other before they are near, and the pair if they are, or may come to be in the
    /// part. `known` is the index from [`Look::known_from`] of these or of segments before; it rises.
    pub(super) fn at(&self, segments: [u32; 2], known: &mut usize) -> (f32, Option<Near>) {
        let places = segments.map(|segment| (segment as usize / LANES, segment as usize % LANES));
        let radius = |(index, lane): (usize, usize)| self.hair.model.radii[index].0[lane];
        let touch = radius(places[0]) + radius(places[1]);
        let (start, ways) = Point::ends(self.points, segments);
        let shares = nearest(&start);
        let distance = between(&start, shares).length();
        let away = least_distance(&start, distance) - NEAR * touch;
        while self.pairs.get(*known).is_some_and(|pair| pair.segments < segments) {
            *known += 1;
        }
        let pair = self.pairs.get(*known).filter(|pair| pair.segments == segments);
        let side = || pair.map(|pair| Vec3::from(pair.normal));
        let place = look(&start, &ways, touch, shares, side);
        let near = place.and_then(|place| self.near(segments, places, touch, &place, pair));
        (away, near)
    }

    fn near(
        &self,
        segments: [u32; 2],
        places: [(usize, usize); 2],
        touch: f32,
        place: &Approach,
        pair: Option<&Pair>,
    ) -> Option<Near> {
        let mut most = 0.0_f32;
        let mut inverse = |side: usize| {
            let (index, lane) = places[side];
            let [one, other] = [index, index + 1].map(|at| self.hair.masses.inverse_mass[at].0[lane]);
            let share = place.shares[side];
            most = most.max(one).max(other);
            one * (1.0 - share) * (1.0 - share) + other * share * share
        };
        let square = self.time_step * self.time_step;
        let inverse = [inverse(0), inverse(1)];
        // Nothing moves two places at points that are held.
        if inverse[0] + inverse[1] <= MOVES * most {
            return None;
        }
        let holds = inverse.map(|inverse| if inverse > 0.0 { HELD / (square * inverse) } else { 0.0 });
        let missing = touch - place.gap;
        let (force, slides) =
            pair.map_or((Vec3::ZERO, false), |pair| (turned(pair, place.normal), pair.slides > 0.0));
        let is_held = place.gap < WETS * touch || place.normal.dot(force) < 0.0;
        let pulls =
            if is_held { self.hair.model.settings.contact.pull * self.shorter(segments) } else { 0.0 };
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
            pulls,
            // Never closer than they touch, nor than where water took hold of them.
            held_at: pair.map_or(place.gap, |pair| pair.gap).max(touch),
            slid: slides,
            slides,
        })
    }
}

impl Look<'_> {
    /// Length \[m\] of the shorter of two segments.
    fn shorter(&self, segments: [u32; 2]) -> f32 {
        let ([a, b, c, d], _) = Point::ends(self.points, segments);
        a.distance(b).min(c.distance(d))
    }
}

/// Force of a pair that has turned to another normal: what pushes goes on to push, what pulls to pull.
fn turned(pair: &Pair, normal: Vec3) -> Vec3 {
    let (force, before) = (Vec3::from(pair.force), Vec3::from(pair.normal));
    let push = before.dot(force);
    let rubs = force - before * push;
    normal * push + (rubs - normal * normal.dot(rubs))
}

#[cfg(test)]
mod tests {
    use strandline_body::Random;
    use strandline_groom::Lanes;

    use super::super::rod_sieve::Across;
    use super::*;
    use crate::wisps::boxes::Sieve;

    #[test]
    fn segments_that_come_to_touch_are_not_left_out() {
        let mut random = Random::new(5, 0);
        let mut vector =
            |size: f32| Vec3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5) * size;
        let (mut found, mut left_out, mut nearer) = (0, 0, 0);
        for trial in 0..20_000 {
            let mut points = [Point::default(); 2 * LANES + 1];
            for (index, size) in [(0, 0.01), (LANES, 0.01), (1, 0.01), (LANES + 1, 0.01)] {
                points[index] = Point { start: vector(size), coast: vector(0.008) };
            }
            if trial % 2 == 1 {
                // Beside each other and nearly parallel.
                let along = points[LANES].start - points[0].start;
                points[1].start = points[0].start + vector(0.002);
                points[LANES + 1].start = points[1].start + along + vector(0.002);
            }
            let (start, ways) = Point::ends(&points, [0, 1]);
            let touch = 5e-4;
            let meets = |moving| {
                let sieve = Across {
                    radii: &[Lanes([0.5 * touch; LANES])],
                    inverse_mass: &[],
                    points: &points,
                    wider: &[0.0; 2],
                    moving,
                };
                sieve.may_meet(&sieve.one(&sieve.eight([0; LANES]), 0), &sieve.eight([1; LANES]), 1) != 0
            };
            let shares = nearest(&start);
            left_out += usize::from(!meets(true));
            if look(&start, &ways, touch, shares, || None).is_some() {
                found += 1;
                assert!(meets(true), "{start:?} {ways:?}");
            }
            let distance = between(&start, shares).length();
            assert!(meets(false) || distance > NEAR * touch, "{start:?}");
            // Places are drawn to the middle: the least distance may be less than that at them.
            let [a, b, c, d] = start;
            let shares = || (0..=10).map(|step| step as f32 / 10.0);
            let apart =
                shares().flat_map(|one| shares().map(move |two| a.lerp(b, one).distance(c.lerp(d, two))));
            let least = apart.fold(f32::MAX, f32::min);
            assert!(least_distance(&start, distance) <= least + 1e-7, "{start:?}");
            nearer += usize::from(least < distance - 1e-5);
        }
        assert!(found > 100 && left_out > 1000, "{found} touch, {left_out} are left out");
        // Found: 53.
        assert!(nearer > 20, "{nearer} are nearer than the place of their contact");
    }
}
