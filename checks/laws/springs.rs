//! Springs of each kind: the force on both ends, and the frequency at which a point swings on them.

use std::f32::consts::PI;

use glam::{DVec3, Vec3, vec3};
use strandline_body::Pose;
use strandline_checks::{On, Rig, law};
use strandline_groom::{Guides, Lanes, RestShape};
use strandline_sim::constrain::{Spring, Springs};
use strandline_sim::cpu::{Scratch, integrate::integrate};
use strandline_sim::gpu::{GpuRunner, Probe};
use strandline_sim::{Drive, Model, Settings, Stage};

use crate::strands::{bare, chain, first, one_strand};

/// Strides of the three kinds: from point i to i + 1, i + 2, i + 3.
const STRIDES: [usize; 3] = [1, 2, 3];

/// A helix: no distance is along another.
fn helix() -> Guides {
    let turn = |index: usize| index as f32 * 0.9;
    let points: Vec<Vec3> = (0..8)
        .map(|index| vec3(0.02 * turn(index).cos(), -0.01 * index as f32, 0.02 * turn(index).sin()))
        .collect();
    one_strand(&points)
}

/// Masses \[kg\], unequal: a force must not be taken for an acceleration.
fn mass(point: usize) -> f32 {
    1e-3 * (1.0 + point as f32 % 3.0)
}

/// Springs of one kind only, or of all.
fn only(kind: Option<usize>, spring: Spring) -> Springs {
    let [stretch, bend, torsion] =
        [0, 1, 2].map(|here| if kind.is_none_or(|kind| kind == here) { spring } else { Spring::OFF });
    Springs { stretch, bend, torsion }
}

/// Position \[m\] and velocity \[m/s\] of every point, away from rest.
fn moved(guides: &Guides) -> Vec<(Vec3, Vec3)> {
    (0..guides.points_per_strand())
        .map(|point| {
            let (phase, rest) = (point as f32 * 1.7, guides.position(0, point));
            (
                rest + 0.004 * vec3(phase.sin(), (2.0 * phase).cos(), phase.cos()),
                0.2 * vec3(phase.cos(), 0.3, phase.sin()),
            )
        })
        .collect()
}

/// Change of the velocities \[m/s\] in `integrate` if only springs act.
fn kicks(on: &On, settings: &Settings, rooted: usize) -> Vec<Vec3> {
    let guides = helix();
    let mut rest = RestShape::new(&guides, 1.0);
    rest.mass.iter_mut().enumerate().for_each(|(point, lanes)| *lanes = Lanes([mass(point); 8]));
    let model = Model::with_rest(&guides, rest, |_, point| point < rooted, settings, Vec::new()).unwrap();
    let mut state = model.rest_state(Pose::IDENTITY);
    let before = moved(&guides);
    for (point, (position, velocity)) in before.iter().enumerate() {
        state.positions[point].set(0, *position);
        state.velocities[point].set(0, *velocity);
    }
    match on {
        On::Cpu => {
            let mut scratch = Scratch::new(&model, &state);
            integrate(&model, &mut state, &mut scratch, Vec3::ZERO);
            state.velocities.iter().zip(&before).map(|(after, before)| after.get(0) - before.1).collect()
        }
        On::Gpu(gpu) => {
            let runner = GpuRunner::new(gpu, model).unwrap();
            let mut probe = Probe::new(&runner, &state).unwrap();
            probe.run(&Drive::default(), &[Stage::Integrate]).unwrap();
            let predicted = probe.predicted().unwrap();
            let ends = predicted.iter().map(|end| end.get(0));
            ends.zip(&before).map(|(end, (start, v))| (end - start) / settings.time_step - v).collect()
        }
    }
}

/// The same by the law of a damped spring [Chen2011 §4], pair by pair, in double precision.
fn expected_kicks(stride: usize, spring: Spring, time_step: f32) -> Vec<DVec3> {
    let guides = helix();
    let moved = moved(&guides);
    let rest = |point: usize| guides.position(0, point).as_dvec3();
    let mut kicks = vec![DVec3::ZERO; moved.len()];
    for lower in 0..moved.len() - stride {
        let upper = lower + stride;
        let across = (moved[upper].0 - moved[lower].0).as_dvec3();
        let parting = (moved[upper].1 - moved[lower].1).as_dvec3();
        let extension = across.length() - rest(upper).distance(rest(lower));
        let along = across.normalize();
        let force = f64::from(spring.stiffness) * extension + f64::from(spring.damping) * parting.dot(along);
        let impulse = along * force * f64::from(time_step);
        kicks[lower] += impulse / f64::from(mass(lower));
        kicks[upper] -= impulse / f64::from(mass(upper));
    }
    kicks
}

/// Largest difference over the largest kick.
fn off(found: &[Vec3], expected: &[DVec3]) -> f64 {
    let largest = expected.iter().map(|kick| kick.length()).fold(0.0, f64::max);
    let apart = found.iter().zip(expected).map(|(found, expected)| found.as_dvec3().distance(*expected));
    apart.fold(0.0, f64::max) / largest
}

/// Below the limit of a step, m / (12 dt^2) = 0.3 N/m and m / (12 dt) = 0.005 N s/m.
const ELASTIC: Spring = Spring { enabled: true, stiffness: 0.2, damping: 0.0 };
const DAMPED: Spring = Spring { enabled: true, stiffness: 0.0, damping: 0.004 };

law! {
    fn every_spring_pulls_with_its_stiffness_and_damping(on) {
        for spring in [ELASTIC, DAMPED] {
            let settings = |kind| Settings { gravity: Vec3::ZERO, ..bare(1.0 / 60.0, 1) }.with_constrain(|constrain| constrain.springs = only(kind, spring));
            let mut all = vec![DVec3::ZERO; 8];
            for (kind, stride) in STRIDES.into_iter().enumerate() {
                let expected = expected_kicks(stride, spring, 1.0 / 60.0);
                let off = off(&kicks(on, &settings(Some(kind)), 0), &expected);
                // A GPU tells the predicted place: 4e-9 m of rounding over a step, of kicks of 0.005 m/s and more.
                assert!(off < 1e-3, "from i to i + {stride}, {spring:?}: off by {off}");
                all.iter_mut().zip(expected).for_each(|(sum, kick)| *sum += kick);
            }
            let off = off(&kicks(on, &settings(None), 0), &all);
            assert!(off < 1e-3, "all together, {spring:?}: off by {off}");
        }
    }
}

law! {
    fn a_spring_leaves_rooted_points_alone_and_pulls_their_partners(on) {
        let settings =
            Settings { gravity: Vec3::ZERO, ..bare(1.0 / 60.0, 1) }.with_constrain(|constrain| constrain.springs = only(Some(2), ELASTIC));
        let expected = expected_kicks(3, ELASTIC, 1.0 / 60.0);
        let found = kicks(on, &settings, 3);
        // No further point is rooted: points 3 to 5 are pulled by the three that the head carries.
        let off = off(&found[3..], &expected[3..]);
        assert!(off < 1e-3, "off by {off}");
        let held = &kicks(on, &settings.with_constrain(|constrain| constrain.springs = Springs::OFF), 3)[3..];
        assert!(held.iter().all(|kick| kick.length() < 1e-5), "{held:?}");
    }
}

/// A corner of three rooted points and a fourth one that stands out of their plane, each `LENGTH` from the
/// one before: only bend (1 to 3) and torsion (0 to 3) can bring the fourth one back.
const LENGTH: f32 = 0.05;
const CORNER: [Vec3; 4] =
    [Vec3::ZERO, vec3(LENGTH, 0.0, 0.0), vec3(LENGTH, -LENGTH, 0.0), vec3(LENGTH, -LENGTH, LENGTH)];

/// Frequency \[Hz\] at which the fourth point swings after a push along `way`, by two passages through rest.
fn frequency(on: &On, springs: Springs, way: Vec3, time_step: f32) -> f32 {
    let settings = Settings { gravity: Vec3::ZERO, ..bare(time_step, 4) }
        .with_constrain(|constrain| constrain.springs = springs);
    let mut rig = Rig::new(on, chain(&CORNER, 1.0, |point| point < 3, &settings));
    let out = (Vec3::Z + 0.05 * way).normalize() * LENGTH;
    rig.change(|state| state.positions[3].set(0, CORNER[2] + out));
    let mut before = (out - Vec3::Z * LENGTH).dot(way);
    let mut crossings = Vec::new();
    for step in 0..2000 {
        rig.step(&Drive::default());
        let now = (first(rig.state())[3] - CORNER[3]).dot(way);
        if before.signum() != now.signum() {
            crossings.push((step as f32 + before / (before - now)) * time_step);
            if let [one, .., three] = crossings[..]
                && crossings.len() == 3
            {
                return 1.0 / (three - one);
            }
        }
        before = now;
    }
    panic!("it does not swing: {} passages", crossings.len());
}

law! {
    fn a_point_swings_on_its_bend_and_torsion_springs_at_their_frequency(on) {
        // A spring that meets the point's sphere at an angle acts with the part of its direction along the
        // sphere, squared: 1/2 for (1, 3), 2/3 for (0, 3).
        let ways = [vec3(0.0, -1.0, 0.0), vec3(1.0, -1.0, 0.0).normalize()];
        for (kind, part, way) in [(1, 0.5, ways[0]), (2, 2.0 / 3.0, ways[1])] {
            for wanted in [1.0_f32, 3.0] {
                let stiffness = (2.0 * PI * wanted).powi(2) / part;
                let springs = only(Some(kind), Spring { enabled: true, stiffness, damping: 0.0 });
                let found = frequency(on, springs, way, 1.0 / (150.0 * wanted));
                // The swing of 0.05 rad leaves the straight line by a square of that; 150 steps a period
                // shift the frequency by 1e-4.
                assert!((found / wanted - 1.0).abs() < 0.01, "kind {kind}: {found} Hz of {wanted}");
            }
        }
    }
}
