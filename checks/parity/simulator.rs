//! A simulator on a device: reports and checkpoints come by themselves, and a device may fail at any time.

use strandline_body::Pose;
use strandline_checks::{gpu, own_gpu};
use strandline_sim::{CpuRunner, Drive, Settings, Simulator, State, StepReport};

use crate::heads::{Head, drive, heads};

/// Steps of each run.
const RUNS: [usize; 6] = [2, 1, 3, 0, 4, 2];
const STEPS: usize = 12;

fn runs() -> impl Iterator<Item = Vec<Drive>> {
    let mut step = 0;
    RUNS.into_iter().map(move |count| {
        step += count;
        (step - count + 1..=step).map(drive).collect()
    })
}

fn simulator(head: &Head, gpu: &strandline_gpu::Gpu, checkpoint_every: u32) -> Simulator {
    let mut simulator = Simulator::new(Some(gpu), head.model()).unwrap();
    let settings = Settings { checkpoint_every, ..simulator.model().settings().clone() };
    simulator.set_settings(&settings).unwrap();
    simulator
}

/// Numbers that tell steps apart.
fn numbers(reports: &[StepReport]) -> Vec<[f32; 3]> {
    reports.iter().map(|report| [report.speed_mean, report.stretch_mean, report.stretch_max]).collect()
}

/// The states on the CPU after each step.
fn on_cpu(head: &Head) -> Vec<State> {
    let mut runner = CpuRunner::from(head.model());
    let mut state = head.model().rest_state(Pose::IDENTITY);
    let mut states = vec![state.clone()];
    for step in 1..=STEPS {
        runner.step(&mut state, &drive(step));
        states.push(state.clone());
    }
    states
}

#[test]
fn every_step_is_reported_once_and_in_order() {
    let Some(gpu) = gpu() else { return };
    let head = &heads()[0];
    let mut runner = head.gpu_runner(&gpu);
    (1..=STEPS).for_each(|step| runner.step(&drive(step)).unwrap());
    let expected = numbers(&runner.reports().unwrap());
    assert!(expected.windows(2).all(|pair| pair[0] != pair[1]), "steps cannot be distinguished");
    for checkpoint_every in [1, 3, 120] {
        let mut simulator = simulator(head, &gpu, checkpoint_every);
        let mut reports = Vec::new();
        for drives in runs() {
            reports.extend(simulator.run(&drives).unwrap());
        }
        reports.extend(simulator.reports().unwrap());
        assert_eq!(numbers(&reports), expected, "a checkpoint every {checkpoint_every}");
        assert!(simulator.reports().unwrap().is_empty());
        assert_eq!(simulator.steps(), STEPS as u64);
    }
}

#[test]
fn steps_are_not_waited_for() {
    let Some(gpu) = own_gpu() else { return };
    let mut simulator = simulator(&heads()[0], &gpu, 2);
    let before = gpu.waits();
    for drives in runs() {
        simulator.run(&drives).unwrap();
    }
    assert_eq!(gpu.waits(), before);
    simulator.state().unwrap();
    simulator.reports().unwrap();
    // Results that have arrived already are not waited for.
    assert!((before..=before + 2 + RUNS.len() as u64).contains(&gpu.waits()));
}

#[test]
fn a_device_may_fail_after_any_run() {
    let head = &heads()[0];
    let expected = on_cpu(head);
    for (failing, checkpoint_every) in (0..RUNS.len()).flat_map(|run| [(run, 1), (run, 120)]) {
        let Some(gpu) = own_gpu() else { return };
        let mut simulator = simulator(head, &gpu, checkpoint_every);
        let mut reports = Vec::new();
        for (run, drives) in runs().enumerate() {
            if run == failing {
                gpu.destroy();
            }
            let ran = simulator.run(&drives);
            reports.extend(
                ran.or_else(|failure| {
                    assert!(run >= failing && failure.gpu().is_some(), "{failure}");
                    simulator.fall_back();
                    simulator.run(&drives)
                })
                .unwrap(),
            );
        }
        reports.extend(simulator.reports().unwrap());
        assert_eq!(reports.len(), STEPS, "after run {failing}");
        let state = simulator.state().unwrap();
        assert_eq!(state.time, expected[STEPS].time);
        if checkpoint_every == 120 {
            assert_eq!(state.positions, expected[STEPS].positions, "all is made again");
        }
    }
}

/// Reading a state makes it the one to resume from: steps reported before it are not repeated.
#[test]
fn a_device_may_fail_after_its_state_was_read() {
    let (head, every) = (&heads()[0], 120);
    let read = |simulator: &mut Simulator| drop(simulator.state().unwrap().clone());
    let set = |simulator: &mut Simulator| {
        let settings = simulator.model().settings().clone();
        simulator.set_settings(&settings).unwrap();
    };
    let put = |simulator: &mut Simulator| simulator.change(|_, _| Ok(())).unwrap();
    for between in [read, set, put] as [fn(&mut Simulator); 3] {
        let Some(gpu) = own_gpu() else { return };
        let mut simulator = simulator(head, &gpu, every);
        let mut reports = Vec::new();
        for drives in runs() {
            reports.extend(simulator.run(&drives).unwrap());
        }
        between(&mut simulator);
        gpu.destroy();
        simulator.fall_back();
        reports.extend(simulator.reports().unwrap());
        assert_eq!(reports.len(), STEPS);
        assert_eq!(simulator.steps(), STEPS as u64);
    }
}

#[test]
fn a_state_of_the_last_runs_is_computed_again_when_the_device_fails() {
    let head = &heads()[0];
    let expected = on_cpu(head);
    for step in [3, 6, 10] {
        let Some(gpu) = own_gpu() else { return };
        let mut simulator = simulator(head, &gpu, 120);
        runs().for_each(|drives| drop(simulator.run(&drives).unwrap()));
        gpu.destroy();
        for _ in 0..2 {
            let found = simulator.state_after(step).positions.clone();
            assert_eq!(found, expected[step as usize].positions);
            simulator.fall_back();
        }
        assert_eq!(simulator.state().unwrap().positions, expected[STEPS].positions);
    }
    // A state that was read meanwhile does not hide those of the run before.
    let Some(gpu) = own_gpu() else { return };
    let mut simulator = simulator(head, &gpu, 120);
    for drives in runs() {
        simulator.run(&drives).unwrap();
        simulator.state().unwrap();
    }
    gpu.destroy();
    assert_eq!(simulator.state_after(STEPS as u64 - 1).time, expected[STEPS - 1].time);
    simulator.fall_back();
    // The CPU's next steps keep the state of a picture under way.
    let left = simulator.state().unwrap().positions.clone();
    simulator.run(&[drive(STEPS + 1)]).unwrap();
    assert_eq!(simulator.state_after(STEPS as u64).positions, left);
    assert_ne!(simulator.state().unwrap().positions, left);
}

/// Settings and hands that change between the steps of a device change in the same place when these are computed again.
#[test]
fn a_loss_after_changes_gives_what_comes_without_one() {
    for head in &heads() {
        let play = |gpu: Option<&strandline_gpu::Gpu>, failing: usize| {
            let mut simulator = Simulator::new(gpu, head.model()).unwrap();
            let tip = simulator.last_state().positions[head.model().points_per_strand() - 1].get(0);
            assert!(simulator.grab(tip, 0.01).unwrap() > 0);
            for (run, drives) in runs().enumerate() {
                let mut settings = simulator.model().settings().clone();
                settings.gravity.x = run as f32;
                settings.drag.across = 1.0 + run as f32;
                simulator.set_settings(&settings).unwrap();
                if run == failing {
                    gpu.inspect(|gpu| gpu.destroy());
                    simulator.fall_back();
                }
                simulator.run(&drives).unwrap();
                if run == 2 {
                    simulator.release().unwrap();
                }
                assert_eq!(simulator.grabbed() > 0, run < 2);
            }
            simulator.state().unwrap().positions.clone()
        };
        let expected = play(None, RUNS.len());
        assert_ne!(expected, on_cpu(head)[STEPS].positions, "the changes matter");
        for failing in [2, 5] {
            let Some(gpu) = own_gpu() else { return };
            assert!(play(Some(&gpu), failing) == expected, "a loss in run {failing}");
        }
    }
}
