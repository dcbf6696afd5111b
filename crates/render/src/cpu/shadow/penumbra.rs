//! Soft edges of shadows on skin: the share of a light with an area that reaches a point.
//!
//! A map is the view of one place of a light, which stands for a part of it. Rays from the point to that part are
//! followed through the map: a ray lies beside the place's own one by a distance that grows with the distance before
//! the point. A texel of the body hides a ray where both lie equally far before the point; hair is crossed layer by
//! layer. The share changes as smoothly as the maps do, since no blocker is searched for.
//!
//! Four rays are followed together, each to the bit as alone, and steps at which nothing lies before any ray are left out.

use glam::{Vec2, Vec3, Vec4};
use wide::{f32x4, i32x4};

use crate::fast_math::exp;
use crate::shadow::{LightView, NOTHING, Nearest, ShadowMap, Window};

/// Steps of a ray.
pub(super) const STEPS: usize = 7;
/// Distance \[m\] of the first step before the point; each further one lies twice as far.
pub(super) const FIRST_GAP: f32 = 0.015;
/// Greatest share of the distance to the light at which a step lies.
pub(super) const FARTHEST: f32 = 0.8;
/// Share of the distance to the next step up to which hair belongs to a step: one over the square root of 2.
pub(super) const BETWEEN: f32 = 0.707_106_77;
/// Least side \[texel\] of the square that the rays of a place cross a map in.
pub(super) const LEAST_SIDE: f32 = 2.0;
/// Distance \[texel\] by which a point is lifted off the skin: beside it the skin of a slope is nearer to the light.
pub(super) const LIFT: f32 = 1.5;
/// Shares of a whole, many steps of which are spread evenly over it and over each other.
pub(super) const GOLDEN: f32 = 0.618_034;
pub(super) const PLASTIC: f32 = 0.754_877_7;
pub(super) const OTHER: f32 = 0.569_840_3;
/// Least and greatest multiple of the steps' distances.
const STRETCHES: [f32; 2] = [0.75, 1.5];
/// Rays that are followed together.
const LANES: usize = 4;

/// Middle of a part of a light, and its corners: rays to them tell whether more are needed. So few are followed at once.
const MIDDLE: [Vec2; LANES] = [Vec2::ZERO; LANES];
pub(super) const CORNERS: [Vec2; LANES] =
    [Vec2::new(-0.5, -0.5), Vec2::new(0.5, -0.5), Vec2::new(-0.5, 0.5), Vec2::new(0.5, 0.5)];

/// True for a share at which a few rays tell of all.
fn is_plain(share: f32) -> bool {
    share == 0.0 || share == 1.0
}

/// Rays to a part of a light, one in a lane.
#[derive(Clone, Copy)]
struct Rays {
    /// Their ends in a square of side 1 about 0.
    ends: [f32x4; 2],
    /// Their steps' distances as a multiple of those of other rays: those of all rays together lie evenly.
    stretch: f32x4,
}

impl Rays {
    /// Four rays, from a number on, of so many to a place, given as the place's number and the number of places.
    #[inline]
    fn new(first: usize, rays: usize, [place, count]: [usize; 2]) -> Self {
        let part = |number: f32x4| number - f32x4::from_i32x4(number.fast_trunc_int());
        let lanes: [usize; LANES] = std::array::from_fn(|lane| first + lane);
        let number = f32x4::from(lanes.map(|ray| ray as f32));
        let place_of = |share: f32| f32x4::splat(place as f32 * share);
        let half = f32x4::splat(0.5);
        let across = f32x4::from(lanes.map(|ray| (ray * count + place) as f32)) + half;
        let along = part(number * f32x4::splat(GOLDEN) + place_of(PLASTIC));
        let stretched = part(number * f32x4::splat(OTHER) + place_of(GOLDEN));
        Self {
            ends: [across / f32x4::splat((rays * count) as f32) - half, along - half],
            stretch: f32x4::splat(STRETCHES[0]) + f32x4::splat(STRETCHES[1] - STRETCHES[0]) * stretched,
        }
    }

    /// Rays to ends in the square.
    #[inline]
    fn to(ends: [Vec2; LANES]) -> Self {
        let along = |axis: usize| f32x4::from(ends.map(|end| end[axis]));
        Self { ends: [along(0), along(1)], stretch: f32x4::ONE }
    }

    /// Distances \[m\] of a step before the point.
    #[inline]
    fn gaps(&self, step: usize) -> f32x4 {
        f32x4::splat(gap(step)) * self.stretch
    }

    /// Distances \[m\] before the point between which hair is crossed at a step.
    #[inline]
    fn slices(&self, step: usize) -> [f32x4; 2] {
        let between = f32x4::splat(BETWEEN);
        [if step == 0 { f32x4::ZERO } else { between * self.gaps(step) }, between * self.gaps(step + 1)]
    }
}

/// Distance \[m\] of a step before the point, of a ray that is not stretched.
#[inline]
fn gap(step: usize) -> f32 {
    FIRST_GAP * (1_u32 << step) as f32
}

/// The rays of a place where they cross a map.
struct Way {
    /// Texel coordinates of the point.
    middle: Vec2,
    /// Depth \[m\] of the point.
    depth: f32,
    /// Sides \[texel\] of the part of the light, seen at a metre per metre on it.
    sides: [Vec2; 2],
    /// Least displacement of a ray per metre on the light.
    least: f32,
    /// Steps at which some ray may meet something, a bit each.
    steps: u32,
}

impl Way {
    /// Way through a window of a map from a point on the light's plane with its depth \[m\].
    fn new(view: &LightView, window: &Window, seen: Vec3) -> Self {
        let side = view.part[0].length().min(view.part[1].length());
        Self {
            middle: window.texel(seen.truncate()),
            depth: seen.z,
            sides: view.part.map(|side| side * window.density),
            least: LEAST_SIDE / (side * window.density).max(1e-12),
            steps: 0,
        }
    }

    /// Finds the steps at which some ray may meet what lies at the least depth about all of them. `meets` tells it of a step and
    /// a depth; what it is false for it is false for at all further steps.
    fn among(mut self, nearest: &Nearest, meets: impl Fn(usize, f32) -> bool) -> Self {
        let half = 0.5 * (self.sides[0].abs() + self.sides[1].abs());
        for step in (0..STEPS).take_while(|step| meets(*step, nearest.least())) {
            let gap = (gap(step) * STRETCHES[1]).min(FARTHEST * self.depth);
            let [aside, ..] = aside(self.depth, f32x4::splat(gap)).to_array();
            // A texel more than the texels about a ray's place, for what rounding moves it.
            let reach = half * aside.max(self.least) + 1.0;
            let least = nearest.within(self.middle - 0.5 - reach, self.middle - 0.5 + reach);
            self.steps |= u32::from(meets(step, least)) << step;
        }
        self
    }

    /// Those steps.
    #[inline]
    fn steps(&self) -> impl Iterator<Item = usize> + use<> {
        let steps = self.steps;
        (0..STEPS).filter(move |step| steps >> step & 1 == 1)
    }

    /// Texel coordinates of rays at a step.
    #[inline]
    fn at(&self, rays: &Rays, step: usize) -> [f32x4; 2] {
        let gap = rays.gaps(step).fast_min(f32x4::splat(FARTHEST * self.depth));
        let aside = aside(self.depth, gap).fast_max(f32x4::splat(self.least));
        let along = |axis: usize| {
            let [first, second] = self.sides.map(|side| f32x4::splat(side[axis]));
            f32x4::splat(self.middle[axis]) + (first * rays.ends[0] + second * rays.ends[1]) * aside
        };
        [along(0), along(1)]
    }
}

/// Displacements \[plane\] of rays per metre on the light, by the depth \[m\] of the point and distances \[m\] before it.
#[inline]
fn aside(depth: f32, gap: f32x4) -> f32x4 {
    let depth = f32x4::splat(depth);
    gap / (depth * (depth - gap).fast_max(f32x4::splat(1e-3)))
}

/// Places in a map, one in a lane.
struct Crossing {
    /// True, as a mask, for places that have four texels about them.
    within: f32x4,
    /// Columns and rows of the first of the four texels.
    first: [i32x4; 2],
    /// Ways from its middle \[texel\].
    part: [f32x4; 2],
}

impl Crossing {
    /// Column and row of a lane.
    #[inline]
    fn first(&self, lane: usize) -> [usize; 2] {
        self.first.map(|numbers| numbers.to_array()[lane] as u32 as usize)
    }

    /// Weights of the four texels.
    #[inline]
    fn weights(&self) -> [f32x4; 4] {
        let ([x, y], one) = (self.part, f32x4::ONE);
        [(one - x) * (one - y), x * (one - y), (one - x) * y, x * y]
    }

    /// Least depths \[m\] about the places, [`NOTHING`] beside the map.
    #[inline]
    fn nearest(&self, nearest: &Nearest) -> f32x4 {
        let within = self.within.to_bitmask();
        f32x4::from(std::array::from_fn(|lane| {
            if within >> lane & 1 == 1 { nearest.about(self.first(lane)) } else { NOTHING }
        }))
    }
}

impl ShadowMap {
    /// Share of a light's place that hair and body let through to a point \[m\] of skin with a unit normal, world space.
    /// `places` are the place's number and the number of places.
    pub(crate) fn on_skin(&self, point: Vec3, normal: Vec3, places: [usize; 2]) -> f32 {
        let rays = self.settings.rays_of(places[1]);
        self.along(point, normal, |shares| {
            if rays > 1 + CORNERS.len() {
                let [first, ..] = shares(&Rays::to(MIDDLE));
                if is_plain(first) && shares(&Rays::to(CORNERS)) == [first; LANES] {
                    return first;
                }
            }
            let mut sum = 0.0;
            for first in (0..rays).step_by(LANES) {
                let shares = shares(&Rays::new(first, rays, places));
                shares[..LANES.min(rays - first)].iter().for_each(|share| sum += share);
            }
            sum / rays as f32
        })
    }

    /// True if pixels can follow one each of so many parts of the rays to each of so many places of a light.
    pub(crate) fn parts_rays(&self, places: usize, parts: usize) -> bool {
        self.view.part != [Vec2::ZERO; 2] && self.settings.rays_of(places).is_multiple_of(parts * LANES)
    }

    /// As [`ShadowMap::on_skin`], by one of so many parts of the rays, which can be parted so: the mean of all parts is that
    /// of all rays.
    pub(crate) fn part_on_skin(
        &self,
        point: Vec3,
        normal: Vec3,
        places: [usize; 2],
        [part, parts]: [usize; 2],
    ) -> f32 {
        debug_assert!(self.parts_rays(places[1], parts), "rays that cannot be parted");
        let rays = self.settings.rays_of(places[1]);
        let count = rays / parts;
        self.along(point, normal, |shares| {
            let group = |number: usize| Rays::new((parts * number + part) * LANES, rays, places);
            let first = shares(&group(0));
            let plain = count > LANES && is_plain(first[0]) && first == [first[0]; LANES];
            if plain && shares(&Rays::to(CORNERS)) == first {
                return first[0];
            }
            let others = (1..count / LANES).flat_map(|number| shares(&group(number)));
            first.into_iter().chain(others).sum::<f32>() / count as f32
        })
    }

    /// Share that `of` finds from those that reach a point of skin along the rays that it asks for; 1 where nothing can
    /// lie before any of them.
    #[inline]
    fn along(
        &self,
        point: Vec3,
        normal: Vec3,
        of: impl FnOnce(&dyn Fn(&Rays) -> [f32; LANES]) -> f32,
    ) -> f32 {
        if self.view.part == [Vec2::ZERO; 2] {
            return self.transmittance(point);
        }
        let Some(seen) = self.view.project(point) else { return 1.0 };
        let (body, hair) = (self.body_way(point, normal, seen), self.hair_way(seen));
        if body.steps | hair.steps == 0 {
            return 1.0;
        }
        of(&|rays| {
            let open = self.past_body(&body, rays);
            let hair = self.past_hair(&hair, rays, open.simd_gt(f32x4::ZERO).to_bitmask());
            (open * hair).to_array()
        })
    }

    /// The way of rays past the body, from off the skin.
    fn body_way(&self, point: Vec3, normal: Vec3, seen: Vec3) -> Way {
        let texel = 1.0 / (self.view.scale(seen.z) * self.body_window.density).max(1e-12);
        let lifted = self.view.project(point + normal * (LIFT * texel).min(self.body_bias));
        let way = Way::new(&self.view, &self.body_window, lifted.unwrap_or(seen));
        if self.body_depths.is_empty() {
            return way;
        }
        let depth = way.depth;
        way.among(&self.nearest_body, |step, least| {
            // Depths nearer to the point than the step before do not count: see `past_body`.
            let nearer = if step == 0 { 0.0 } else { 0.999 * STRETCHES[0] * gap(step - 1) };
            depth - least > self.body_bias.max(nearer)
        })
    }

    /// The way of rays through hair.
    fn hair_way(&self, seen: Vec3) -> Way {
        let way = Way::new(&self.view, &self.hair_window, seen);
        way.among(&self.nearest_hair, |step, least| {
            let near = if step == 0 { 0.0 } else { 0.999 * BETWEEN * STRETCHES[0] * gap(step) };
            least < seen.z - near
        })
    }

    /// Places where rays cross the map at a step.
    #[inline]
    fn cross(&self, way: &Way, rays: &Rays, step: usize) -> Crossing {
        let limit = f32x4::splat(self.size as f32 - 1.0);
        let at = way.at(rays, step).map(|texel| texel - f32x4::splat(0.5));
        let [x, y] = at.map(|at| at.simd_ge(f32x4::ZERO) & at.simd_lt(limit));
        let first = at.map(f32x4::fast_trunc_int);
        let part = [0, 1].map(|axis| at[axis] - f32x4::from_i32x4(first[axis]));
        Crossing { within: x & y, first, part }
    }

    /// Shares of rays that the body lets through.
    #[inline]
    fn past_body(&self, way: &Way, rays: &Rays) -> f32x4 {
        let [bias, softness, depth, zero, one] =
            [self.body_bias, self.inverse_softness, way.depth, 0.0, 1.0].map(f32x4::splat);
        let share = |reached: f32x4| reached.fast_max(zero).fast_min(one);
        // One over the distances before the point of the steps at both sides: it counts for the two that it lies between.
        let inverse = one / rays.gaps(0);
        let mut hidden = zero;
        for step in way.steps() {
            let after = inverse * f32x4::splat(1.0 / (1_u32 << step) as f32);
            let before = after + after;
            let crossing = self.cross(way, rays, step);
            let gap = depth - crossing.nearest(&self.nearest_body);
            let reached = if step == 0 { gap.simd_gt(bias) } else { (gap * before).simd_gt(one) };
            let meets = (reached & gap.simd_gt(bias)).to_bitmask();
            if meets == 0 {
                continue;
            }
            let found = f32x4::transpose(std::array::from_fn(|lane| {
                let texels = || self.quad_at(crossing.first(lane)).map(|texel| self.body_depths[texel]);
                f32x4::from(if meets >> lane & 1 == 1 { texels() } else { [NOTHING; 4] })
            }));
            let [a, b, c, d] = [0, 1, 2, 3].map(|corner| {
                let gap = depth - found[corner];
                let reached = if step == 0 { (gap - bias) * softness } else { gap * before - one };
                let passed = if step + 1 < STEPS { gap * after - one } else { zero };
                let hides = (share(reached) - share(passed)).fast_max(zero);
                gap.simd_gt(bias) & (hides * crossing.weights()[corner])
            });
            hidden += a + b + c + d;
            if !hidden.simd_lt(one).any() {
                break;
            }
        }
        one - hidden.fast_min(one)
    }

    /// Shares of rays that the hair lets through; 1 for rays without a bit in `open`.
    #[inline]
    fn past_hair(&self, way: &Way, rays: &Rays, open: u32) -> f32x4 {
        let depth = f32x4::splat(way.depth);
        let mut crossed = [0.0; LANES];
        for step in way.steps().take_while(|_| open > 0) {
            let crossing = self.cross(way, rays, step);
            let [near, far] = rays.slices(step).map(|slice| depth - slice);
            let meets = open & crossing.nearest(&self.nearest_hair).simd_lt(near).to_bitmask();
            if meets == 0 {
                continue;
            }
            let weights = f32x4::transpose(crossing.weights());
            let [near, far] = [near, far].map(f32x4::to_array);
            for (lane, crossed) in crossed.iter_mut().enumerate().filter(|(lane, _)| meets >> lane & 1 == 1) {
                let texels = self.quad_at(crossing.first(lane)).map(|texel| self.texels[texel]);
                let far = (step + 1 < STEPS).then_some(far[lane]);
                let between = self.crossed_between(texels, near[lane], far) * weights[lane];
                between.to_array().iter().for_each(|hairs| *crossed += hairs);
            }
        }
        let passed = |crossed: f32| if crossed > 0.0 { exp(crossed * self.log_transmission()) } else { 1.0 };
        f32x4::from(crossed.map(passed))
    }

    /// Hairs of four texels before a depth \[m\], less those before a second one.
    #[inline]
    fn crossed_between(&self, texels: [Vec4; 4], near: f32, far: Option<f32>) -> f32x4 {
        let [r, g, b, w] = f32x4::transpose(texels.map(|texel| f32x4::from(texel.to_array())));
        let before = |depth: f32| {
            let behind = f32x4::splat(depth) - w;
            let layer = |hairs: f32x4, at: usize| {
                let [start, inverse] = self.layer_begin(at).map(f32x4::splat);
                ((behind - start) * inverse).fast_max(f32x4::ZERO).fast_min(f32x4::ONE) * hairs
            };
            layer(r, 0) + layer(g, 1) + layer(b, 2)
        };
        before(near) - far.map_or(f32x4::ZERO, before)
    }
}
