//! Soft edges of shadows on skin: what hides a part of a light with an area from a point.
//!
//! A map is what one place of a light sees; that place stands for a part of the light. Where the map is looked at aside
//! tells which of the part's rays hair or body hides [Fernando2005]: a blocker at depth d hides from a point at depth z
//! what it hides beside the place by (z - d) / (z d) of the distance on the light.

use glam::{Vec2, Vec3};

use super::fast_math::exp;
use super::shadow::{LightView, ShadowMap};

/// Looks for what hides the light.
const BODY_LOOKS: usize = 40;
const HAIR_LOOKS: usize = 40;
/// Rays of the light's part that are tried.
const BODY_RAYS: usize = 34;
const HAIR_RAYS: usize = 21;
/// Distance \[m\] before skin as far as blockers are looked for all about; farther ones are found where their shadow is
/// deep.
const MOST_GAP: f32 = 0.4;
/// What lies nearer than so much of the mean distance of blockers is the skin itself.
const OWN_SKIN: f32 = 0.3;
/// Least side \[texel\] of what is looked at.
const LEAST_SIDE: f32 = 2.0;
/// A share of a whole that many steps of are spread evenly over it.
const GOLDEN: f32 = 0.618_034;

/// One of so many places in a square of side 1 about 0: seen from every side their shadows lie evenly.
#[inline]
fn place(index: usize, count: usize) -> Vec2 {
    Vec2::new((index as f32 + 0.5) / count as f32, (index as f32 * GOLDEN).fract()) - 0.5
}

/// One of so many places that lie denser toward the middle of the square, where near blockers are; its distance from
/// there over that of the square's sides.
#[inline]
fn look(index: usize, count: usize) -> (Vec2, f32) {
    let around = 4.0 * (index as f32 * GOLDEN).fract();
    let along = around.fract() - 0.5;
    let side = if around % 2.0 < 1.0 { Vec2::new(along, 0.5) } else { Vec2::new(0.5, along) };
    let reach = (index as f32 + 0.5) / count as f32;
    (side * if around < 2.0 { reach } else { -reach }, reach)
}

/// Where a place of a light looks at a point from: its plane coordinates and depth.
impl LightView {
    /// How far aside \[plane\] a metre on the light moves what hides a point at a depth \[m\], by so much before it \[m\].
    #[inline]
    fn aside(depth: f32, gap: f32) -> f32 {
        gap / (depth * (depth - gap).max(1e-3))
    }

    /// A place of the light's part on the plane, for a square of side 1.
    #[inline]
    fn on_part(&self, at: Vec2) -> Vec2 {
        self.part[0] * at.x + self.part[1] * at.y
    }

    /// As `aside`, but no less than some texels of a map of so many in a plane unit.
    #[inline]
    fn aside_at_least(&self, depth: f32, gap: f32, density: f32) -> f32 {
        let least = self.part[0].length().min(self.part[1].length());
        Self::aside(depth, gap).max(LEAST_SIDE / (least * density).max(1e-12))
    }
}

impl ShadowMap {
    /// Share of the light that hair and body let through to skin at a point \[m\], world space.
    pub(crate) fn on_skin(&self, point: Vec3) -> f32 {
        if self.view.part == [Vec2::ZERO; 2] {
            return self.transmittance(point);
        }
        let Some(seen) = self.view.project(point) else { return 1.0 };
        let open = self.past_body(seen);
        if open > 0.0 { open * self.past_hair(seen) } else { 0.0 }
    }

    /// Mean distance before a point of what hides its light, of depths that are looked up; none where nothing does.
    #[inline]
    fn gap(&self, seen: Vec3, looks: usize, depth_at: impl Fn(Vec2) -> Option<f32>) -> Option<f32> {
        let most = LightView::aside(seen.z, MOST_GAP.min(0.5 * seen.z));
        let (mut sum, mut count) = (0.0, 0.0);
        for (at, reach) in (0..looks).map(|index| look(index, looks)) {
            let Some(depth) = depth_at(seen.truncate() + self.view.on_part(at) * most) else { continue };
            let gap = seen.z - depth;
            // What hides none of this part's rays does not count.
            if gap > 0.0 && LightView::aside(seen.z, gap) >= reach * most {
                sum += gap;
                count += 1.0;
            }
        }
        (count > 0.0).then(|| sum / count)
    }

    fn past_body(&self, seen: Vec3) -> f32 {
        if self.body_depths.is_empty() {
            return 1.0;
        }
        let near = Vec3 { z: seen.z - self.body_bias, ..seen };
        let depth_at = |at: Vec2| Some(self.body_depths[self.nearest(self.body_window.texel(at))?]);
        let Some(gap) = self.gap(near, BODY_LOOKS, depth_at) else { return 1.0 };
        let aside = self.view.aside_at_least(near.z, gap, self.body_window.density);
        let before = near.z - OWN_SKIN * gap;
        let mut hidden = 0.0;
        for ray in 0..BODY_RAYS {
            let at = seen.truncate() + self.view.on_part(place(ray, BODY_RAYS)) * aside;
            let Some((first, weights)) = self.corners(self.body_window.texel(at)) else { continue };
            for (corner, weight) in self.quad(first).into_iter().zip(weights) {
                let behind = before - self.body_depths[corner];
                hidden += weight * (behind * self.inverse_softness).clamp(0.0, 1.0);
            }
        }
        1.0 - hidden / BODY_RAYS as f32
    }

    fn past_hair(&self, seen: Vec3) -> f32 {
        let depth_at = |at: Vec2| Some(self.texels[self.nearest(self.hair_window.texel(at))?].w);
        let Some(gap) = self.gap(seen, HAIR_LOOKS, depth_at) else { return 1.0 };
        let aside = self.view.aside_at_least(seen.z, gap, self.hair_window.density);
        let passed = |ray: usize| {
            let at = seen.truncate() + self.view.on_part(place(ray, HAIR_RAYS)) * aside;
            exp(self.crossed(at.extend(seen.z)) * self.log_transmission())
        };
        (0..HAIR_RAYS).map(passed).sum::<f32>() / HAIR_RAYS as f32
    }

    /// The texel in which texel coordinates lie.
    #[inline]
    fn nearest(&self, texel: Vec2) -> Option<usize> {
        let limit = self.size as f32;
        let inside = texel.cmpge(Vec2::ZERO).all() && texel.cmplt(Vec2::splat(limit)).all();
        inside.then(|| texel.y as usize * self.size + texel.x as usize)
    }
}
