//! Rods of eight strands by AVX instructions where the processor has them, whatever target the program was compiled for:
//! twice as fast, with the same bits.
#![allow(unsafe_code)] // see Eight

use std::arch::x86_64::{
    __m256, _CMP_GT_OQ, _mm256_add_ps, _mm256_blendv_ps, _mm256_cmp_ps, _mm256_div_ps, _mm256_max_ps,
    _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_set1_ps, _mm256_setzero_ps, _mm256_sqrt_ps,
    _mm256_sub_ps, _mm256_xor_ps,
};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use wide::f32x8;

use super::joint::Segment;
use super::pull::Pull;
use super::real::{Real, Vector};
use super::rod::{Node, Solved, StepSettings, Work};
use super::rounds::Push;

mod rounds;
#[cfg(test)]
mod tests;

/// Eight numbers in a register.
///
/// # Safety of its operations
/// A processor without AVX does not have these instructions. The type is private to this module, and every value of it
/// belongs to an [`Avx`], which is made only after the processor was asked: no operation runs elsewhere.
#[derive(Clone, Copy)]
struct Eight(__m256);

impl Eight {
    #[inline(always)]
    fn from(numbers: f32x8) -> Self {
        Self(bytemuck::cast(numbers.to_array()))
    }

    #[inline(always)]
    fn wide(self) -> f32x8 {
        let numbers: [f32; 8] = bytemuck::cast(self.0);
        f32x8::from(numbers)
    }

    /// All bits of the lanes that are above 0.
    #[inline(always)]
    fn positive(self) -> __m256 {
        // SAFETY: the processor has AVX, see the type.
        unsafe { _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, _mm256_setzero_ps()) }
    }
}

/// An operator of two numbers by its instruction.
macro_rules! operator {
    ($name:ident, $method:ident, $instruction:ident) => {
        impl $name for Eight {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the processor has AVX, see the type.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}

operator!(Add, add, _mm256_add_ps);
operator!(Sub, sub, _mm256_sub_ps);
operator!(Mul, mul, _mm256_mul_ps);
operator!(Div, div, _mm256_div_ps);

impl Neg for Eight {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the processor has AVX, see the type.
        Self(unsafe { _mm256_xor_ps(self.0, _mm256_set1_ps(-0.0)) })
    }
}

impl AddAssign for Eight {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Eight {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Eight {
    #[inline(always)]
    fn of(number: f64) -> Self {
        // SAFETY: the processor has AVX, see the type.
        Self(unsafe { _mm256_set1_ps(number as f32) })
    }

    #[inline(always)]
    fn root(self) -> Self {
        // SAFETY: the processor has AVX, see the type.
        Self(unsafe { _mm256_sqrt_ps(self.0) })
    }

    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        // SAFETY: the processor has AVX, see the type.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        // SAFETY: the processor has AVX, see the type.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn choose(self, yes: Self, no: Self) -> Self {
        // SAFETY: the processor has AVX, see the type.
        Self(unsafe { _mm256_blendv_ps(no.0, yes.0, self.positive()) })
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        // SAFETY: the processor has AVX, see the type.
        unsafe { _mm256_movemask_ps(self.positive()) != 0 }
    }
}

#[inline(always)]
fn taken(vector: Vector<f32x8>) -> Vector<Eight> {
    Vector::new(Eight::from(vector.x), Eight::from(vector.y), Eight::from(vector.z))
}

#[inline(always)]
fn given(vector: Vector<Eight>) -> Vector<f32x8> {
    Vector::new(vector.x.wide(), vector.y.wide(), vector.z.wide())
}

/// Scratch of eight strands on such a processor.
#[derive(Clone)]
pub(crate) struct Avx {
    work: Work<Eight>,
    rod: Vec<Node<Eight>>,
    pulls: Vec<Pull<Eight>>,
    pushes: Vec<Push<Eight>>,
    forces: Vec<Vector<Eight>>,
    /// Strands that solids pressed hard when the step began.
    was_loaded: Eight,
}

impl Avx {
    /// Scratch for rods of a number of points; `None` on a processor without AVX.
    pub(crate) fn new(points: usize) -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx").then(|| Self {
            work: Work::new(points),
            rod: Vec::with_capacity(points),
            pulls: Vec::with_capacity(4 * points),
            pushes: Vec::new(),
            forces: Vec::new(),
            was_loaded: Eight::from(f32x8::ZERO),
        })
    }

    /// As [`Work::solve`].
    pub(crate) fn solve(
        &mut self,
        work: &mut Work<f32x8>,
        rod: &[Node<f32x8>],
        pulls: &mut [Pull<f32x8>],
        settings: &StepSettings<f32x8>,
    ) -> Solved<f32x8> {
        // SAFETY: there is no Avx where the processor has no AVX.
        unsafe { self.solve_there(work, rod, pulls, settings) }
    }

    #[target_feature(enable = "avx")]
    fn solve_there(
        &mut self,
        work: &mut Work<f32x8>,
        rod: &[Node<f32x8>],
        pulls: &mut [Pull<f32x8>],
        settings: &StepSettings<f32x8>,
    ) -> Solved<f32x8> {
        self.take(work, rod, pulls);
        let StepSettings { time_step, newton_steps, tolerance, viscous } = *settings;
        let settings = StepSettings { time_step, newton_steps, tolerance, viscous: Eight::from(viscous) };
        let solved = self.work.solve(&self.rod, &mut self.pulls, &settings);
        self.give_loads(pulls);
        for (to, from) in work.moved.iter_mut().zip(&self.work.moved) {
            *to = from.map(Eight::wide);
        }
        for (to, from) in work.segments.iter_mut().zip(&self.work.segments) {
            let (length, tangent, across) = (from.length.wide(), given(from.tangent), given(from.across));
            *to = Segment { length, tangent, across };
        }
        Solved {
            steps: solved.steps,
            unsolved: solved.unsolved.wide(),
            residual: solved.residual.wide(),
            pressed: solved.pressed.wide(),
        }
    }

    /// Copies the loads, where a strand has or had any.
    #[inline(always)]
    fn give_loads(&self, pulls: &mut [Pull<f32x8>]) {
        if self.work.loaded.or_more(self.was_loaded).any_positive() {
            for (to, from) in pulls.iter_mut().zip(&self.pulls) {
                to.load = given(from.load);
            }
        }
    }

    /// Strands that solids press hard.
    pub(crate) fn loaded(&self) -> f32x8 {
        self.work.loaded.wide()
    }

    /// Sets them.
    pub(crate) fn set_loaded(&mut self, loaded: f32x8) {
        self.work.loaded = Eight::from(loaded);
        self.was_loaded = self.work.loaded;
    }

    /// Inputs of a step.
    #[target_feature(enable = "avx")]
    fn take(&mut self, work: &Work<f32x8>, rod: &[Node<f32x8>], pulls: &[Pull<f32x8>]) {
        let own = &mut self.work;
        for index in 0..rod.len() {
            own.moved[index] = work.moved[index].map(Eight::from);
            own.wanted[index] = work.wanted[index].map(Eight::from);
            own.air[index] = work.air[index].map(Eight::from);
            own.step[index] = work.step[index].map(Eight::from);
            own.edges[index] = taken(work.edges[index]);
            let Segment { length, tangent, across } = work.segments[index];
            own.segments[index] =
                Segment { length: Eight::from(length), tangent: taken(tangent), across: taken(across) };
        }
        self.rod.clear();
        self.rod.extend(rod.iter().map(|node| node.map(Eight::from)));
        self.pulls.clear();
        self.pulls.extend(pulls.iter().map(|pull| Pull {
            node: pull.node,
            normal: taken(pull.normal),
            reach: Eight::from(pull.reach),
            stiffness: Eight::from(pull.stiffness),
            one_sided: pull.one_sided,
            friction: Eight::from(pull.friction),
            stuck: taken(pull.stuck),
            load: taken(pull.load),
        }));
    }
}
