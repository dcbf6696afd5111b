//! Time of films: exact numbers of steps, and the same motion however often it is looked at.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use glam::Vec3;
use strandline::{
    Backend, Change, Event, Live, Player, Pose, Scene,
    live::{Command, LiveEvent},
    low_level::{groom::Vec3Lanes, sim::State},
    scene::{MotionName, WindSection},
};

/// Hair in gusts on a head that shakes.
fn scene(time_step: f32, frames_per_second: f32, seconds: f32) -> Scene {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.body.spacing) = (24, 0.01);
    scene.simulation.time_step = time_step;
    scene.simulation.volume.cells = [8; 3];
    scene.motion.name = MotionName::Shake;
    scene.wind = WindSection {
        velocity: Vec3::new(4.0, 0.0, 1.0),
        gust: 0.9,
        gust_period: 0.4,
        ..WindSection::default()
    };
    scene.film.frames_per_second = frames_per_second;
    scene.film.frames = (seconds * frames_per_second).round() as u32;
    scene.film.settle = 0.05;
    scene
}

/// Plays a film without pictures: the steps that it reports, and the state at its end.
fn play(scene: &Scene, backend: Backend) -> (usize, State) {
    let mut player = Player::new(scene, backend, false).unwrap();
    let steps = player.by_ref().filter(|event| matches!(event.as_ref().unwrap(), Event::Stepped(_))).count();
    (steps, player.state().unwrap())
}

/// The largest distance \[m\] between two sets of positions.
fn apart(a: &[Vec3Lanes], b: &[Vec3Lanes]) -> f32 {
    let lanes = |pair: (&Vec3Lanes, &Vec3Lanes)| {
        (0..8).map(|lane| pair.0.get(lane).distance(pair.1.get(lane))).fold(0.0, f32::max)
    };
    a.iter().zip(b).map(lanes).fold(0.0, f32::max)
}

#[test]
fn the_frame_rate_does_not_change_a_bit_of_a_film() {
    for (time_step, steps) in [(1.0 / 60.0, 60), (1.0 / 240.0, 240), (1.0 / 960.0, 960)] {
        let (count, fine) = play(&scene(time_step, 60.0, 1.0), Backend::Cpu);
        assert_eq!(count, steps);
        for rate in [30.0, 10.0, 5.0] {
            let (count, found) = play(&scene(time_step, rate, 1.0), Backend::Cpu);
            assert_eq!(count, steps, "{time_step} s at {rate} frames/s");
            let apart = apart(&fine.positions, &found.positions);
            assert_eq!(fine.positions, found.positions, "{time_step} s at {rate} frames/s: {apart} m apart");
            assert_eq!(fine.velocities, found.velocities);
            assert_eq!(fine.body, found.body);
        }
    }
    let mut calm = scene(1.0 / 60.0, 30.0, 1.0);
    calm.wind.gust = 0.0;
    let gusty = play(&scene(1.0 / 60.0, 30.0, 1.0), Backend::Cpu).1;
    let apart = apart(&gusty.positions, &play(&calm, Backend::Cpu).1.positions);
    assert!(apart > 5e-3, "gusts are hardly noticed: {apart} m");
}

#[test]
fn the_frame_rate_does_not_change_a_bit_on_a_gpu_without_sums() {
    // Without the volume nothing is summed in an order of its own there.
    let film = |rate| {
        let mut scene = scene(1.0 / 960.0, rate, 0.2);
        scene.simulation.volume.enabled = false;
        scene
    };
    let gpu = Backend::Gpu(None);
    match Player::new(&film(10.0), gpu, false) {
        Ok(_) => {}
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
            #[allow(clippy::print_stderr)] // it tells what is not tested
            return eprintln!("not tested on a GPU: {error}");
        }
    }
    let ((fine_steps, fine), (steps, found)) = (play(&film(60.0), gpu), play(&film(5.0), gpu));
    assert_eq!((fine_steps, steps), (192, 192));
    assert_eq!(fine.positions, found.positions, "{} m", apart(&fine.positions, &found.positions));
}

#[test]
fn a_film_has_exactly_the_steps_of_its_time() {
    let cases = [
        (1.0 / 60.0, 30.0, 3.0, 180),
        (1.0 / 60.0, 24.0, 3.0, 180),
        (1e-3, 24.0, 1.0, 1000),
        (1.0 / 960.0, 30.0, 1.0, 960),
        (1.0 / 14.0, 30.0, 3.0, 42),
        (1.0 / 60.0, 1.0, 2.0, 120),
    ];
    for (time_step, rate, seconds, expected) in cases {
        let mut scene = scene(time_step, rate, seconds);
        scene.style.strand_count = 8;
        scene.simulation.volume.enabled = false;
        scene.film.settle = 0.0;
        let (steps, state) = play(&scene, Backend::Cpu);
        assert_eq!(steps, expected, "{time_step} s at {rate} frames/s");
        // The state adds up steps of single precision.
        assert!((state.time - f64::from(seconds)).abs() < 1e-6 * f64::from(seconds), "{} s", state.time);
    }
}

#[test]
fn a_head_with_few_steps_is_where_its_motion_has_it() {
    // Six pictures a step: the head is at the time of the last step, which reaches beyond the last picture.
    let mut slow = scene(0.1, 60.0, 0.55);
    slow.simulation.volume.enabled = false;
    let (steps, state) = play(&slow, Backend::Cpu);
    assert_eq!(steps, 6);
    let pivot = strandline::Prepared::new(&slow).unwrap().head.pivot();
    let expected = strandline::HeadMotion::new(&slow.motion, pivot).unwrap().pose(0.6);
    assert_eq!(state.body.world_from_head(), expected);
}

#[test]
fn a_frame_without_time_moves_nothing_but_the_head() {
    let scene = scene(1.0 / 60.0, 60.0, 1.0);
    let prepared = strandline::Prepared::new(&scene).unwrap();
    let mut hair = strandline::Hair::from_prepared(prepared, Backend::Cpu).unwrap();
    let turned = Pose { rotation: glam::Quat::from_rotation_y(0.01), ..Pose::IDENTITY };
    for seconds in [0.0, -1.0, f64::NAN] {
        assert!(hair.step(seconds, turned).unwrap().is_empty());
    }
    let reports = hair.step(1.0 / 60.0, turned).unwrap();
    assert_eq!((reports.len(), reports[0].non_finite), (1, 0));
    // On its way the head is interpolated, which rounds.
    let rotation = hair.state().unwrap().body.world_from_head().rotation;
    assert!(rotation.abs_diff_eq(turned.rotation, 1e-6), "{rotation}");
    let refused = hair.step(1e9, turned).unwrap_err().to_string();
    assert!(refused.contains("steps at once, expected no more than 1000000 steps"), "{refused}");
}

#[test]
fn hair_that_begins_in_a_pose_moves_alike_at_every_frame_rate() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("turned.npz");
    let film = |rate| {
        let mut scene = scene(1.0 / 120.0, rate, 0.4);
        // The first picture shows it as it is.
        scene.film.frames += 1;
        scene
    };
    let start = film(10.0);
    let prepared = strandline::Prepared::new(&start).unwrap();
    let mut hair = strandline::Hair::from_prepared(prepared, Backend::Cpu).unwrap();
    let turned = Pose { rotation: glam::Quat::from_rotation_y(0.2), ..Pose::IDENTITY };
    (0..20).for_each(|_| drop(hair.step(1.0 / 60.0, turned).unwrap()));
    hair.save_pose(&file).unwrap();
    let posed = |rate| {
        let mut scene = film(rate);
        scene.groom.pose = Some(file.clone());
        play(&scene, Backend::Cpu)
    };
    let ((fine_steps, fine), (steps, found)) = (posed(60.0), posed(5.0));
    assert_eq!((fine_steps, steps), (48, 48));
    assert_eq!(fine.positions, found.positions, "{} m", apart(&fine.positions, &found.positions));
    // By then the head is where the motion has it.
    assert_eq!(found.body, play(&scene(1.0 / 120.0, 5.0, 0.4), Backend::Cpu).1.body);
}

#[test]
fn a_window_with_very_short_steps_plays_the_frames_of_its_film() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slow.toml");
    let mut slow = scene(1e-4, 60.0, 1.0);
    (slow.picture.width, slow.picture.height) = (16, 16);
    slow.devices = Backend::Cpu.into();
    (slow.look.follow_strands, slow.look.hair_count) = (1, 0);
    let live = Live::new(slow.clone(), || ()).unwrap();
    live.send(Command::Play(false));
    live.wait_idle();
    live.send(Change::Reset);
    for _ in 0..5 {
        live.send(Command::Step);
    }
    live.send(Command::Save(Box::new(slow.clone()), 1, path.clone()));
    live.wait_idle();
    let events = live.take_events();
    assert!(events.iter().any(|event| matches!(event, LiveEvent::Saved(_))), "{events:?}");
    assert!(!events.iter().any(|event| matches!(event, LiveEvent::Error(..))), "{events:?}");
    drop(live);
    // Five frames, each of as many steps as it takes.
    let saved = Scene::load(&path).unwrap();
    assert!((saved.film.start - 5.0 / 60.0).abs() < 2e-4, "{} s", saved.film.start);
    let head = strandline::Prepared::new(&slow).unwrap().head;
    let prepared = strandline::Prepared::new(&saved).unwrap();
    let found = strandline::Hair::from_prepared(prepared, Backend::Cpu)
        .unwrap()
        .state()
        .unwrap()
        .body
        .world_from_head();
    let away = |time: f64| found.rotation.angle_between(head.pose(time).rotation);
    // Between the ends of a frame the head goes straight.
    assert!(away(saved.film.start) < 0.1 * away(0.0), "{} rad", away(saved.film.start));
}
