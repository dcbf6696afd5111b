//! The stages that work on strands.

use strandline_checks::gpu;
use strandline_sim::cpu::{
    Scratch, advance::advance, constrain::constrain, integrate::integrate, pose_roots::pose_roots,
};
use strandline_sim::gpu::{LengthsForm, LengthsInput, Probe, lengths_alone};
use strandline_sim::{Model, Stage};

use crate::heads::{Head, Moving, apart, drive, heads, mean_apart, obstacles};

/// Rounding of positions of some decimetres \[m\], over a few operations.
const PLACE: f32 = 1e-6;
/// Runs the stages before `last` on the CPU, then `last` on both.
fn both(head: &Head, last: Stage, compare: impl Fn(&Model, &Moving, &Probe)) {
    both_from(head, last, |_, _| (), compare);
}

/// The same from a state that is changed before.
fn both_from(
    head: &Head,
    last: Stage,
    change: impl Fn(&Model, &mut Moving),
    compare: impl Fn(&Model, &Moving, &Probe),
) {
    let Some(gpu) = gpu() else { return };
    let model = head.model();
    let mut state = head.moving(&model);
    change(&model, &mut state);
    state.scratch = Scratch::new(&model, &state);
    let drive = drive(6);
    let gpu_runner = head.gpu_runner(&gpu);
    for stage in [Stage::PoseRoots, Stage::Integrate, Stage::Constrain] {
        let probe = (stage == last).then(|| {
            let mut probe = state.probe(&gpu_runner);
            probe.run(&drive, &[stage]).unwrap();
            probe
        });
        let obstacles = obstacles(&model, &state);
        match stage {
            Stage::PoseRoots => {
                state.run(|state, scratch| pose_roots(&model, state, scratch, &drive.body));
            }
            Stage::Integrate => state.run(|state, scratch| integrate(&model, state, scratch, drive.wind)),
            _ => {
                let bad = state.run(|state, scratch| constrain(&model, state, scratch, &obstacles));
                assert_eq!(bad.count, 0);
            }
        }
        if let Some(probe) = probe {
            return compare(&model, &state, &probe);
        }
    }
}

#[test]
fn pose_roots_agrees() {
    for head in heads() {
        both(&head, Stage::PoseRoots, |_, state, probe| {
            assert!(
                apart(state.predicted(), &probe.predicted().unwrap(), &head.guides) < PLACE,
                "{}",
                head.name
            );
            let speed = apart(&state.velocities, &probe.velocities().unwrap(), &head.guides);
            // The same over the length of a step.
            assert!(speed < PLACE / head.settings.time_step, "{}: {speed}", head.name);
        });
    }
}

#[test]
fn integrate_agrees() {
    for head in heads() {
        both(&head, Stage::Integrate, |_, state, probe| {
            let distance = apart(state.predicted(), &probe.predicted().unwrap(), &head.guides);
            assert!(distance < PLACE, "{}: {distance}", head.name);
        });
    }
}

#[test]
fn constrain_agrees() {
    for head in heads() {
        both(&head, Stage::Constrain, |_, state, probe| {
            let distance = apart(state.predicted(), &probe.predicted().unwrap(), &head.guides);
            let speed = apart(&state.velocities, &probe.velocities().unwrap(), &head.guides);
            // Rounding grows over 20 rounds along up to 63 segments; in the edge where two solids meet it may
            // choose the other one, which is as near.
            let limit = if head.colliders.len() > 1 { 50.0 } else { 20.0 } * PLACE;
            assert!(distance < limit, "{}: {distance}", head.name);
            assert!(speed < limit / head.settings.time_step, "{}: {speed}", head.name);
            let correction = apart(&state.corrections, &probe.corrections().unwrap(), &head.guides);
            assert!(correction < limit / head.settings.time_step, "{}: {correction}", head.name);
            let mean = mean_apart(state.predicted(), &probe.predicted().unwrap(), &head.guides);
            assert!(mean < PLACE, "{}: {mean}", head.name);
        });
    }
}

#[test]
fn constrain_agrees_without_solids_to_rounding() {
    for mut head in heads() {
        head.colliders.clear();
        both(&head, Stage::Constrain, |_, state, probe| {
            let distance = apart(state.predicted(), &probe.predicted().unwrap(), &head.guides);
            assert!(distance < 20.0 * PLACE, "{}: {distance}", head.name);
        });
    }
}

#[test]
fn constrain_agrees_on_hair_in_a_hand() {
    for mut head in heads() {
        head.colliders.clear();
        let last = head.guides.points_per_strand() - 1;
        let grab = |model: &Model, state: &mut Moving| {
            let tip = state.positions[last].get(0);
            assert!(state.grab(model, tip, 0.03) > 0);
        };
        both_from(&head, Stage::Constrain, grab, |_, state, probe| {
            let found = probe.predicted().unwrap();
            let distance = apart(state.predicted(), &found, &head.guides);
            // Rounding grows over the 32 turns between hand and head.
            assert!(distance < 50.0 * PLACE, "{}: {distance}", head.name);
        });
    }
}

#[test]
fn advance_measures_the_same() {
    let Some(gpu) = gpu() else { return };
    for head in heads() {
        let model = head.model();
        let gpu_runner = head.gpu_runner(&gpu);
        let mut state = head.moving(&model);
        let drive = drive(6);
        let obstacles = obstacles(&model, &state);
        state.run(|state, scratch| pose_roots(&model, state, scratch, &drive.body));
        state.run(|state, scratch| integrate(&model, state, scratch, drive.wind));
        // Not constrained: stretched strands, some inside the solids.
        let mut probe = state.probe(&gpu_runner);
        probe.run(&drive, &[Stage::Advance]).unwrap();
        let expected = state.run(|state, scratch| advance(&model, state, scratch, &obstacles));
        let found = probe.report().unwrap();
        let name = head.name;
        assert!(expected.stretch_max > 1e-4, "{name}: nothing to measure");
        assert!((found.stretch_max - expected.stretch_max).abs() < 1e-5, "{name}: {found:?}, {expected:?}");
        assert!((found.stretch_mean - expected.stretch_mean()).abs() < 1e-6, "{name}: {found:?}");
        assert!((found.penetration_max - expected.penetration_max).abs() < 1e-5, "{name}: {found:?}");
        assert_eq!(found.non_finite, 0);
    }
}

#[test]
fn a_bad_strand_goes_back_to_rest_and_is_counted() {
    let Some(gpu) = gpu() else { return };
    let head = &heads()[0];
    let model = head.model();
    let mut runner = head.gpu_runner(&gpu);
    let mut state = head.moving(&model);
    let sound = state.clone();
    state.velocities[5].set(3, glam::Vec3::new(f32::NAN, 0.0, 0.0));
    state.positions[40].set(1, glam::Vec3::new(0.0, f32::INFINITY, 0.0));
    runner.write(&state).unwrap();
    runner.step(&drive(6)).unwrap();
    let (found, reports) = (runner.state().unwrap(), runner.reports().unwrap());
    assert!(reports[0].non_finite >= 2, "{reports:?}");
    runner.write(&sound).unwrap();
    runner.step(&drive(6)).unwrap();
    let other = runner.state().unwrap();
    let rest = model.rest_state(drive(6).body);
    for (index, lanes) in found.positions.iter().enumerate() {
        for lane in 0..8 {
            let bad = (index / 16, lane) == (0, 3) || (index / 16, lane) == (2, 1);
            let expected = if bad { &rest } else { &other }.positions[index].get(lane);
            // The others feel the bad one through the volume only.
            let limit = if bad { 1e-6 } else { 2e-3 };
            assert!((lanes.get(lane) - expected).length() < limit, "point {index}, lane {lane}");
        }
    }
}

/// Strands that are stretched this way and that, their first point held: points with inverse masses, and lengths.
fn stretched(strands: usize, count: usize) -> (Vec<[f32; 4]>, Vec<f32>) {
    let noise = |index: usize, salt: f32| 0.004 * (index as f32 * 12.9898 + salt).sin();
    let points = (0..strands * count).map(|index| {
        let [strand, point] = [index / count, index % count].map(|number| number as f32);
        let inverse_mass = if point == 0.0 { 0.0 } else { 1e6 * (1.0 + point) };
        [
            0.01 * strand + noise(index, 1.0),
            -0.012 * point + noise(index, 2.0),
            noise(index, 3.0),
            inverse_mass,
        ]
    });
    (points.collect(), vec![0.01; strands * count])
}

/// The same rounds in plain Rust [Chen2011 eq. 1-2, fig. 15-16].
fn projected(points: &[[f32; 4]], lengths: &[f32], count: usize, rounds: u32) -> Vec<[f32; 4]> {
    let mut points = points.to_vec();
    for strand in points.chunks_mut(count) {
        for first in (0..rounds).flat_map(|_| [0, 1]) {
            for point in (first..count - 1).step_by(2) {
                let [start, end] = [strand[point], strand[point + 1]];
                let across = glam::Vec3::from_slice(&end) - glam::Vec3::from_slice(&start);
                let correction =
                    across * ((across.length() - lengths[point]) / (across.length() * (start[3] + end[3])));
                for axis in 0..3 {
                    strand[point][axis] += correction[axis] * start[3];
                    strand[point + 1][axis] -= correction[axis] * end[3];
                }
            }
        }
    }
    points
}

#[test]
fn constrain_projects_lengths_alone_alike_with_a_thread_for_a_strand_and_for_a_point() {
    let Some(gpu) = gpu() else { return };
    // More strands than a workgroup holds, and no multiple of it; an odd number of points.
    for (strands, count) in [(150, 6), (70, 16), (19, 63)] {
        let (points, lengths) = stretched(strands, count);
        let input = LengthsInput { points: &points, lengths: &lengths, points_per_strand: count, rounds: 20 };
        let expected = projected(&points, &lengths, count, 20);
        let off = |found: &[[f32; 4]]| {
            let pairs = found.iter().flatten().zip(expected.iter().flatten());
            pairs.fold(0.0, |most: f32, (one, other)| most.max((one - other).abs() / other.abs().max(1.0)))
        };
        for form in [LengthsForm::Strand, LengthsForm::Point] {
            let (found, seconds) = lengths_alone(&gpu, &input, form, 2).unwrap();
            assert!(off(&found) < 20.0 * PLACE, "{form:?}, {count} points: {}", off(&found));
            assert!(seconds.is_none_or(|seconds| seconds > 0.0 && seconds < 1.0), "{form:?}: {seconds:?}");
            let (fewer, _) = lengths_alone(&gpu, &LengthsInput { rounds: 19, ..input }, form, 1).unwrap();
            assert!(off(&fewer) > 20.0 * PLACE, "{form:?}: a round less is not seen");
        }
    }
}
