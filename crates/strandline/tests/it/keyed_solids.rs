//! Solids of `[[colliders]]` that move through keyframes.

#![allow(clippy::disallowed_methods)] // compared values may be rounded

use glam::{Vec3, vec3};
use strandline::{
    Backend, Groom, Hair, Pose, Prepared, Scene, Sources,
    scene::{CarrierName, ColliderSection, Interpolation, KeyframeSection, Model, MotionName, SphereSection},
};

const RADIUS: f32 = 0.05;
/// Place of the ball before and after its way \[m\], world space.
const WAY: [Vec3; 2] = [Vec3::new(0.0, -0.15, 0.2), Vec3::new(0.0, -0.15, 0.0)];
/// Displacement of the head \[m\].
const ASIDE: Vec3 = Vec3::new(1.0, 0.0, 0.0);

/// A curtain of hanging hair, and a ball that moves into it in half a second: of the world, or of the head.
fn scene(carrier: CarrierName, keyed: bool) -> Scene {
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.model) = (Some("hair".into()), Model::None);
    scene.groom.points_per_strand = 12;
    scene.motion.name = MotionName::Keyframes;
    scene.motion.pivot = Some(Vec3::ZERO);
    scene.motion.keyframes = vec![KeyframeSection { translation: ASIDE, ..KeyframeSection::default() }];
    let own = if carrier == CarrierName::World { ASIDE } else { Vec3::ZERO };
    let key = |time: f64, translation: Vec3| KeyframeSection { time, translation, ..Default::default() };
    let keyframes = if keyed { vec![key(0.0, Vec3::ZERO), key(0.5, WAY[1] - WAY[0])] } else { Vec::new() };
    let ball =
        SphereSection { center: own + WAY[0], radius: RADIUS, carrier, keyframes, ..Default::default() };
    scene.colliders = vec![ColliderSection::Sphere(ball)];
    (scene.film.settle, scene.film.frames) = (0.0, 30);
    scene
}

fn hair(scene: &Scene) -> Hair {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..24 {
        let root = vec3(0.004 * strand as f32 - 0.046, 0.0, 0.0);
        groom.push((0..12).map(|point| root + Vec3::NEG_Y * (0.02 * point as f32)));
    }
    let sources = Sources::default().with_groom("hair", groom);
    Hair::from_prepared(Prepared::from_sources(scene, &sources).unwrap(), Backend::Cpu).unwrap()
}

/// Place of the ball over its way, at a share of the time.
fn ball(hair: &Hair, time: f64) -> Vec3 {
    hair.head().frame(time).piece(1).translation
}

#[test]
fn a_ball_that_keyframes_move_pushes_hair_as_it_comes() {
    for carrier in [CarrierName::World, CarrierName::Head] {
        let mut keyed = hair(&scene(carrier, true));
        assert!(ball(&keyed, 0.0).distance(ASIDE + WAY[0]) < 1e-6, "{}", ball(&keyed, 0.0));
        for frame in 0..30 {
            keyed.play(frame).unwrap();
            let time = keyed.frame_time(frame);
            let middle = ball(&keyed, time);
            let depth = |point: &Vec3| RADIUS - point.distance(middle);
            let deepest = keyed.points().unwrap().iter().map(depth).fold(0.0, f32::max);
            assert!(deepest < 1e-3, "{deepest} m deep in frame {frame} beside {carrier:?}");
        }
        assert!(ball(&keyed, 1.0).distance(ASIDE + WAY[1]) < 1e-6);
        let pushed = keyed.points().unwrap().iter().map(|point| point.z.abs()).fold(0.0, f32::max);
        assert!(pushed > 0.8 * RADIUS, "pushed {pushed} m aside");
        // A ball that stays leaves it alone; in a loop of one's own keyframes move it as well.
        let mut still = hair(&scene(carrier, false));
        (0..30).for_each(|frame| drop(still.play(frame).unwrap()));
        assert!(still.points().unwrap().iter().all(|point| point.z.abs() < 1e-3));
        let mut own = hair(&scene(carrier, true));
        let pose = Pose { translation: ASIDE, ..Pose::IDENTITY };
        (0..30).for_each(|_| drop(own.step(1.0 / 30.0, pose).unwrap()));
        let same = own.points().unwrap().iter().map(|point| point.z.abs()).fold(0.0, f32::max);
        assert!(same > 0.8 * RADIUS, "pushed {same} m aside by a loop of one's own");
    }
}

#[test]
fn keyframes_of_a_solid_are_set_by_key_and_checked() {
    let mut scene = scene(CarrierName::World, true);
    scene.set("colliders[0].keyframes[1].time", "0.75").unwrap();
    let ColliderSection::Sphere(ball) = &scene.colliders[0] else { unreachable!("a ball") };
    assert_eq!(ball.keyframes[1].time, 0.75);
    let error = scene.set("colliders[0].keyframes[1].time", "-1").unwrap_err().to_string();
    assert!(error.contains("keyframe"), "{error}");
}

/// A head that turns by 40 degrees and moves by 0.3 m at once, less than any jump by itself, where a held pose ends.
#[test]
fn hair_is_carried_over_the_end_of_a_held_pose() {
    let played = |interpolation| {
        let mut scene = scene(CarrierName::World, false);
        scene.colliders.clear();
        let key =
            |time: f64| KeyframeSection { time, interpolation: Some(interpolation), ..Default::default() };
        let (rotation, translation) = (vec3(0.0, 40.0, 0.0), vec3(0.3, 0.0, 0.0));
        scene.motion.keyframes =
            vec![key(0.0), key(0.19), KeyframeSection { rotation, translation, ..key(0.2) }];
        let mut hair = hair(&scene);
        let speeds = (0..10).flat_map(|frame| hair.play(frame).unwrap()).map(|report| report.speed_max);
        let fastest = speeds.fold(0.0, f32::max);
        (fastest, hair.take_notes().join("\n"))
    };
    let (carried, notes) = played(Interpolation::Hold);
    assert!(notes.contains("and 40 degrees, as marked: hair is carried with it"), "{notes}");
    let (pulled, notes) = played(Interpolation::Linear);
    assert!(!notes.contains("jumps"), "{notes}");
    assert!(carried < 0.5 && pulled > 2.0, "carried at {carried} m/s, pulled at {pulled} m/s");
}
