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
use super::real::{Real, Vector};
use super::rod::{Node, Pull, Solved, StepSettings, Work};
use super::rounds::Push;

mod rounds;

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
        })
    }

    /// As [`Work::solve`].
    pub(crate) fn solve(
        &mut self,
        work: &mut Work<f32x8>,
        rod: &[Node<f32x8>],
        pulls: &[Pull<f32x8>],
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
        pulls: &[Pull<f32x8>],
        settings: &StepSettings<f32x8>,
    ) -> Solved<f32x8> {
        self.take(work, rod, pulls);
        let StepSettings { time_step, newton_steps, tolerance, viscous } = *settings;
        let settings = StepSettings { time_step, newton_steps, tolerance, viscous: Eight::from(viscous) };
        let solved = self.work.solve(&self.rod, &self.pulls, &settings);
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
        }));
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use strandline_body::Random;

    use super::*;

    const POINTS: usize = 16;

    /// Rods of any shape that fall, some onto planes; of one lane nothing is positive, of one a number is none.
    fn rods(seed: u64, spoilt: bool) -> (Vec<Node<f32x8>>, Vec<Pull<f32x8>>, Work<f32x8>) {
        let mut random = Random::new(seed, 0);
        let mut eight = |low: f32, high: f32| {
            f32x8::from(std::array::from_fn::<f32, 8, _>(|_| low + (high - low) * random.unit()))
        };
        let free = |held: usize, point| f32x8::splat(if point < held { 0.0 } else { 1.0 });
        let mut rod: Vec<_> = (0..POINTS)
            .map(|point| Node {
                mass: eight(1e-7, 3e-7),
                inertia: eight(1e-14, 3e-14),
                free: free(2, point),
                free_angle: free(1, point),
                length: eight(0.009, 0.011),
                stretch: eight(0.5, 2.0),
                stiffness: [eight(1e-9, 1e-7), eight(1e-9, 1e-7), eight(1e-9, 1e-7)],
                rest: [eight(-0.2, 0.2), eight(-0.2, 0.2), eight(-0.1, 0.1)],
            })
            .collect();
        if spoilt {
            let mut spoil = |point: usize, lane: usize, value: f32| {
                let mut numbers = rod[point].stiffness[0].to_array();
                numbers[lane] = value;
                rod[point].stiffness[0] = f32x8::from(numbers);
            };
            spoil(5, 3, -1.0);
            spoil(6, 6, f32::NAN);
        }
        let pulls = (4..POINTS)
            .step_by(3)
            .map(|node| Pull {
                node,
                normal: Vector::new(f32x8::ZERO, f32x8::ONE, f32x8::ZERO),
                reach: eight(-2e-3, 1e-3),
                stiffness: eight(0.0, 1.0),
                one_sided: node % 2 == 0,
                friction: eight(0.0, 1.0),
                stuck: Vector::new(eight(-1e-4, 1e-4), f32x8::ZERO, eight(-1e-4, 1e-4)),
            })
            .collect();
        let mut work = Work::new(POINTS);
        let edges: Vec<_> = (0..POINTS)
            .map(|_| Vector::new(eight(-0.004, 0.004), eight(-0.011, -0.008), eight(-0.004, 0.004)))
            .collect();
        work.begin(|index| edges[index], |_| Vector::new(f32x8::ONE, f32x8::ZERO, f32x8::splat(0.1)));
        for point in 0..POINTS {
            work.want(point, [eight(-1e-3, 1e-3), eight(-4e-3, 0.0), eight(-1e-3, 1e-3), f32x8::ZERO]);
        }
        (rod, pulls, work)
    }

    fn settings() -> StepSettings<f32x8> {
        StepSettings { time_step: 1.0 / 60.0, newton_steps: 4, tolerance: 1e-4, viscous: f32x8::of(0.12) }
    }

    #[test]
    fn bits_are_those_of_any_processor() {
        let Some(mut avx) = Avx::new(POINTS) else { return };
        let bits = |numbers: &[f32x8]| -> Vec<u32> {
            numbers.iter().flat_map(|number| number.to_array()).map(f32::to_bits).collect()
        };
        for seed in 0..40 {
            let spoilt = seed % 2 == 1;
            let (rod, pulls, mut plain) = rods(seed, spoilt);
            let (.., mut fast) = rods(seed, spoilt);
            let one = plain.solve(&rod, &pulls, &settings());
            let other = avx.solve(&mut fast, &rod, &pulls, &settings());
            assert_eq!(one.steps, other.steps, "{seed}");
            let bits_of = |solved: &Solved<f32x8>| bits(&[solved.unsolved, solved.residual, solved.pressed]);
            assert_eq!(bits_of(&one), bits_of(&other), "{seed}");
            assert_eq!(bits(plain.moved.as_flattened()), bits(fast.moved.as_flattened()), "{seed}");
            for (one, other) in plain.segments.iter().zip(&fast.segments) {
                let bits_of = |segment: &Segment<f32x8>| {
                    [segment.tangent.array(), segment.across.array(), [segment.length; 3]]
                        .map(|part| bits(&part))
                };
                assert_eq!(bits_of(one), bits_of(other), "{seed}");
            }
            assert_eq!(other.unsolved.simd_gt(f32x8::ZERO).any(), spoilt || one.steps == 4);
        }
    }

    /// A number of one lane, in all of them.
    fn alike(numbers: f32x8) -> f32x8 {
        f32x8::splat(numbers.to_array()[2])
    }

    fn alike_vector(vector: Vector<f32x8>) -> Vector<f32x8> {
        Vector::new(alike(vector.x), alike(vector.y), alike(vector.z))
    }

    #[test]
    fn a_strand_does_not_know_those_beside_it() {
        let settings = StepSettings { newton_steps: 40, tolerance: 1e-3, ..settings() };
        let mut steps = Vec::new();
        for seed in 0..40 {
            let (mut rod, mut pulls, mut among_others) = rods(seed, seed % 2 == 1);
            let mut alone = among_others.clone();
            steps.push(among_others.solve(&rod, &pulls, &settings).steps);
            rod.iter_mut().for_each(|node| *node = node.map(alike));
            for pull in &mut pulls {
                let (reach, stiffness, friction) = (pull.reach, pull.stiffness, pull.friction);
                (pull.reach, pull.stiffness, pull.friction) =
                    (alike(reach), alike(stiffness), alike(friction));
                (pull.normal, pull.stuck) = (alike_vector(pull.normal), alike_vector(pull.stuck));
            }
            for index in 0..POINTS {
                alone.moved[index] = alone.moved[index].map(alike);
                alone.wanted[index] = alone.wanted[index].map(alike);
                alone.step[index] = alone.step[index].map(alike);
                alone.edges[index] = alike_vector(alone.edges[index]);
                let Segment { length, tangent, across } = alone.segments[index];
                let (tangent, across) = (alike_vector(tangent), alike_vector(across));
                alone.segments[index] = Segment { length: alike(length), tangent, across };
            }
            steps.push(alone.solve(&rod, &pulls, &settings).steps);
            for (one, other) in alone.segments.iter().zip(&among_others.segments) {
                let bits = |vector: Vector<f32x8>| vector.array().map(|of| of.to_array()[2].to_bits());
                assert_eq!(bits(one.tangent), bits(other.tangent), "{seed}");
                assert_eq!(bits(one.across), bits(other.across), "{seed}");
            }
            for (one, other) in alone.moved.as_flattened().iter().zip(among_others.moved.as_flattened()) {
                assert_eq!(one.to_array()[2].to_bits(), other.to_array()[2].to_bits(), "{seed}");
            }
        }
        // Some wait for others.
        assert!(steps.chunks(2).any(|pair| pair[0] > pair[1]));
    }

    /// A function that is not inlined is called for every addition, which is ten times slower; a busy machine is not.
    #[test]
    fn it_is_inlined_whole() {
        let Some(mut avx) = Avx::new(POINTS) else { return };
        let (rod, pulls, begun) = rods(4, false);
        let run = |solve: &mut dyn FnMut(&mut Work<f32x8>) -> Solved<f32x8>| {
            let mut best = Duration::MAX;
            for _ in 0..200 {
                let mut work = begun.clone();
                let begin = Instant::now();
                std::hint::black_box(solve(&mut work));
                best = best.min(begin.elapsed());
            }
            best
        };
        let plain = run(&mut |work| work.solve(&rod, &pulls, &settings()));
        let fast = run(&mut |work| avx.solve(work, &rod, &pulls, &settings()));
        assert!(fast < plain * 3, "{fast:?} against {plain:?}");
    }
}
