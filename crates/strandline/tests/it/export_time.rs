//! Files of moving hair hold the hair and the head at the times that they say.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::path::Path;

use glam::Vec3;
use strandline::{
    Backend, Cache, OutSettings, Player, Prepared, Scene,
    scene::{Interpolation, KeyframeSection, MotionName},
};

/// Hair on a head that flies at 5 m/s and turns once a second.
fn scene(time_step: f32, frames_per_second: f32) -> Scene {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.body.spacing) = (16, 0.02);
    scene.simulation.time_step = time_step;
    scene.simulation.volume.enabled = false;
    scene.motion.name = MotionName::Keyframes;
    scene.motion.interpolation = Interpolation::Linear;
    let key = |time: f64| KeyframeSection {
        time,
        rotation: Vec3::new(0.0, 360.0 * time as f32, 0.0),
        translation: Vec3::new(5.0 * time as f32, 0.0, 0.0),
        ..KeyframeSection::default()
    };
    scene.motion.keyframes = vec![key(0.0), key(2.0)];
    scene.film.frames_per_second = frames_per_second;
    scene.film.frames = (0.8 * frames_per_second) as u32;
    scene.devices = Backend::Cpu.into();
    scene
}

fn write(scene: &Scene, path: &Path) {
    let mut player = Player::new(scene, Backend::Cpu, false).unwrap();
    player.set_out(&OutSettings::new(path)).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    player.close_out().unwrap();
}

#[test]
fn a_cache_holds_the_head_of_the_keys_and_roots_on_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    // Frames at ends of steps, between two steps, and several in one step.
    for (time_step, rate) in [(1.0 / 60.0, 30.0), (1.0 / 60.0, 24.0), (1.0 / 60.0, 25.0), (0.1, 60.0)] {
        let scene = scene(time_step, rate);
        let prepared = Prepared::new(&scene).unwrap();
        write(&scene, &path);
        let mut cache = Cache::open(&path).unwrap();
        let times = cache.times().to_vec();
        let mut points = Vec::new();
        for (frame, time) in times.into_iter().enumerate() {
            assert!((time - (frame + 1) as f64 / f64::from(rate)).abs() < 1e-12);
            let body = cache.read(frame, &mut points).unwrap();
            let (found, keys) = (body.world_from_head(), prepared.head.pose(time));
            let apart = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|at| found.point(at).distance(keys.point(at)));
            assert!(apart.iter().all(|apart| *apart < 1e-5), "{apart:?} m at {time} s, {rate}/s");
            for strand in 0..prepared.guides.strand_count() {
                let root = keys.point(prepared.guides.position(strand, 0));
                let apart = points[strand * prepared.guides.points_per_strand()].distance(root);
                // Single precision at 4 m, and a root that the solver places.
                assert!(apart < 5e-5, "{apart} m at {time} s, {rate}/s");
            }
        }
        std::fs::remove_file(&path).unwrap();
    }
}

#[test]
fn hair_between_two_steps_keeps_its_length() {
    // In the middle of a tenth of a second the head has turned by 18 degrees: a straight way would be a short cut.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let scene = scene(0.1, 20.0);
    write(&scene, &path);
    let guides = Prepared::new(&scene).unwrap().guides;
    let each = guides.points_per_strand();
    let mut cache = Cache::open(&path).unwrap();
    let mut points = Vec::new();
    cache.read(14, &mut points).unwrap();
    for strand in 0..guides.strand_count() {
        let found = points[strand * each].distance(points[strand * each + 1]);
        let rest = guides.position(strand, 0).distance(guides.position(strand, 1));
        // The first segment rides the head.
        assert!((found / rest - 1.0).abs() < 1e-3, "strand {strand}: {found} m of {rest} m");
    }
}

#[test]
fn time_codes_are_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.usda");
    let pivot = Prepared::new(&scene(1.0 / 60.0, 30.0)).unwrap().head.pivot();
    for rate in [24.0, 30.0] {
        write(&scene(1.0 / 60.0, rate), &path);
        let text = std::fs::read_to_string(&path).unwrap();
        let block = &text[text.find("xformOp:translate.timeSamples").unwrap()..];
        let samples = block.lines().skip(1).take_while(|line| line.contains(": ("));
        let mut count = 0;
        for line in samples {
            let (code, x) = line.split_once(": (").unwrap();
            let code: f64 = code.trim().parse().unwrap();
            let x: f64 = x.split(',').next().unwrap().parse().unwrap();
            // The pivot flies at 5 m/s; about it the head turns, which moves its origin.
            let turn = 360.0 * code / f64::from(rate);
            let (sin, cos) = turn.to_radians().sin_cos();
            let aside = f64::from(pivot.x) * (1.0 - cos) - f64::from(pivot.z) * sin;
            let expected = 5.0 * code / f64::from(rate) + aside;
            assert!((x - expected).abs() < 1e-4, "{x} m at code {code} of {rate}/s, expected {expected}");
            count += 1;
        }
        assert_eq!(count, (0.8 * rate) as usize);
        std::fs::remove_file(&path).unwrap();
    }
}
