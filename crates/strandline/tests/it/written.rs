//! Files of moving hair, written from a loop of one's own.

use strandline::{Backend, Cache, Hair, OutSettings, Player, Pose, Scene, What};

fn scene() -> Scene {
    let mut scene = Scene::parse("style.strand_count = 11\nbody.spacing = 0.02", "scene").unwrap();
    (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, Backend::Cpu);
    (scene.film.frames, scene.film.settle) = (4, 0.0);
    scene
}

fn head(frame: u32) -> Pose {
    Pose { rotation: strandline::math::rotation(glam::Vec3::Y, 0.1 * frame as f32), ..Pose::IDENTITY }
}

fn points(cache: &mut Cache, frame: usize) -> Vec<glam::Vec3> {
    let mut points = Vec::new();
    cache.read(frame, &mut points).unwrap();
    points
}

#[test]
fn a_loop_writes_its_own_poses_and_resumes_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| OutSettings::new(folder.path().join(name));
    let mut hair = Hair::open(&scene()).unwrap();
    let (mut whole, mut half) = (hair.begin_file(&at("whole.npz")).unwrap(), None);
    let mut shown = Vec::new();
    for frame in 0..4 {
        hair.step(1.0 / 60.0, head(frame)).unwrap();
        shown.push(hair.points().unwrap().to_vec());
        hair.write(&mut whole).unwrap();
        if frame == 0 {
            let error = hair.write(&mut whole).unwrap_err().to_string();
            assert!(error.contains("more than 0.016"), "{error}");
        }
        if frame == 1 {
            let mut out = Hair::open(&scene()).unwrap();
            let mut file = out.begin_file(&at("half.npz")).unwrap();
            for frame in 0..2 {
                out.step(1.0 / 60.0, head(frame)).unwrap();
                out.write(&mut file).unwrap();
            }
            half = Some(out.end_file(file).unwrap());
        }
    }
    let error = hair.write(&mut whole).unwrap_err().to_string();
    assert!(error.contains("film.frames is 4"), "{error}");
    assert_eq!(hair.end_file(whole).unwrap().frames, 4);
    let mut cache = Cache::open(&folder.path().join("whole.npz")).unwrap();
    assert_eq!((cache.len(), cache.what()), (4, What::Guides));
    for (frame, shown) in shown.iter().enumerate() {
        assert_eq!(&points(&mut cache, frame), shown, "frame {frame}");
    }
    assert_eq!(half.unwrap().frames, 2);
    let mut resumed = Hair::open(&scene()).unwrap();
    let made = resumed.resume(&mut Cache::open(&folder.path().join("half.npz")).unwrap(), None).unwrap();
    assert_eq!(made, 2);
    for frame in made..4 {
        resumed.step(1.0 / 60.0, head(frame)).unwrap();
    }
    assert_eq!(resumed.points().unwrap(), &shown[3][..]);
}

#[test]
fn points_are_those_that_a_player_writes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.npz");
    let scene = scene();
    let mut player = Player::new(&scene, Backend::Cpu, false).unwrap();
    player.set_out(&OutSettings::new(&path)).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    player.close_out().unwrap();
    let mut cache = Cache::open(&path).unwrap();
    let mut hair = Hair::open(&scene).unwrap();
    let motion = hair.head().clone();
    // One run to each frame's end, as the player makes it: drives are asked for at the ends of steps.
    let frame = 1.0 / f64::from(scene.film.frames_per_second);
    hair.step_along(frame, |share| motion.pose(frame * f64::from(share))).unwrap();
    let (found, expected) = (hair.points().unwrap(), points(&mut cache, 0));
    let apart = found.iter().zip(&expected).map(|(one, two)| one.distance(*two)).fold(0.0, f32::max);
    // A share of a run is rounded to 32 bits.
    assert!(found.len() == expected.len() && apart < 1e-6, "{apart} m");
}
