//! Forces common to all points: gravity, drag and damping.

use glam::Vec3;
use strandline_base::math;
use strandline_base::vec3x8::{Vec3x8, load, splat};
use strandline_groom::{Lanes, Vec3Lanes};
use wide::f32x8;

use crate::Model;

/// Accelerations common to all points.
pub(crate) struct Fall {
    time_step: f32x8,
    gravity: Vec3x8,
    wind: Vec3x8,
    /// Share of the wind that a step takes over, across and along the strand.
    across: f32x8,
    along: f32x8,
    kept: f32x8,
}

impl Fall {
    pub(super) fn new(model: &Model, wind: Vec3) -> Self {
        let drag = &model.settings.drag;
        Self::for_time(model, model.settings.time_step, wind, [drag.across, drag.along])
    }

    /// Accelerations of rods over a time \[s\], a part of a step.
    pub(crate) fn of_rods(model: &Model, time_step: f32, wind: Vec3) -> Self {
        Self::for_time(model, time_step, wind, model.settings.drag.rates_of_rods())
    }

    /// Accelerations over a time \[s\] with rates of the air across and along a strand \[1/s\].
    fn for_time(model: &Model, time_step: f32, wind: Vec3, [across, along]: [f32; 2]) -> Self {
        let settings = &model.settings;
        let taken = |rate: f32| -math::exp_m1(-rate * time_step);
        Self {
            time_step: splat(time_step),
            gravity: Vec3x8::splat(settings.gravity * time_step),
            wind: Vec3x8::splat(wind),
            across: splat(taken(across)),
            along: splat(taken(along)),
            kept: splat(1.0 - taken(settings.damping)),
        }
    }

    /// Velocities \[m/s\] of points with a tangent after gravity, the air and an impulse.
    #[inline(always)]
    fn velocity(&self, before: Vec3x8, tangent: Vec3x8, kick: Vec3x8) -> Vec3x8 {
        let pushed = before + self.gravity + kick;
        let relative = self.wind - pushed;
        let along = tangent * (tangent.dot(relative) / (tangent.dot(tangent) + splat(1e-30)));
        (pushed + (relative - along) * self.across + along * self.along) * self.kept
    }

    /// Velocities \[m/s\] after the air, then gravity: damping takes nothing of the weight of resting hair.
    #[inline(always)]
    pub(crate) fn weighted(&self, before: Vec3x8, tangent: Vec3x8) -> Vec3x8 {
        let relative = self.wind - before;
        let along = tangent * (tangent.dot(relative) / (tangent.dot(tangent) + splat(1e-30)));
        (before + (relative - along) * self.across + along * self.along) * self.kept + self.gravity
    }

    /// Predicts the positions of points at the end of a step, and gives them the velocities that lead there.
    pub(super) fn predict(
        &self,
        positions: &[Vec3Lanes],
        corrections: &[Vec3Lanes],
        inverse_mass: &[Lanes],
        kicks: &[Vec3x8],
        velocities: &mut [Vec3Lanes],
        predicted: &mut [Vec3Lanes],
    ) {
        let last = positions.len() - 1;
        for point in 0..=last {
            let free = load(&inverse_mass[point]).simd_gt(splat(0.0));
            let before = Vec3x8::load(&velocities[point]);
            let tangent = Vec3x8::load(&positions[last.min(point + 1)])
                - Vec3x8::load(&positions[point.saturating_sub(1)]);
            let velocity = self.velocity(before, tangent, kicks[point]).or(free, before);
            velocity.store(&mut velocities[point]);
            let ahead = velocity + Vec3x8::load(&corrections[point]);
            let end = Vec3x8::load(&positions[point]) + ahead * self.time_step;
            end.or(free, Vec3x8::load(&predicted[point])).store(&mut predicted[point]);
        }
    }
}
