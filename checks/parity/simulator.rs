//! A simulator on a device: reports and checkpoints come by themselves, and a device may fail at any time.

use std::time::{Duration, Instant};

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::{gpu, own_gpu};
use strandline_groom::LANES;
use strandline_sim::rods::Rest;
use strandline_sim::{
    CpuRunner, Drive, Model, Preconditioner, Settings, Simulator, State, StepReport, StrandMethod,
};

use crate::heads::{Head, apart, drive, heads, rods};

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

/// A length of each strand over its rest length, another in each run.
fn scales(head: &Head, run: usize) -> Vec<f32> {
    (0..head.guides.strand_count()).map(|strand| 1.0 - 0.1 * ((strand + run) % 4) as f32).collect()
}

/// Settings, lengths and hands that change between the steps of a device change in the same place when these are computed
/// again.
#[test]
fn a_loss_after_changes_gives_what_comes_without_one() {
    for head in [heads().swap_remove(1), rods().swap_remove(3)] {
        let head = &head;
        let play = |gpu: Option<&strandline_gpu::Gpu>, failing: usize| {
            let mut simulator = Simulator::new(gpu, head.model()).unwrap();
            let tip = simulator.last_state().positions[head.model().points_per_strand() - 1].get(0);
            assert!(simulator.grab(tip, 0.01).unwrap() > 0);
            for (run, drives) in runs().enumerate() {
                let mut settings = simulator.model().settings().clone();
                settings.gravity.x = run as f32;
                settings.drag.factor = 1.0 + run as f32;
                simulator.set_settings(&settings).unwrap();
                simulator.set_length_scale(&scales(head, run)).unwrap();
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

/// Points slide along their strands on a device as on the host, to rounding, and the state that is read has the lengths.
#[test]
fn strands_take_other_lengths_on_a_device_as_on_the_host() {
    let Some(gpu) = own_gpu() else { return };
    for head in [heads().swap_remove(1), rods().swap_remove(3)] {
        let head = &head;
        let mut both = [None, Some(&gpu)].map(|gpu| Simulator::new(gpu, head.model()).unwrap());
        both[0].run(&[drive(1), drive(2)]).unwrap();
        let moved = both[0].state().unwrap().clone();
        both[1].set_state(moved.clone()).unwrap();
        for run in 1..=2 {
            let scales = scales(head, run);
            let waits = gpu.waits();
            both.iter_mut().for_each(|simulator| simulator.set_length_scale(&scales).unwrap());
            assert_eq!(gpu.waits(), waits, "{}", head.name);
            let [host, device] = both.each_mut().map(|simulator| simulator.state().unwrap());
            assert!(host.positions != moved.positions, "{}", head.name);
            for (host, device) in
                [(&host.positions, &device.positions), (&host.previous_positions, &device.previous_positions)]
            {
                // A few roundings of every segment, of coordinates below a metre.
                let distance = apart(host, device, &head.guides);
                assert!(distance < 2e-6, "{}: {distance}", head.name);
            }
            for (strand, scale) in scales.into_iter().enumerate() {
                assert_eq!([host, device].map(|state| state.length_scale(strand)), [scale; 2]);
            }
        }
        assert!(both[1].set_length_scale(&[3.0]).is_err());
    }
}

/// Sliders that are dragged while a film plays: no tick waits for the device, however many steps are on their way.
#[test]
fn no_tick_of_a_slider_waits_for_a_device_that_plays() {
    let Some(gpu) = own_gpu() else { return };
    let head = rods().swap_remove(0);
    let mut simulator = Simulator::new(Some(&gpu), head.model()).unwrap();
    simulator.run(&[drive(1)]).unwrap();
    simulator.state().unwrap();
    let (begin, frames, mut longest) = (Instant::now(), 24, Duration::ZERO);
    for frame in 0..frames {
        simulator.run(&[drive(2 + frame)]).unwrap();
        let mut settings = simulator.model().settings().clone();
        let share = frame as f32 / frames as f32;
        settings.gravity.y = -9.81 + share;
        settings.damping = share;
        settings.strands.rods.radius *= 1.001;
        settings.strands.rods.load = 0.5 * share;
        let (tick, waits) = (Instant::now(), gpu.waits());
        simulator.set_settings(&settings).unwrap();
        simulator.set_length_scale(&scales(&head, frame)).unwrap();
        longest = longest.max(tick.elapsed());
        assert_eq!(gpu.waits(), waits, "frame {frame}");
    }
    simulator.state().unwrap();
    let step = 1e3 * begin.elapsed().as_secs_f64() / frames as f64;
    let longest = 1e3 * longest.as_secs_f64();
    println!("{}: the longest tick took {longest:.1} ms, a step {step:.1} ms", gpu.adapter());
}

/// A setting that is a number of a step costs that number: no wait, no upload of a rest shape that stays.
#[test]
fn a_change_of_settings_waits_for_nothing_and_uploads_what_it_changes() {
    let Some(gpu) = own_gpu() else { return };
    let unstressed = |mut head: Head| {
        head.settings.strands.rods.rest = Rest::Unstressed;
        head
    };
    let few = 4096;
    let sagging = rods().swap_remove(0);
    let nodes = 4 * 10 * 304 * 16;
    for (head, gravity) in [
        (heads().swap_remove(0), 0..few),
        (unstressed(rods().swap_remove(0)), 0..few),
        (sagging, nodes..2 * nodes),
    ] {
        let mut simulator = Simulator::new(Some(&gpu), head.model()).unwrap();
        simulator.run(&[drive(1), drive(2)]).unwrap();
        simulator.state().unwrap();
        let mut cost = |change: &dyn Fn(&mut Settings)| {
            let (waits, crossed) = (gpu.waits(), gpu.crossed().to_device);
            let mut settings = simulator.model().settings().clone();
            change(&mut settings);
            simulator.set_settings(&settings).unwrap();
            simulator.run(&[drive(3)]).unwrap();
            assert_eq!(gpu.waits(), waits, "{}", head.name);
            gpu.crossed().to_device - crossed
        };
        let moved = cost(&|settings| settings.gravity.y = -3.0);
        assert!(gravity.contains(&moved), "{}: {moved} bytes for gravity", head.name);
        for change in [
            |settings: &mut Settings| settings.damping = 2.0,
            |settings: &mut Settings| settings.drag.factor = 2.0,
            |settings: &mut Settings| settings.volume.flip_share = 0.5,
            |settings: &mut Settings| settings.volume.preconditioner = Preconditioner::Jacobi,
            |settings: &mut Settings| settings.volume.enabled = false,
        ] {
            let moved = cost(&change);
            assert!(moved < few, "{}: {moved} bytes", head.name);
        }
    }
}

/// Most difference \[m\] after three steps on hardware. A software adapter gives the same bits. On an H200 the two part by
/// less than this; the cause is not known, and whether a run repeats its own bits there was not tried. Earlier gravity
/// alone would move hair by millimetres.
const ON_HARDWARE: f32 = 1e-5;

/// Settings that change between steps give the same hair as settings from the start, whatever a change uploads.
#[test]
fn a_runner_whose_settings_changed_steps_like_one_that_was_made_with_them() {
    let Some(gpu) = own_gpu() else { return };
    type Change = fn(&mut Settings);
    let changes: [Change; 6] = [
        |settings| settings.gravity = Vec3::new(3.0, -2.0, 0.0),
        |settings| settings.strands.rods.youngs_modulus *= 0.1,
        |settings| settings.strands.rods.damping = 0.05,
        |settings| settings.strands.rods.radius = 80.0,
        |settings| settings.strands.constrain.mass_per_length *= 3.0,
        |settings| settings.strands.method = StrandMethod::Constrain,
    ];
    let head = rods().swap_remove(3);
    let mut other = Settings { volume: head.settings.volume, ..head.settings.clone() };
    let mut simulator = Simulator::new(Some(&gpu), head.model()).unwrap();
    for change in changes {
        change(&mut other);
        simulator.set_settings(&other).unwrap();
        let fresh = Model::new(&head.guides, &other, head.colliders.clone()).unwrap();
        let state = fresh.rest_state(Pose::IDENTITY);
        simulator.set_state(state.clone()).unwrap();
        let mut expected = Simulator::new(Some(&gpu), fresh).unwrap();
        expected.set_state(state).unwrap();
        for step in 1..=3 {
            for simulator in [&mut simulator, &mut expected] {
                simulator.run(&[drive(step)]).unwrap();
            }
        }
        let [found, expected] =
            [&mut simulator, &mut expected].map(|one| one.state().unwrap().positions.clone());
        let most = apart(&found, &expected, &head.guides);
        assert!(most <= if gpu.adapter().software { 0.0 } else { ON_HARDWARE }, "{most} m");
    }
}

/// States of constrained strands have no sections: those of rods after them are read into states of their own.
#[test]
fn rods_after_constraints_are_read_like_rods() {
    let Some(gpu) = own_gpu() else { return };
    let head = rods().swap_remove(3);
    let mut simulator = Simulator::new(Some(&gpu), head.model()).unwrap();
    for method in [StrandMethod::Constrain, StrandMethod::Rods, StrandMethod::Constrain, StrandMethod::Rods] {
        let mut settings = simulator.model().settings().clone();
        settings.strands.method = method;
        simulator.set_settings(&settings).unwrap();
        for step in 1..=3 {
            simulator.run(&[drive(step)]).unwrap();
            let state = simulator.state().unwrap();
            let count = if method == StrandMethod::Rods { state.positions.len() } else { 0 };
            assert_eq!((state.sections.len(), state.spins.len()), (count, count), "{method:?}");
            assert!(state.positions.iter().all(|lanes| (0..LANES).all(|lane| lanes.get(lane).is_finite())));
        }
    }
}
