//! A window plays what a film shows.

use glam::Vec3;
use strandline::{
    Camera, Change, Event, Live, Player, Scene,
    live::Command,
    scene::{CameraKeyframe, Interpolation, KeyframeSection, MotionName},
    settings::StrandMethod,
};

use super::helpers::{scene, settled, waking};

/// A short film at the rate of a window: hair that sags at first, on a head that turns fast.
fn film(time_step: f32) -> Scene {
    let mut scene = scene();
    scene.simulation.strands.method = StrandMethod::Constrain;
    scene.simulation.time_step = time_step;
    (scene.film.frames, scene.film.frames_per_second, scene.film.settle) = (6, 60.0, 0.3);
    scene.motion.name = MotionName::Keyframes;
    scene.motion.interpolation = Interpolation::Linear;
    let key =
        |time: f64, yaw: f32| KeyframeSection { time, rotation: Vec3::Y * yaw, ..KeyframeSection::default() };
    scene.motion.keyframes = vec![key(0.0, 0.0), key(0.06, 60.0), key(0.1, 0.0)];
    let view = |time: f64, turn: f32| CameraKeyframe { time, turn, ..CameraKeyframe::default() };
    scene.camera.keyframes = vec![view(0.0, 0.0), view(0.1, 70.0)];
    scene
}

#[test]
fn a_window_plays_what_a_film_shows() {
    for time_step in [1.0 / 60.0, 1.0 / 240.0] {
        let scene = film(time_step);
        let mut player = Player::new(&scene, scene.devices, true).unwrap();
        let mut drawn = None;
        for event in player.by_ref() {
            if let Event::Drawn { picture, .. } = event.unwrap() {
                drawn = Some(picture);
            }
        }
        let live = Live::new(scene.clone(), waking()).unwrap();
        live.send(Command::Play(false));
        live.wait_idle();
        live.send(Change::Reset);
        for _ in 0..scene.film.frames {
            live.send(Command::Step);
        }
        let shown = settled(&live).picture;
        let drawn = drawn.unwrap();
        let each = shown.pixels.iter().zip(&drawn.pixels).map(|(one, other)| f64::from(one.abs_diff(*other)));
        let apart = each.sum::<f64>() / drawn.pixels.len() as f64;
        // Times of a window are sums, so that last bits of the head differ.
        assert!(apart < 0.2, "{apart} of 255 apart with steps of {time_step} s");
    }
}

#[test]
fn a_view_that_is_moved_by_hand_leaves_the_keyframes_until_the_beginning() {
    let live = Live::new(film(1.0 / 60.0), waking()).unwrap();
    live.send(Command::Play(false));
    let step = |live: &Live| {
        live.send(Command::Step);
        live.send(Command::Step);
        settled(live)
    };
    let (first, second) = (step(&live), step(&live));
    assert!(first.follows_camera && second.camera != first.camera);
    let own = Camera::back();
    live.send(Change::Camera(own));
    let moved = step(&live);
    assert!(!moved.follows_camera && moved.camera == Some(own));
    live.send(Change::Reset);
    let again = settled(&live);
    assert!(again.follows_camera && again.camera != Some(own));
}
