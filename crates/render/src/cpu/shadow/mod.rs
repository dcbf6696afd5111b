//! Deep opacity maps \[Yuksel2008\]: what a light sees of hair and body, and how much of it reaches a point.

mod body;
pub(crate) mod hair;
pub mod layer_colors;
pub mod opacity_depth;
pub mod opacity_layers;
mod penumbra;
mod picture;

pub use body::ShadowBody;

use glam::{Vec2, Vec3, Vec4};
use strandline_base::math;
use strandline_base::par::prelude::*;

use crate::cpu::fast_math::exp;
use crate::cpu::lanes::split_texel;
use crate::{Light, LightKind, Shadow};

/// Depth \[m\] of a texel that holds nothing.
pub(crate) const NOTHING: f32 = 1e30;
/// Nearest depth \[m\] that a spot or point light sees.
const NEAR_LIGHT: f32 = 1e-2;

/// Where a light looks from, and how it maps points to its plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LightView {
    pub(crate) origin: Vec3,
    pub(crate) right: Vec3,
    pub(crate) up: Vec3,
    pub(crate) forward: Vec3,
    parallel: bool,
    /// Greatest coordinate on the plane that the light reaches.
    pub(crate) reach: f32,
    /// Sides \[m\], along `right` and `up`, of the part of a light with an area that this place of it stands for.
    pub(crate) part: [Vec2; 2],
}

impl LightView {
    /// The view of a light; a point light looks at `middle` \[m\].
    pub(crate) fn new(light: &Light, middle: Vec3) -> Self {
        let looks_at_hair = matches!(light.kind, LightKind::Point | LightKind::Rectangle | LightKind::Disc);
        let target = if looks_at_hair { middle } else { light.target };
        let forward = (target - light.position).normalize_or(Vec3::NEG_Y);
        let (right, up) = across(forward);
        let reach = match light.kind {
            LightKind::Directional => f32::INFINITY,
            LightKind::Spot => math::tan(light.cone_angle.to_radians()),
            LightKind::Point | LightKind::Rectangle | LightKind::Disc => 10.0,
        };
        let parallel = light.kind == LightKind::Directional;
        let part = light.part().map(|side| Vec2::new(side.dot(right), side.dot(up)));
        Self { origin: light.position, right, up, forward, parallel, reach, part }
    }

    /// Plane coordinates and depth \[m\]; `None` behind the light.
    #[inline]
    pub(crate) fn project(&self, point: Vec3) -> Option<Vec3> {
        let way = point - self.origin;
        let depth = way.dot(self.forward);
        let (x, y) = (way.dot(self.right), way.dot(self.up));
        if self.parallel {
            Some(Vec3::new(x, y, depth))
        } else if depth > NEAR_LIGHT {
            let inverse = 1.0 / depth;
            Some(Vec3::new(x * inverse, y * inverse, depth))
        } else {
            None
        }
    }

    /// The unit direction on the plane that points down in the world; along the rows where none does.
    pub(crate) fn down(&self) -> Vec2 {
        let down = -Vec2::new(self.right.y, self.up.y);
        if down.length() > 1e-3 { down.normalize() } else { Vec2::Y }
    }

    /// Plane units a metre measures at a depth.
    #[inline]
    pub(crate) fn scale(&self, depth: f32) -> f32 {
        if self.parallel { 1.0 } else { 1.0 / depth }
    }
}

/// The two directions of a light's plane, carried from those of a light from above by the smallest rotation.
///
/// They change as smoothly as the light moves, but about one that shines straight up: some direction must be
/// left out, and few lights stand below the hair.
fn across(forward: Vec3) -> (Vec3, Vec3) {
    let whole = 1.0 - forward.y;
    if whole < 1e-6 {
        return (Vec3::X, Vec3::NEG_Z);
    }
    let turned = (forward - Vec3::Y) / whole;
    (Vec3::X - forward.x * turned, Vec3::Z - forward.z * turned)
}

/// A number rounded down to so many bits behind the first: steps that small changes rarely cross.
pub(crate) fn stepped_down(number: f32, bits: u32) -> f32 {
    f32::from_bits(number.to_bits() & (u32::MAX << (23 - bits)))
}

/// Bits of a map's density behind the first: steps of 14 to 25 %.
const DENSITY_BITS: u32 = 2;

/// The square part of a light's plane that a map covers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Window {
    pub(crate) min: Vec2,
    /// Texels in a plane unit.
    pub(crate) density: f32,
}

impl Window {
    /// A square around `bounds` (least and greatest plane coordinates) that the light reaches, with a border
    /// of one texel.
    ///
    /// Texels have sizes of a few steps and lie whole numbers of them beside `middle` \[m\], so that they stay
    /// where they are on the hair while its outline changes.
    pub(crate) fn around(bounds: (Vec2, Vec2), view: &LightView, middle: Vec3, size: usize) -> Self {
        let reach = Vec2::splat(view.reach);
        let (min, max) = (bounds.0.max(-reach), bounds.1.min(reach));
        if !(min.cmple(max).all() && min.is_finite() && max.is_finite()) {
            return Self { min: Vec2::ZERO, density: 0.0 };
        }
        let extent = (max - min).max_element().max(1e-4);
        // A texel of border on each side, and half a one on each for whole numbers.
        let density = stepped_down((size as f32 - 3.0) / extent, DENSITY_BITS);
        let anchor = view.project(middle).map_or(Vec2::ZERO, Vec3::truncate);
        let first = (0.5 * (min + max) - anchor) * density - Vec2::splat(0.5 * size as f32 - 0.5);
        Self { min: anchor + first.floor() / density, density }
    }

    /// Texel coordinates; texel 0 lies between 0 and 1.
    #[inline]
    pub(crate) fn texel(&self, plane: Vec2) -> Vec2 {
        (plane - self.min) * self.density
    }
}

/// What one light sees of hair and body.
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
    /// Where the layers end.
    pub(crate) borders: [f32; 3],
    /// Logarithm of what one hair lets through.
    log_transmission: f32,
    pub(crate) body_bias: f32,
    pub(crate) inverse_softness: f32,
    /// Whether a hair hides all behind it.
    pub(crate) solid: bool,
}

impl ShadowMap {
    pub(crate) fn set(&mut self, settings: &Shadow) {
        let [first, second, third] = settings.layers;
        self.size = settings.map_size as usize;
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
            let texel = self.texels[corner];
            let behind = Vec4::splat(projected.z - texel.w) - self.starts;
            let share = (behind * self.inverse_thicknesses).clamp(Vec4::ZERO, Vec4::ONE);
            sum += share * texel * weight;
        }
        sum.x + sum.y + sum.z
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
        let texel = texel - Vec2::splat(0.5);
        let limit = self.size as f32 - 1.0;
        if !(texel.x >= 0.0 && texel.y >= 0.0 && texel.x < limit && texel.y < limit) {
            return None;
        }
        let ([column, row], Vec2 { x, y }) = split_texel(texel);
        let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
        Some((row * self.size + column, weights))
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
    /// Which lights cast shadows.
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
