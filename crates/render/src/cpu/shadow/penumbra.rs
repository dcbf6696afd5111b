//! Soft edges of shadows on skin: what hides a part of a light with an area from a point.
//!
//! A map is what one place of a light sees; that place stands for a part of the light. Where the map is looked at aside
//! tells which of the part's rays hair or body hides [Fernando2005]: a blocker at depth d hides from a point at depth z
//! what it hides beside the place by (z - d) / (z d) of the distance on the light.

use std::ops::Range;

use glam::{Vec2, Vec3};

use crate::fast_math::exp;
use crate::shadow::{LightView, ShadowMap, Shadows};

/// Looks for what hides a light, shared out among its places.
const LOOKS: usize = 40;
/// Rays of the light that are tried past what hides it, shared out in the same way.
const RAYS: usize = 34;
/// A place has every so many-th look and ray at least: one alone has no more than each of two.
const LEAST_STEP: usize = 2;
/// Every so many of them are tried past hair, whose edges are ragged.
const HAIR_STEP: usize = 2;
/// Distance \[m\] before skin as far as blockers are looked for all about; farther ones are found where their shadow is
/// deep.
const MOST_GAP: f32 = 0.4;
/// Share of the mean distance of blockers below which a blocker is the skin itself.
const OWN_SKIN: f32 = 0.3;
/// Distance \[m\] at which hair is taken to be that lies closer before skin than looks find it: its shadow is as wide as
/// the least side.
const TOUCH: f32 = 1e-6;
/// Least side \[texel\] of what is looked at.
const LEAST_SIDE: f32 = 2.0;
/// A share of a whole that many steps of are spread evenly over it.
const GOLDEN: f32 = 0.618_034;

/// Places in a square of side 1 about 0: seen from every side their shadows lie evenly.
const PLACES: [Vec2; RAYS] = {
    let mut places = [Vec2::ZERO; RAYS];
    let mut index = 0;
    while index < RAYS {
        places[index] =
            Vec2::new((index as f32 + 0.5) / RAYS as f32 - 0.5, part(index as f32 * GOLDEN) - 0.5);
        index += 1;
    }
    places
};

/// Places that lie denser toward the middle of the square, where near blockers are: on the outlines of smaller squares,
/// whose sides come third.
const AROUND: [Vec3; LOOKS] = {
    let mut looks = [Vec3::ZERO; LOOKS];
    let mut index = 0;
    while index < LOOKS {
        let around = 4.0 * part(index as f32 * GOLDEN);
        let (along, reach) = (part(around) - 0.5, (index as f32 + 0.5) / LOOKS as f32);
        let side = if around < 2.0 { reach } else { -reach };
        looks[index] = if (around as u32).is_multiple_of(2) {
            Vec3::new(along * side, 0.5 * side, reach)
        } else {
            Vec3::new(0.5 * side, along * side, reach)
        };
        index += 1;
    }
    looks
};

/// Part of the light behind the point.
const fn part(number: f32) -> f32 {
    number - (number as u32) as f32
}

/// Mean distances \[m\] before a point of the body and of the hair that hide a light from it; 0 where none does.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Blockers {
    body: f32,
    hair: f32,
}

impl Shadows {
    /// Blockers of a light with these places, seen from a point \[m\], world space.
    pub(crate) fn blockers(&self, places: Range<usize>, point: Vec3) -> Blockers {
        let (mut body, mut hair) = (Gaps::default(), Gaps::default());
        for (place, map) in places.clone().enumerate().filter_map(|(at, index)| Some((at, self.map(index)?)))
        {
            if map.view.part == [Vec2::ZERO; 2] {
                continue;
            }
            let Some(seen) = map.view.project(point) else { continue };
            let looks = || AROUND.iter().skip(place).step_by(places.len().max(LEAST_STEP));
            if !map.body_depths.is_empty() {
                let near = Vec3 { z: seen.z - map.body_bias, ..seen };
                body.add(&map.view, near, looks(), |at| {
                    Some(map.body_depths[map.nearest(map.body_window.texel(at))?])
                });
            }
            hair.add(&map.view, seen, looks(), |at| {
                Some(map.texels[map.nearest(map.hair_window.texel(at))?].w)
            });
        }
        Blockers { body: body.mean(), hair: hair.mean_or_touch() }
    }
}

/// Distances before a point.
#[derive(Default)]
struct Gaps {
    sum: f32,
    count: f32,
    /// True if a blocker was seen before it, though it hides none of the tested rays.
    touched: bool,
}

impl Gaps {
    /// Adds those of what hides rays, of depths that are looked up.
    #[inline]
    fn add<'a>(
        &mut self,
        view: &LightView,
        seen: Vec3,
        looks: impl Iterator<Item = &'a Vec3>,
        depth_at: impl Fn(Vec2) -> Option<f32>,
    ) {
        let most = LightView::aside(seen.z, MOST_GAP.min(0.5 * seen.z));
        let sides = view.part.map(|side| side * most);
        for look in looks {
            let at = seen.truncate() + sides[0] * look.x + sides[1] * look.y;
            let Some(depth) = depth_at(at) else { continue };
            let gap = seen.z - depth;
            self.touched |= gap > 0.0;
            // A blocker that hides none of this part's rays does not count.
            if gap > 0.0 && LightView::aside(seen.z, gap) >= look.z * most {
                self.sum += gap;
                self.count += 1.0;
            }
        }
    }

    fn mean(&self) -> f32 {
        self.sum / self.count.max(1.0)
    }

    /// [`Gaps::mean`], or next to nothing of what only touches.
    fn mean_or_touch(&self) -> f32 {
        if self.count == 0.0 && self.touched { TOUCH } else { self.mean() }
    }
}

/// View of a point from a place of a light: its plane coordinates and depth.
impl LightView {
    /// Shadow displacement \[plane\] per metre of light, by the depth \[m\] of the point and the distance
    /// \[m\] of the blocker before it.
    #[inline]
    fn aside(depth: f32, gap: f32) -> f32 {
        gap / (depth * (depth - gap).max(1e-3))
    }

    /// As `aside`, but no less than some texels of a map of so many in a plane unit.
    #[inline]
    fn aside_at_least(&self, depth: f32, gap: f32, density: f32) -> f32 {
        let least = self.part[0].length().min(self.part[1].length());
        Self::aside(depth, gap).max(LEAST_SIDE / (least * density).max(1e-12))
    }
}

impl ShadowMap {
    /// Share of a place of a light that hair and body let through to skin at a point \[m\], world space: it is the place
    /// of this number among so many, of a light that is hidden by what `blockers` says.
    pub(crate) fn on_skin(&self, point: Vec3, blockers: &Blockers, [place, count]: [usize; 2]) -> f32 {
        if self.view.part == [Vec2::ZERO; 2] {
            return self.transmittance(point);
        }
        let Some(seen) = self.view.project(point) else { return 1.0 };
        let rays = |step: usize| PLACES.iter().skip(step * place).step_by((step * count).max(LEAST_STEP));
        // A blocker that touches the skin is too small for the looks: the place's own ray meets it.
        let open = match blockers.body {
            0.0 => self.body_open(seen, &[Vec2::ZERO]),
            gap => self.past_body(seen, gap, rays(1)),
        };
        if open <= 0.0 {
            return 0.0;
        }
        open * match blockers.hair {
            0.0 => exp(self.crossed(seen) * self.log_transmission()),
            gap => self.past_hair(seen, gap, rays(HAIR_STEP)),
        }
    }

    fn past_body<'a>(&self, seen: Vec3, gap: f32, rays: impl ExactSizeIterator<Item = &'a Vec2>) -> f32 {
        let near = seen.z - self.body_bias;
        let aside = self.view.aside_at_least(near, gap, self.body_window.density);
        let sides = self.view.part.map(|side| side * aside);
        let (before, count) = (near - OWN_SKIN * gap, rays.len());
        let mut hidden = 0.0;
        for ray in rays {
            let at = seen.truncate() + sides[0] * ray.x + sides[1] * ray.y;
            let Some((first, weights)) = self.corners(self.body_window.texel(at)) else { continue };
            for (corner, weight) in self.quad(first).into_iter().zip(weights) {
                let behind = before - self.body_depths[corner];
                hidden += weight * (behind * self.inverse_softness).clamp(0.0, 1.0);
            }
        }
        1.0 - hidden / count as f32
    }

    fn past_hair<'a>(&self, seen: Vec3, gap: f32, rays: impl ExactSizeIterator<Item = &'a Vec2>) -> f32 {
        let aside = self.view.aside_at_least(seen.z, gap, self.hair_window.density);
        let sides = self.view.part.map(|side| side * aside);
        let count = rays.len();
        let passed = |ray: &Vec2| {
            let at = seen.truncate() + sides[0] * ray.x + sides[1] * ray.y;
            exp(self.crossed(at.extend(seen.z)) * self.log_transmission())
        };
        rays.map(passed).sum::<f32>() / count as f32
    }

    /// The texel in which texel coordinates lie.
    #[inline]
    fn nearest(&self, texel: Vec2) -> Option<usize> {
        let limit = self.size as f32;
        let inside = texel.cmpge(Vec2::ZERO).all() && texel.cmplt(Vec2::splat(limit)).all();
        inside.then(|| texel.y as usize * self.size + texel.x as usize)
    }
}
