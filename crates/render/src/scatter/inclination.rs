//! Inclination of light that hair has scattered once, finer than the directions along which it is carried.
//!
//! The 26 directions lie 35 to 55 degrees apart, a fibre's lobes are 8 to 30 degrees wide: light that crosses upright hair at
//! 30 degrees would go on at 0, 35 or 45. Hair lit from behind would be dark where it should pass light on, and bright
//! where light should pass it by. So a direction stands for all inclinations around it, and the last lane of its
//! radiance holds the first moment of the light in it: how much its mean sine of inclination lies beside the
//! direction's own, times the sum of its channels. It is carried as light is, and tells the next hair where light
//! comes from.

use glam::Vec3;

use super::lattice::{DIRECTIONS, Rays};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fibre::Chiang;
    use crate::scatter::lattice::{ALL_DARK, Lattice};

    /// Mean sines of inclination of light of a direction behind white hair: by the directions alone, with the moments,
    /// and as a fibre sends it.
    fn means(t: Vec3, to_light: Vec3) -> [f32; 3] {
        let lobes = Chiang::default().lobes();
        let lattice = Lattice::new(&lobes, [0.0; 3], None);
        let mut shown = Rays::default();
        lattice.add_light(t, &lattice.shows(t), &ALL_DARK, (to_light, Vec3::ONE), &mut shown);
        let (mut whole, mut own, mut moved) = (0.0, 0.0, 0.0);
        for (shown, (way, share)) in shown.iter().zip(lattice.ways()) {
            let (sine, power) = (t.dot(*way), shown.truncate().element_sum() * share);
            let flat = (1.0 - sine * sine).max(0.0).sqrt();
            whole += power * flat;
            own += power * flat * sine;
            moved += share * flat * shown.w;
        }
        let from = t.dot(to_light);
        let shares = lattice.straight_shares(from);
        let kept = Inclination::new(&lobes).kept;
        let sent: f32 = shares.iter().zip(kept).map(|(share, kept)| share.x * -kept * from).sum();
        let all: f32 = shares.iter().map(|share| share.x).sum();
        [own / whole, (own + moved) / whole, sent / all]
    }

    #[test]
    fn light_that_is_scattered_once_keeps_its_inclination() {
        let mut apart = [0.0_f32; 2];
        for index in 0..24 {
            let (height, turn) = (0.9 - 0.075 * index as f32, index as f32 * 2.4);
            let flat = (1.0 - height * height).sqrt();
            let to_light = Vec3::new(flat * turn.cos(), height, flat * turn.sin());
            for t in [Vec3::Y, Vec3::new(0.06, 1.0, 0.03).normalize(), Vec3::new(0.3, 0.8, -0.5).normalize()]
            {
                let [own, moved, sent] = means(t, to_light);
                apart = [apart[0].max((own - sent).abs()), apart[1].max((moved - sent).abs())];
            }
        }
        // The directions alone are 6 degrees off.
        assert!(apart[0] > 0.08 && apart[1] < 0.04, "{apart:?}");
    }
}
