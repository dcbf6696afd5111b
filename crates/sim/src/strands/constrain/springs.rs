//! Elastic springs along a strand [Chen2011 §4].

use std::ops::Range;

use strandline_groom::{Lanes, RestShape, Vec3Lanes};

use super::settings::{Spring, Springs};
use strandline_base::vec3x8::{Vec3x8, load, splat};

/// The springs that pull, each kind with its stride and rest lengths \[m\], shape `[block][point]` of lanes.
pub struct Elastic<'a> {
    kinds: Vec<(usize, Spring, &'a [Lanes])>,
    time_step: f32,
}

impl<'a> Elastic<'a> {
    /// Springs of settings between points of a rest shape, in steps of a length \[s\].
    pub fn new(springs: &Springs, rest: &'a RestShape, time_step: f32) -> Self {
        let kinds = [
            (1, springs.stretch, &*rest.stretch),
            (2, springs.bend, &*rest.bend),
            (3, springs.torsion, &*rest.torsion),
        ];
        Self { kinds: kinds.into_iter().filter(|(_, spring, _)| spring.enabled).collect(), time_step }
    }

    /// Adds what springs change the velocities of a block of strands by \[m/s\] in a step; `range` are its points.
    #[inline]
    pub fn pull(&self, strand: &Strand, range: Range<usize>, kicks: &mut [Vec3x8]) {
        for (stride, spring, rest) in &self.kinds {
            strand.pull((*stride, spring, &rest[range.clone()]), self.time_step, kicks);
        }
    }
}

/// One block of strands as springs see it.
pub struct Strand<'a> {
    pub positions: &'a [Vec3Lanes],
    pub velocities: &'a [Vec3Lanes],
    pub inverse_mass: &'a [Lanes],
}

impl Strand<'_> {
    /// Adds the changes of velocity \[m/s\] by one kind of spring in a step.
    ///
    /// A point has at most six springs. With k <= m / (12 dt^2) and c <= m / (12 dt) for each, the
    /// largest eigenvalues keep dt^2 w^2 <= 1 and c dt / m <= 2, inside the bound dt^2 w^2 + 2 c dt
    /// / m < 4 of the semi-implicit Euler step.
    fn pull(&self, (stride, spring, rest): (usize, &Spring, &[Lanes]), time_step: f32, kicks: &mut [Vec3x8]) {
        let stiffest = splat(1.0 / (12.0 * time_step * time_step));
        let most_damped = splat(1.0 / (12.0 * time_step));
        for lower in 0..self.positions.len() - stride {
            let upper = lower + stride;
            let (weight_lower, weight_upper) =
                (load(&self.inverse_mass[lower]), load(&self.inverse_mass[upper]));
            let lighter = splat(1.0) / weight_lower.fast_max(weight_upper).fast_max(splat(1e-30));
            let stiffness = splat(spring.stiffness).fast_min(stiffest * lighter);
            let damping = splat(spring.damping).fast_min(most_damped * lighter);
            let across = Vec3x8::load(&self.positions[upper]) - Vec3x8::load(&self.positions[lower]);
            let parting = Vec3x8::load(&self.velocities[upper]) - Vec3x8::load(&self.velocities[lower]);
            let length = across.length();
            let along = across * (splat(1.0) / length);
            let force = stiffness * (length - load(&rest[lower])) + damping * parting.dot(along);
            let impulse = along * (force * splat(time_step));
            kicks[lower] += impulse * weight_lower;
            kicks[upper] -= impulse * weight_upper;
        }
    }
}
