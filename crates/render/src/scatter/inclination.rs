//! Inclination of light that hair has scattered once, finer than the directions along which it is carried.
//!
//! The 50 directions of a set lie 25 to 31 degrees apart, a fibre's lobes are 8 to 30 degrees wide: light that crosses upright hair
//! at 15 degrees would go on at 0 or 25. Hair lit from behind would be dark where it should pass light on, and bright
//! where light should pass it by. So a direction stands for all inclinations around it, and the last lane of its
//! radiance holds the first moment of the light in it: how much its mean sine of inclination lies beside the
//! direction's own, times the sum of its channels. It is carried as light is, and tells the next hair where light
//! comes from.

use glam::Vec3;
use strandline_base::math;

use super::ways::{DIRECTIONS, Rays};
use crate::fibre::chiang::Lobes;

/// Variance \[rad^2\] of the inclinations that a direction stands for: those of a hat function between nearest
/// neighbours, which lie 25.24 degrees apart.
pub(super) const REGION: f64 = 0.0323;
/// Kinds of paths: R, TT, TRT.
pub(crate) const PATHS: usize = 3;

/// Inclination of light behind a fibre of each kind of path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inclination {
    /// Shares of the sine of its inclination that light keeps, and of the cosine that the tilted scales make a sine.
    pub(crate) kept: [f32; PATHS],
    pub(crate) tilted: [f32; PATHS],
    /// Share of the way from a direction's own inclination to that of a lobe at which the part of the lobe lies that the
    /// direction stands for.
    pub(crate) drawn: [f32; PATHS],
}

impl Inclination {
    /// Of a fibre's lobes, not spread.
    pub(super) fn new(lobes: &Lobes) -> Self {
        let (variances, kept, tilts) = (lobes.path_variances(), lobes.kept(), lobes.tilts());
        let of_tilt = |of: fn(f64) -> f64| std::array::from_fn(|path| (kept[path] * of(tilts[path])) as f32);
        Self {
            kept: of_tilt(math::cos),
            tilted: of_tilt(math::sin),
            // The product of two normal distributions.
            drawn: variances.map(|variance| (REGION / (REGION + variance)) as f32),
        }
    }

    /// Mean sines of inclination of each kind of path of light that came to the fibre from an inclination of a sine and a
    /// cosine.
    #[inline]
    pub(super) fn sent(&self, from: f32, flat: f32) -> [f32; PATHS] {
        std::array::from_fn(|path| -self.kept[path] * from - self.tilted[path] * flat)
    }

    /// First moment of light of each kind of path along a direction whose inclination has the sine `own`, where the
    /// light was [`sent`](Self::sent).
    #[inline]
    pub(super) fn moment(&self, paths: &[Vec3; PATHS], sent: &[f32; PATHS], own: f32) -> f32 {
        (0..PATHS).map(|path| paths[path].element_sum() * self.drawn[path] * (sent[path] - own)).sum()
    }
}

/// Mean sine of inclination of the light along each direction, less the direction's own.
#[inline]
pub(super) fn offsets(rays: &Rays) -> [f32; DIRECTIONS] {
    rays.map(|ray| ray.w / (ray.x + ray.y + ray.z).max(1e-20))
}
