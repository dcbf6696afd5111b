//! Preconditioned conjugate gradients [Bridson2008, Chen2011 §4.2.3].
//!
//! Everything runs in the order of the unknowns on one thread: the substitutions of MIC(0) are a
//! chain by nature, and sums do not depend on the number of threads.

use super::poisson::Poisson;
use crate::chebyshev::{CHEBYSHEV_LEAST, CHEBYSHEV_MOST, CHEBYSHEV_STEPS};
use crate::{Preconditioner, PressureReport};

/// Share of the dropped fill-in that MIC(0) adds to the diagonal \[Bridson2008\].
const TAU: f32 = 0.97;
/// Least share of the diagonal that a pivot may keep \[Bridson2008\].
const SIGMA: f32 = 0.25;

/// When to stop, and how to get there fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PcgSettings {
    /// The preconditioner.
    pub preconditioner: Preconditioner,
    /// Residual over the first residual, both in the maximum norm.
    pub tolerance: f32,
    /// Most iterations.
    pub max_iterations: u32,
}

/// The unknowns, with a zero behind the last.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// Right-hand side, replaced by the residual.
    pub right: Vec<f32>,
    /// The solution.
    pub values: Vec<f32>,
}

/// Memory of the solver, kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct Pcg {
    /// Inverse square roots of MIC(0)'s pivots, or inverse diagonals.
    scale: Vec<f32>,
    forward: Vec<f32>,
    carried: Vec<f32>,
    better: Vec<f32>,
    search: Vec<f32>,
    image: Vec<f32>,
}

impl Pcg {
    /// Solves A x = right from x = 0. `solution.right` holds the right-hand side on entry (its
    /// length the number of unknowns) and the residual on return.
    pub fn solve(
        &mut self,
        system: &Poisson,
        settings: &PcgSettings,
        solution: &mut Solution,
    ) -> PressureReport {
        let count = system.len();
        system.make_compatible(&mut solution.right[..count]);
        solution.right.resize(count + 1, 0.0);
        solution.values.clear();
        solution.values.resize(count + 1, 0.0);
        let first = largest(&solution.right);
        let mut report =
            PressureReport { fluid_cells: count, absolute_residual: first, ..Default::default() };
        let mut met = first <= settings.tolerance;
        if count == 0 || first == 0.0 || !first.is_finite() {
            return report;
        }
        self.prepare(system, settings.preconditioner);
        self.precondition(system, settings.preconditioner, &solution.right);
        self.search.clone_from(&self.better);
        let mut rate = dot(&self.better, &solution.right);
        report.relative_residual = 1.0;
        while report.relative_residual > settings.tolerance
            && report.iterations < settings.max_iterations as usize
        {
            system.multiply(&self.search, &mut self.image);
            let curvature = dot(&self.search, &self.image);
            // Rounding can leave a direction without curvature when nothing is left to gain.
            if curvature <= 0.0 {
                break;
            }
            let step = (rate / curvature) as f32;
            advance(&mut solution.values, step, &self.search);
            advance(&mut solution.right, -step, &self.image);
            report.iterations += 1;
            report.absolute_residual = largest(&solution.right);
            report.relative_residual = report.absolute_residual / first;
            if !met {
                report.iterations_absolute = report.iterations;
                met = report.absolute_residual <= settings.tolerance;
            }
            self.precondition(system, settings.preconditioner, &solution.right);
            let next = dot(&self.better, &solution.right);
            let share = (next / rate) as f32;
            rate = next;
            for (search, better) in self.search.iter_mut().zip(&self.better) {
                *search = better + share * *search;
            }
        }
        report
    }

    fn prepare(&mut self, system: &Poisson, preconditioner: Preconditioner) {
        let size = system.len() + 1;
        for vector in
            [&mut self.forward, &mut self.carried, &mut self.better, &mut self.search, &mut self.image]
        {
            vector.clear();
            vector.resize(size, 0.0);
        }
        self.scale.clear();
        match preconditioner {
            Preconditioner::Auto | Preconditioner::Mic0 => self.factorize(system),
            Preconditioner::Jacobi | Preconditioner::Chebyshev => {
                let inverse = |diagonal: &f32| if *diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
                self.scale.extend(system.diagonal.iter().map(inverse));
            }
            Preconditioner::None => self.scale.resize(size - 1, 1.0),
        }
        self.scale.push(0.0);
    }

    /// Modified incomplete Cholesky of level zero \[Bridson2008\]. A pivot that becomes too small
    /// leaves the dropped fill-in out; where that does not help, it is the diagonal. Around solids
    /// this saves a sixth of the iterations against going to the diagonal at once.
    fn factorize(&mut self, system: &Poisson) {
        for unknown in 0..system.len() {
            let diagonal = system.diagonal[unknown];
            let least = SIGMA * diagonal;
            let pivot = [TAU, 0.0]
                .into_iter()
                .map(|tau| self.pivot(system, unknown, tau))
                .find(|pivot| *pivot >= least)
                .unwrap_or(diagonal);
            self.scale.push(if pivot > 0.0 { 1.0 / pivot.sqrt() } else { 0.0 });
        }
    }

    /// The pivot of an unknown with a share of the dropped fill-in.
    #[inline]
    fn pivot(&self, system: &Poisson, unknown: usize, tau: f32) -> f32 {
        let zero = system.len();
        let mut pivot = system.diagonal[unknown];
        for (axis, before) in system.lower[unknown].into_iter().enumerate() {
            let before = before as usize;
            if before < zero {
                let coupled =
                    |other: &usize| *other != axis && (system.upper[before][*other] as usize) < zero;
                let dropped = (0..3).filter(coupled).count() as f32;
                pivot -= self.scale[before] * self.scale[before] * (1.0 + tau * dropped);
            }
        }
        pivot
    }

    /// `better` = M^-1 `residual`.
    fn precondition(&mut self, system: &Poisson, preconditioner: Preconditioner, residual: &[f32]) {
        match preconditioner {
            Preconditioner::Auto | Preconditioner::Mic0 => self.substitute(system, residual),
            Preconditioner::Chebyshev => self.smooth(system, residual),
            Preconditioner::Jacobi | Preconditioner::None => {
                for ((better, residual), scale) in self.better.iter_mut().zip(residual).zip(&self.scale) {
                    *better = residual * scale;
                }
            }
        }
    }

    /// Steps of the Chebyshev iteration from zero \[Saad2003 alg. 12.1\].
    fn smooth(&mut self, system: &Poisson, residual: &[f32]) {
        let theta = 0.5 * (CHEBYSHEV_MOST + CHEBYSHEV_LEAST);
        let delta = 0.5 * (CHEBYSHEV_MOST - CHEBYSHEV_LEAST);
        let Self { better, carried: change, forward: image, scale, .. } = self;
        for unknown in 0..system.len() {
            change[unknown] = residual[unknown] * scale[unknown] / theta;
            better[unknown] = change[unknown];
        }
        let mut before = delta / theta;
        for _ in 1..CHEBYSHEV_STEPS {
            let rho = 1.0 / (2.0 * theta / delta - before);
            system.multiply(better, image);
            for unknown in 0..system.len() {
                let left = residual[unknown] - image[unknown];
                change[unknown] = rho * before * change[unknown] + 2.0 * rho / delta * scale[unknown] * left;
                better[unknown] += change[unknown];
            }
            before = rho;
        }
    }

    /// The two substitutions of MIC(0). Along x each unknown waits for the one before: what comes from there is added
    /// last, to what needs no waiting.
    fn substitute(&mut self, system: &Poisson, residual: &[f32]) {
        let zero = system.len();
        for (unknown, (lower, residual)) in system.lower.iter().zip(residual).enumerate() {
            let [x, y, z] = lower.map(|before| self.carried[before as usize]);
            let scale = self.scale[unknown];
            let value = residual + (y + z) + x;
            self.forward[unknown] = value * scale;
            self.carried[unknown] = value * (scale * scale);
        }
        for unknown in (0..zero).rev() {
            let [x, y, z] = system.upper[unknown].map(|behind| self.better[behind as usize]);
            let scale = self.scale[unknown];
            let ready = self.forward[unknown] * scale + (y + z) * (scale * scale);
            self.better[unknown] = ready + x * (scale * scale);
        }
    }
}

/// Sums and largest values that are found side by side: one alone waits for the one before at every number.
const SIDE_BY_SIDE: usize = 8;

fn largest(vector: &[f32]) -> f32 {
    let mut most = [0.0_f32; SIDE_BY_SIDE];
    let (whole, rest) = vector.as_chunks::<SIDE_BY_SIDE>();
    for numbers in whole {
        for (most, value) in most.iter_mut().zip(numbers) {
            *most = value.abs().max(*most);
        }
    }
    most.into_iter().chain(rest.iter().map(|value| value.abs())).fold(0.0, |most, value| value.max(most))
}

/// Sum of products in double precision.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    let mut sums = [0.0; SIDE_BY_SIDE];
    let ((whole, rest), (other, other_rest)) = (a.as_chunks::<SIDE_BY_SIDE>(), b.as_chunks::<SIDE_BY_SIDE>());
    for (a, b) in whole.iter().zip(other) {
        for index in 0..SIDE_BY_SIDE {
            sums[index] += f64::from(a[index] * b[index]);
        }
    }
    let rest = rest.iter().zip(other_rest).map(|(a, b)| f64::from(a * b));
    sums.into_iter().chain(rest).sum()
}

fn advance(vector: &mut [f32], step: f32, direction: &[f32]) {
    for (value, direction) in vector.iter_mut().zip(direction) {
        *value += step * direction;
    }
}
