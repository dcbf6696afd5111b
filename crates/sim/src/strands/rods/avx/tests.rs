//! Bits and speed of rods by AVX instructions.

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
            load: Vector::zero(),
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

/// Gives some of the strands loads, and tells which.
fn load(pulls: &mut [Pull<f32x8>]) -> f32x8 {
    let loaded = f32x8::from([0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    for pull in pulls.iter_mut().filter(|pull| pull.one_sided) {
        let load = pull.stuck + pull.normal * f32x8::splat(5e-5);
        pull.load = Vector::choose(pull.stiffness & loaded.simd_gt(f32x8::ZERO), load, Vector::zero());
    }
    loaded
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
        let (rod, mut pulls, mut plain) = rods(seed, spoilt);
        let (_, mut fast_pulls, mut fast) = rods(seed, spoilt);
        plain.loaded = load(&mut pulls);
        avx.set_loaded(load(&mut fast_pulls));
        avx.work.tensions.fill(Eight::from(f32x8::of(-0.0)));
        let one = plain.solve(&rod, &mut pulls, &settings());
        let other = avx.solve(&mut fast, &rod, &mut fast_pulls, &settings());
        assert_eq!(bits(&[plain.loaded]), bits(&[avx.loaded()]), "{seed}");
        for (one, other) in pulls.iter().zip(&fast_pulls) {
            assert_eq!(bits(&one.load.array()), bits(&other.load.array()), "{seed}");
        }
        assert_eq!(one.steps, other.steps, "{seed}");
        let bits_of = |solved: &Solved<f32x8>| bits(&[solved.unsolved, solved.residual, solved.pressed]);
        assert_eq!(bits_of(&one), bits_of(&other), "{seed}");
        assert_eq!(bits(plain.moved.as_flattened()), bits(fast.moved.as_flattened()), "{seed}");
        for (one, other) in plain.segments.iter().zip(&fast.segments) {
            let bits_of = |segment: &Segment<f32x8>| {
                [segment.tangent.array(), segment.across.array(), [segment.length; 3]].map(|part| bits(&part))
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
        among_others.loaded = load(&mut pulls);
        let mut alone = among_others.clone();
        alone.loaded = alike(alone.loaded);
        steps.push(among_others.solve(&rod, &mut pulls.clone(), &settings).steps);
        rod.iter_mut().for_each(|node| *node = node.map(alike));
        for pull in &mut pulls {
            let (reach, stiffness, friction) = (pull.reach, pull.stiffness, pull.friction);
            (pull.reach, pull.stiffness, pull.friction) = (alike(reach), alike(stiffness), alike(friction));
            (pull.normal, pull.stuck) = (alike_vector(pull.normal), alike_vector(pull.stuck));
            pull.load = alike_vector(pull.load);
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
        steps.push(alone.solve(&rod, &mut pulls, &settings).steps);
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
    let (rod, mut pulls, begun) = rods(4, false);
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
    let plain = run(&mut |work| work.solve(&rod, &mut pulls.clone(), &settings()));
    let fast = run(&mut |work| avx.solve(work, &rod, &mut pulls, &settings()));
    assert!(fast < plain * 3, "{fast:?} against {plain:?}");
}
