//! Inclination of light that hair has scattered once, finer than the directions along which it is carried.
//!
//! The 26 directions lie 35 to 55 degrees apart, a fibre's lobes are 8 to 30 degrees wide: light that crosses upright hair at
//! 30 degrees would go on at 0, 35 or 45. Hair lit from behind would be dark where it should pass light on, and bright
//! where light should pass it by. So a direction stands for all inclinations around it, and the last lane of its
//! radiance holds the first moment of the light in it: how much its mean sine of inclination lies beside the
//! direction's own, times the sum of its channels. It is carried as light is, and tells the next hair where light
//! comes from.

use glam::Vec3;

use super::ways::{DIRECTIONS, Rays};
use crate::fibre::chiang::Lobes;

/// Variance \[rad^2\] of the inclinations that a direction stands for: those of a hat function between nearest
/// neighbours, which lie 35.26 degrees apart.
pub(super) const REGION: f64 = 0.063;
/// Kinds of paths: R, TT, TRT.
pub(crate) const PATHS: usize = 3;

/// Inclination of light behind a fibre of each kind of path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inclination {
    /// Share of the sine of its inclination that light keeps.
    pub(crate) kept: [f32; PATHS],
    /// Share of the way from a direction's own inclination to that of a lobe at which the part of the lobe lies that the
    /// direction stands for.
    pub(crate) drawn: [f32; PATHS],
}

impl Inclination {
    /// Of a fibre's lobes, not spread.
    pub(super) fn new(lobes: &Lobes) -> Self {
        let variances = lobes.path_variances();
        Self {
            kept: lobes.kept().map(|kept| kept as f32),
            // The product of two normal distributions.
            drawn: variances.map(|variance| (REGION / (REGION + variance)) as f32),
        }
    }

    /// First moment of light of each kind of path along a direction whose inclination has the sine `own`, where the
    /// light came to the fibre from one of the sine `from`.
    #[inline]
    pub(super) fn moment(&self, paths: &[Vec3; PATHS], from: f32, own: f32) -> f32 {
        (0..PATHS)
            .map(|path| paths[path].element_sum() * self.drawn[path] * (-self.kept[path] * from - own))
            .sum()
    }
}

/// Mean sine of inclination of the light along each direction, less the direction's own.
#[inline]
pub(super) fn offsets(rays: &Rays) -> [f32; DIRECTIONS] {
    rays.map(|ray| ray.w / (ray.x + ray.y + ray.z).max(1e-20))
}
