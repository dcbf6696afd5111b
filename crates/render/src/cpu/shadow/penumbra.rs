//! Soft edges of shadows on skin: the share of a light with an area that reaches a point.
//!
//! A map is the view of one place of a light, which stands for a part of it. Rays from the point to that part are
//! followed through the map: a ray lies beside the place's own one by a distance that grows with the distance before
//! the point. A texel of the body hides a ray where both lie equally far before the point; hair is crossed layer by
//! layer. The share changes as smoothly as the maps do, since no blocker is searched for.

use glam::{Vec2, Vec3};
use wide::f32x4;

use crate::fast_math::exp;
use crate::shadow::{LightView, ShadowMap, Window};

/// Steps of a ray.
const STEPS: usize = 7;
/// Distance \[m\] of the first step before the point; each further one lies twice as far.
const FIRST_GAP: f32 = 0.015;
/// Greatest share of the distance to the light at which a step lies.
const FARTHEST: f32 = 0.8;
/// Share of the distance to the next step up to which hair belongs to a step: one over the square root of 2.
const BETWEEN: f32 = 0.707_106_77;
/// Least side \[texel\] of the square that the rays of a place cross a map in.
const LEAST_SIDE: f32 = 2.0;
/// Distance \[texel\] by which a point is lifted off the skin: beside it the skin of a slope is nearer to the light.
const LIFT: f32 = 1.5;
/// Shares of a whole, many steps of which are spread evenly over it and over each other.
const GOLDEN: f32 = 0.618_034;
const PLASTIC: f32 = 0.754_877_7;
const OTHER: f32 = 0.569_840_3;

/// Middle and corners of a part of a light: rays to them tell whether more are needed. So few are followed at once.
const CORNERS: [Vec2; 5] =
    [Vec2::ZERO, Vec2::new(-0.5, -0.5), Vec2::new(0.5, -0.5), Vec2::new(-0.5, 0.5), Vec2::new(0.5, 0.5)];

/// A ray to a part of a light.
#[derive(Clone, Copy)]
struct Ray {
    /// Its end in a square of side 1 about 0.
    end: Vec2,
    /// Its steps' distances as a multiple of those of other rays: those of all rays together lie evenly.
    stretch: f32,
}

impl Ray {
    /// A ray of so many to a place, given as the place's number and the number of places.
    #[inline]
    fn new(ray: usize, rays: usize, [place, count]: [usize; 2]) -> Self {
        let part = |number: f32| number - number.floor();
        let across = ((ray * count + place) as f32 + 0.5) / (rays * count) as f32;
        let along = part(ray as f32 * GOLDEN + place as f32 * PLASTIC);
        let stretch = 0.75 + 0.75 * part(ray as f32 * OTHER + place as f32 * GOLDEN);
        Self { end: Vec2::new(across, along) - 0.5, stretch }
    }

    /// Distance \[m\] of a step before the point.
    #[inline]
    fn gap(&self, step: usize) -> f32 {
        FIRST_GAP * (1_u32 << step) as f32 * self.stretch
    }

    /// Distances \[m\] before the point between which hair is crossed at a step.
    #[inline]
    fn slice(&self, step: usize) -> [f32; 2] {
        [if step == 0 { 0.0 } else { BETWEEN * self.gap(step) }, BETWEEN * self.gap(step + 1)]
    }
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
        }
    }

    /// Texel coordinates of a ray at a step.
    #[inline]
    fn at(&self, ray: &Ray, step: usize) -> Vec2 {
        let gap = ray.gap(step).min(FARTHEST * self.depth);
        let aside = LightView::aside(self.depth, gap).max(self.least);
        self.middle + (self.sides[0] * ray.end.x + self.sides[1] * ray.end.y) * aside
    }
}

impl LightView {
    /// Displacement \[plane\] of a ray per metre on the light, by the depth \[m\] of the point and the distance \[m\]
    /// before it.
    #[inline]
    fn aside(depth: f32, gap: f32) -> f32 {
        gap / (depth * (depth - gap).max(1e-3))
    }
}

impl ShadowMap {
    /// Share of a light's place that hair and body let through to a point \[m\] of skin with a unit normal, world space.
    /// `places` are the place's number and the number of places.
    pub(crate) fn on_skin(&self, point: Vec3, normal: Vec3, places: [usize; 2]) -> f32 {
        if self.view.part == [Vec2::ZERO; 2] {
            return self.transmittance(point);
        }
        let Some(seen) = self.view.project(point) else { return 1.0 };
        let texel = 1.0 / (self.view.scale(seen.z) * self.body_window.density).max(1e-12);
        let lifted = self.view.project(point + normal * (LIFT * texel).min(self.body_bias));
        let body = Way::new(&self.view, &self.body_window, lifted.unwrap_or(seen));
        let hair = Way::new(&self.view, &self.hair_window, seen);
        let share = |ray: Ray| {
            let open = if self.body_depths.is_empty() { 1.0 } else { self.past_body(&body, ray) };
            if open > 0.0 { open * self.past_hair(&hair, ray) } else { 0.0 }
        };
        let rays = self.settings.rays_of(places[1]);
        if rays > CORNERS.len() {
            let corner = |end: Vec2| share(Ray { end, stretch: 1.0 });
            let first = corner(CORNERS[0]);
            let plain = first == 0.0 || first == 1.0;
            if plain && CORNERS[1..].iter().all(|&end| corner(end) == first) {
                return first;
            }
        }
        (0..rays).map(|ray| share(Ray::new(ray, rays, places))).sum::<f32>() / rays as f32
    }

    /// Share of a ray that the body lets through.
    #[inline]
    fn past_body(&self, way: &Way, ray: Ray) -> f32 {
        let [bias, one] = [self.body_bias, 1.0].map(f32x4::splat);
        let share = |reached: f32x4| reached.max(f32x4::ZERO).min(one);
        // One over the distances before the point of the steps at both sides: it counts for the two that it lies between.
        let mut inverse = 1.0 / ray.gap(0);
        let mut hidden = 0.0;
        for step in 0..STEPS {
            let (before, after) = (2.0 * inverse, inverse);
            inverse *= 0.5;
            let Some((first, weights)) = self.place(way.at(&ray, step)) else { continue };
            if way.depth - self.nearest_body.about(first) <= self.body_bias {
                continue;
            }
            let depths = self.quad_at(first).map(|texel| self.body_depths[texel]);
            let gap = f32x4::splat(way.depth) - f32x4::from(depths);
            let reached = match step {
                0 => (gap - bias) * f32x4::splat(self.inverse_softness),
                _ => gap * f32x4::splat(before) - one,
            };
            let passed = if step + 1 < STEPS { gap * f32x4::splat(after) - one } else { f32x4::ZERO };
            let hides = (share(reached) - share(passed)).max(f32x4::ZERO);
            hidden += (gap.simd_gt(bias) & (hides * f32x4::from(weights))).reduce_add();
        }
        1.0 - hidden.min(1.0)
    }

    /// Share of a ray that the hair lets through.
    #[inline]
    fn past_hair(&self, way: &Way, ray: Ray) -> f32 {
        let mut crossed = 0.0;
        for step in 0..STEPS {
            let Some((first, weights)) = self.place(way.at(&ray, step)) else { continue };
            let [near, far] = ray.slice(step);
            if self.nearest_hair.about(first) >= way.depth - near {
                continue;
            }
            for (texel, weight) in self.quad_at(first).into_iter().zip(weights) {
                if self.texels[texel].w < way.depth - near {
                    let behind = step + 1 < STEPS;
                    let before = if behind { self.crossed_in(texel, way.depth - far) } else { 0.0 };
                    crossed += weight * (self.crossed_in(texel, way.depth - near) - before);
                }
            }
        }
        if crossed > 0.0 { exp(crossed * self.log_transmission()) } else { 1.0 }
    }
}
