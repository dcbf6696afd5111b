//! Hair far from the origin of the world is as exact as beside it.

#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::path::Path;

use glam::Vec3;
use strandline::{
    Backend, Cache, Devices, Event, Hair, OutSettings, Player, Pose, Ray, Scene,
    device::Gpu,
    scene::{ColliderSection, KeyframeSection, MotionName, SphereSection},
};

/// The origin, and places 2 and 10 km from it at which all keyframes below are exact in single precision.
const PLACES: [Vec3; 3] = [Vec3::ZERO, Vec3::new(1000.0, 0.0, -2000.0), Vec3::new(-7000.0, 512.0, 7071.0)];

/// Hair on a head that moves and turns beside a ball, all about a place.
fn scene(place: Vec3) -> Scene {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.body.spacing) = (24, 0.02);
    scene.simulation.volume.cells = [12; 3];
    scene.motion.name = MotionName::Keyframes;
    scene.motion.pivot = Some(Vec3::ZERO);
    let key = |time: f64, x: f32, degrees: f32| KeyframeSection {
        time,
        translation: place + Vec3::X * x,
        rotation: Vec3::Y * degrees,
        ..KeyframeSection::default()
    };
    scene.motion.keyframes = vec![key(0.0, 0.0, 0.0), key(0.25, 0.125, 40.0)];
    let ball = SphereSection {
        center: place + Vec3::new(0.25, -0.125, 0.0),
        radius: 0.125,
        ..SphereSection::default()
    };
    let ball = SphereSection { carrier: strandline::scene::CarrierName::World, ..ball };
    scene.colliders = vec![ColliderSection::Sphere(ball)];
    (scene.film.frames, scene.film.settle) = (5, 0.0);
    (scene.picture.width, scene.picture.height) = (64, 48);
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    scene.camera.position = Some(place + Vec3::new(0.0, 0.0, 0.75));
    scene.camera.target = Some(place);
    scene.lights = strandline::Look::brown().lights(Vec3::ZERO);
    scene.lights.truncate(1);
    scene.lights.iter_mut().for_each(|light| {
        (light.position, light.target) = (place + Vec3::new(0.5, 0.75, 1.0), place);
    });
    scene
}

/// The pictures of a film, and its cache.
fn film(scene: &Scene, devices: Devices, path: &Path) -> Vec<Vec<u8>> {
    let mut player = Player::new(scene, devices, true).unwrap();
    player.set_out(&OutSettings::new(path)).unwrap();
    let mut pictures = Vec::new();
    for event in player.by_ref() {
        if let Event::Drawn { picture, .. } = event.unwrap() {
            pictures.push(picture.pixels);
        }
    }
    player.close_out().unwrap();
    pictures
}

/// Films a number of frames at the origin and at other places, and compares them.
fn check(devices: &Devices, places: &[Vec3], frames: u32) {
    let folder = tempfile::tempdir().unwrap();
    let path = |index: usize| folder.path().join(format!("{index}.npz"));
    let film_at = |place: Vec3, path: &Path| {
        let mut scene = scene(place);
        scene.film.frames = frames;
        film(&scene, *devices, path)
    };
    let beside = film_at(Vec3::ZERO, &path(0));
    assert!(beside.len() == frames as usize && beside[0] != beside[beside.len() - 1], "the head moves");
    let mut near = Cache::open(&path(0)).unwrap();
    for (index, &place) in (1..).zip(places) {
        assert!(film_at(place, &path(index)) == beside, "the same pictures at {place}");
        let mut far = Cache::open(&path(index)).unwrap();
        let (mut own, mut other) = (Vec::new(), Vec::new());
        for frame in 0..frames as usize {
            near.read(frame, &mut own).unwrap();
            far.read(frame, &mut other).unwrap();
            // A file holds places of the world in single precision: half of its last place at 7 km, in two directions.
            let apart = own.iter().zip(&other).map(|(own, other)| (*other - place).distance(*own));
            assert!(apart.clone().all(|apart| apart < 5e-4), "{:?}", apart.fold(0.0, f32::max));
        }
    }
}

#[test]
fn a_film_far_from_the_origin_is_the_film_beside_it() {
    check(&Backend::Cpu.into(), &PLACES[1..], 5);
}

#[test]
#[allow(clippy::print_stderr)] // it tells what is not tested
fn so_it_is_on_a_gpu() {
    match Gpu::any() {
        // The farthest place alone: a software adapter takes 3 s of processors for a frame.
        Ok(_) => check(&Backend::Gpu(None).into(), &PLACES[2..], 3),
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
            eprintln!("not tested on a GPU: {error}");
        }
    }
}

#[test]
fn a_far_film_is_resumed_to_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, part] = ["whole.npz", "part.npz"].map(|name| folder.path().join(name));
    let far = scene(PLACES[2]);
    film(&far, Backend::Cpu.into(), &whole);
    let mut short = far.clone();
    short.film.frames = 2;
    film(&short, Backend::Cpu.into(), &part);
    let rest = folder.path().join("rest.npz");
    let mut player = Player::new(&far, Backend::Cpu, false).unwrap();
    player.set_out(&OutSettings::new(&rest)).unwrap();
    player.resume(&mut Cache::open(&part).unwrap()).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    player.close_out().unwrap();
    let (mut one, mut two) = (Cache::open(&whole).unwrap(), Cache::open(&rest).unwrap());
    let (mut own, mut other) = (Vec::new(), Vec::new());
    for frame in 0..5 {
        one.read(frame, &mut own).unwrap();
        two.read(frame, &mut other).unwrap();
        assert!(own == other, "frame {frame}");
    }
    // The same run about another place has other numbers in its state.
    let mut beside = Player::new(&scene(PLACES[1]), Backend::Cpu, false).unwrap();
    assert!(beside.resume(&mut Cache::open(&part).unwrap()).is_err());
}

#[test]
fn points_state_pose_and_hand_are_those_of_the_world() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let place = PLACES[1];
    let [mut near, mut far] = [Vec3::ZERO, place].map(|place| {
        Hair::from_prepared(strandline::Prepared::new(&scene(place)).unwrap(), Backend::Cpu).unwrap()
    });
    // Poses and the hand lie in steps of the single precision there.
    let pose = |place: Vec3, aside: f32| Pose {
        rotation: glam::Quat::from_rotation_y(4.0 * aside),
        translation: place + Vec3::X * aside,
    };
    let mut tip = None;
    for (hair, place) in [(&mut near, Vec3::ZERO), (&mut far, place)] {
        hair.step(0.1, pose(place, 0.0625)).unwrap();
        let points = hair.points().unwrap().to_vec();
        assert!(points.iter().all(|point| point.distance(place) < 1.0));
        let first = hair.state().unwrap().positions[0].get(0);
        assert!(first.distance(points[0]) < 1e-3, "{first} {}", points[0]);
        // A hand is in the world, and so is a line of sight.
        let tip = place + *tip.get_or_insert_with(|| (points[15] * 1024.0).round() / 1024.0);
        assert!(hair.grab(tip, 0.01).unwrap() > 0);
        hair.move_hand(tip + Vec3::X * 0.0625);
        hair.step(0.1, pose(place, 0.125)).unwrap();
        hair.release().unwrap();
        let ray = Ray { origin: place + Vec3::Z, direction: Vec3::NEG_Z };
        assert!(hair.pick(&ray, 1.0).unwrap().is_some_and(|point| point.distance(place) < 1.0));
    }
    let (one, two) = (near.points().unwrap().to_vec(), far.points().unwrap());
    // Points of the world at 2 km are rounded by 0.06 mm, in two directions.
    let apart = one.iter().zip(two).map(|(one, two)| (*two - place).distance(*one)).fold(0.0, f32::max);
    assert!(apart < 1e-4, "{apart}");
    far.save_pose(&path).unwrap();
    let mut posed = scene(place);
    posed.groom.pose = Some(path);
    let mut posed = Hair::from_prepared(strandline::Prepared::new(&posed).unwrap(), Backend::Cpu).unwrap();
    let saved = far.points().unwrap().to_vec();
    assert!(posed.points().unwrap().iter().zip(&saved).all(|(one, two)| one.distance(*two) < 3e-4));
}
