//! Deep opacity maps \[Yuksel2008\]: what a light sees of hair and body, and how much of it reaches a point.

pub(crate) mod light_view;
mod nearest;
mod picture;

pub(crate) use light_view::{LightView, Window, stepped_down};
pub(crate) use nearest::{NOTHING, Nearest};

use glam::{Vec2, Vec3, Vec4};
use strandline_base::par::{self, prelude::*};

use crate::Shadow;
use crate::fast_math::exp;
use crate::lanes::split_texel;

/// Most parts that the strands of a map are shared out to; each part fills a map of its own.
const MOST_PARTS: usize = 8;

/// Most parts of a map's strands: results do not depend on it.
pub(crate) fn part_count() -> usize {
    par::current_num_threads().min(MOST_PARTS)
}

/// Hair and body as one light sees them.
#[derive(Clone, Debug, Default)]
pub struct ShadowMap {
    pub(crate) view: LightView,
    pub(crate) hair_window: Window,
    pub(crate) body_window: Window,
    pub(crate) size: usize,
    /// Hairs crossed in each of the three layers (RGB) and depth \[m\] of the first hair (A).
    pub(crate) texels: Vec<Vec4>,
    /// Depth \[m\] of the first hair, in rows of `shadow_hair::stride`.
    pub(crate) depths: Vec<f32>,
    /// Depth \[m\] of the body.
    pub(crate) body_depths: Vec<f32>,
    /// Of the first hair.
    pub(crate) nearest_hair: Nearest,
    /// Of the body.
    pub(crate) nearest_body: Nearest,
    /// Into how many parts the strands are shared out.
    pub(crate) parts: usize,
    /// Depths of all parts but the first.
    pub(crate) depth_parts: Vec<Vec<f32>>,
    /// Sums of three layers, and the bits of the depth of the first hair, of each part.
    pub(crate) layer_parts: Vec<Vec<[u32; 4]>>,
    /// Depths \[m\] behind the first hair at which layers begin.
    starts: Vec4,
    /// One over the thickness of each layer \[1/m\].
    inverse_thicknesses: Vec4,
    /// Ends of the layers.
    pub(crate) borders: [f32; 3],
    /// Logarithm of what one hair lets through.
    log_transmission: f32,
    pub(crate) body_bias: f32,
    pub(crate) inverse_softness: f32,
    /// Of which the rays of a place of skin are taken.
    pub(crate) settings: Shadow,
    /// True if a hair hides everything behind it.
    pub(crate) solid: bool,
}

impl ShadowMap {
    pub(crate) fn set(&mut self, settings: &Shadow) {
        let [first, second, third] = settings.layers;
        self.settings = *settings;
        self.size = settings.size() as usize;
        self.starts = Vec4::new(0.0, first, second, 0.0);
        self.inverse_thicknesses =
            Vec4::new(1.0 / first, 1.0 / (second - first), 1.0 / (third - second), 0.0);
        self.borders = settings.layers;
        self.log_transmission = settings.log_transmission();
        self.solid = settings.solid;
        self.body_bias = settings.body_bias;
        self.inverse_softness = 1.0 / settings.body_softness;
    }

    /// Hairs crossed in each of three layers and depth \[m\] of the first hair, 1e30 where there is none,
    /// shape `[row][column]`.
    pub fn texels(&self) -> &[Vec4] {
        &self.texels
    }

    /// Logarithm of what one hair lets through.
    pub(crate) fn log_transmission(&self) -> f32 {
        self.log_transmission
    }

    /// Hairs that the light crosses on its way to a point \[m\], world space.
    ///
    /// Each of the four nearest texels is asked for itself, layers being crossed evenly, and the
    /// answers are blended: depths are never averaged across the outline of the hair [Yuksel2008 §3].
    #[inline]
    pub fn crossings(&self, point: Vec3) -> f32 {
        self.view.project(point).map_or(0.0, |projected| self.crossed(projected))
    }

    /// [`ShadowMap::crossings`] of a point on the plane with its depth \[m\].
    #[inline]
    pub(crate) fn crossed(&self, projected: Vec3) -> f32 {
        let Some((index, weights)) = self.corners(self.hair_window.texel(projected.truncate())) else {
            return 0.0;
        };
        let mut sum = Vec4::ZERO;
        for (corner, weight) in self.quad(index).into_iter().zip(weights) {
            sum += self.layers_before(corner, projected.z) * weight;
        }
        sum.x + sum.y + sum.z
    }

    /// Hairs that the light crosses in a texel before a depth \[m\].
    #[cfg(test)]
    pub(crate) fn crossed_in(&self, texel: usize, depth: f32) -> f32 {
        let sum = self.layers_before(texel, depth);
        sum.x + sum.y + sum.z
    }

    /// Distance \[m\] behind the first hair at which a layer begins, and one over its thickness \[1/m\].
    #[inline]
    pub(crate) fn layer_begin(&self, layer: usize) -> [f32; 2] {
        [self.starts[layer], self.inverse_thicknesses[layer]]
    }

    /// Hairs of a texel in each layer before a depth \[m\].
    #[inline]
    fn layers_before(&self, texel: usize, depth: f32) -> Vec4 {
        let texel = self.texels[texel];
        let behind = Vec4::splat(depth - texel.w) - self.starts;
        let share = (behind * self.inverse_thicknesses).clamp(Vec4::ZERO, Vec4::ONE);
        share * texel
    }

    /// Share of the light that the body lets through to a point \[m\], world space: 0 in its shadow.
    #[inline]
    pub fn body_visibility(&self, point: Vec3) -> f32 {
        self.view.project(point).map_or(1.0, |projected| self.body_open(projected, &[Vec2::ZERO]))
    }

    /// Share of the light that hair and body let through to a point \[m\], world space, by one look at the body.
    #[inline]
    pub(crate) fn reach(&self, point: Vec3) -> f32 {
        let Some(projected) = self.view.project(point) else { return 1.0 };
        let open = self.body_open(projected, &[Vec2::ZERO]);
        if open > 0.0 { open * exp(self.crossed(projected) * self.log_transmission) } else { 0.0 }
    }

    /// Share of the light that hair and body let through to a point \[m\], world space.
    ///
    /// The edge of the body's shadow is smoothed over three texels, since it falls on smooth skin.
    #[inline]
    pub fn transmittance(&self, point: Vec3) -> f32 {
        const AROUND: [Vec2; 4] =
            [Vec2::new(-0.9, -0.4), Vec2::new(0.4, -0.9), Vec2::new(0.9, 0.4), Vec2::new(-0.4, 0.9)];
        let Some(projected) = self.view.project(point) else { return 1.0 };
        let visibility = self.body_open(projected, &AROUND);
        if visibility == 0.0 {
            0.0
        } else {
            visibility * exp(self.crossed(projected) * self.log_transmission)
        }
    }

    /// Mean visibility past the body at offsets \[texel\] from a point on the plane with its depth \[m\].
    #[inline]
    pub(crate) fn body_open(&self, projected: Vec3, offsets: &[Vec2]) -> f32 {
        if self.body_depths.is_empty() {
            return 1.0;
        }
        let texel = self.body_window.texel(projected.truncate());
        let nearest = projected.z - self.body_bias;
        let mut shadow = 0.0;
        for &offset in offsets {
            let Some((index, weights)) = self.corners(texel + offset) else { continue };
            for (corner, weight) in self.quad(index).into_iter().zip(weights) {
                let behind = nearest - self.body_depths[corner];
                shadow += weight * (behind * self.inverse_softness).clamp(0.0, 1.0);
            }
        }
        1.0 - shadow / offsets.len() as f32
    }

    /// The first of the four texels whose middles surround texel coordinates, and the weights of the four.
    #[inline]
    pub(crate) fn corners(&self, texel: Vec2) -> Option<(usize, [f32; 4])> {
        let ([column, row], weights) = self.place(texel)?;
        Some((row * self.size + column, weights))
    }

    /// As [`ShadowMap::corners`], with the first texel's column and row.
    #[inline]
    pub(crate) fn place(&self, texel: Vec2) -> Option<([usize; 2], [f32; 4])> {
        let texel = texel - Vec2::splat(0.5);
        let limit = self.size as f32 - 1.0;
        if !(texel.x >= 0.0 && texel.y >= 0.0 && texel.x < limit && texel.y < limit) {
            return None;
        }
        let (first, Vec2 { x, y }) = split_texel(texel);
        Some((first, [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y]))
    }

    #[inline]
    pub(crate) fn quad_at(&self, [column, row]: [usize; 2]) -> [usize; 4] {
        self.quad(row * self.size + column)
    }

    #[inline]
    pub(crate) fn quad(&self, first: usize) -> [usize; 4] {
        [first, first + 1, first + self.size, first + self.size + 1]
    }
}

/// The shadow maps of all lights.
#[derive(Clone, Debug, Default)]
pub struct Shadows {
    /// One for each light, in their order; lights without shadow have an unused one.
    pub(crate) maps: Vec<ShadowMap>,
    /// Lights that cast shadows.
    pub(crate) casts: Vec<bool>,
}

impl Shadows {
    /// The map of a light; `None` for one without shadow.
    pub fn map(&self, light: usize) -> Option<&ShadowMap> {
        if *self.casts.get(light)? { self.maps.get(light) } else { None }
    }

    pub(crate) fn active(&mut self) -> impl ParallelIterator<Item = &mut ShadowMap> {
        self.maps.par_iter_mut().zip(self.casts.par_iter()).filter_map(|(map, casts)| casts.then_some(map))
    }
}
