//! Two workers: the same film as one after the other, and changes in the middle of it.

use strandline::{Backend, Camera, Event, Picture, Player, Scene, scene::MotionName};

fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.groom.bound = Some(0);
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.motion.name = MotionName::Shake;
    scene.film.frames = 12;
    scene.film.settle = 0.05;
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    (scene.picture.width, scene.picture.height) = (64, 48);
    scene
}

fn player(overlap: bool) -> Player {
    let mut player = Player::new(&scene(), Backend::Cpu, true).unwrap();
    player.set_overlap(overlap);
    player
}

/// Number and picture, where the event is one.
fn drawn(event: Event) -> Option<(u32, Picture)> {
    match event {
        Event::Drawn { frame, picture, .. } => Some((frame, picture)),
        _ => None,
    }
}

fn pictures(player: &mut Player) -> Vec<(u32, Picture)> {
    player.filter_map(|event| drawn(event.unwrap())).collect()
}

#[test]
fn a_film_is_the_same_to_the_bit_with_one_worker_and_with_two() {
    let (one, two) = (pictures(&mut player(false)), pictures(&mut player(true)));
    assert_eq!(one.len(), 12);
    assert!(one.iter().enumerate().all(|(index, (frame, _))| *frame == index as u32));
    assert!(one == two);
    assert!(one[11].1 != one[0].1, "nothing moved");
}

#[test]
fn a_change_of_settings_shows_within_two_frames_and_not_before() {
    let mut changed = player(true);
    let mut plain = pictures(&mut player(true)).into_iter();
    let mut different = None;
    while let Some(event) = changed.next() {
        let Some((frame, picture)) = drawn(event.unwrap()) else { continue };
        if frame == 3 {
            let mut settings = scene().simulation;
            settings.gravity = glam::Vec3::new(0.0, 200.0, 0.0);
            changed.set_settings(settings);
        }
        if plain.next().unwrap() != (frame, picture) {
            different = different.or(Some(frame));
        }
    }
    // Frame 4 is on its way when the change is asked for.
    assert_eq!(different, Some(5));
}

#[test]
fn a_look_and_a_view_show_in_the_next_picture() {
    let mut changed = player(true);
    let mut plain = pictures(&mut player(true)).into_iter();
    let mut different = Vec::new();
    while let Some(event) = changed.next() {
        let Some((frame, picture)) = drawn(event.unwrap()) else { continue };
        match frame {
            2 => changed.set_look(strandline::Look { follow_strands: 2, ..scene().look }),
            5 => changed.set_camera(Camera::back()),
            _ => {}
        }
        if plain.next().unwrap().1 != picture {
            different.push(frame);
        }
    }
    assert_eq!(different, (3..12).collect::<Vec<u32>>());
}

#[test]
fn a_wrong_setting_ends_the_film_with_its_error_and_the_last_state_stays() {
    let mut player = player(true);
    let mut outcome = None;
    let mut last = 0;
    while let Some(event) = player.next() {
        match event {
            Err(error) => outcome = Some(error.to_string()),
            Ok(event) => {
                let Some((frame, _)) = drawn(event) else { continue };
                last = frame;
                if frame == 2 {
                    player.set_settings(strandline::Settings { time_step: -1.0, ..scene().simulation });
                }
            }
        }
    }
    assert_eq!(last, 3);
    assert!(outcome.unwrap().contains("time_step"));
    assert!(player.next().is_none());
    let state = player.state().unwrap();
    assert!(state.positions.iter().all(|lanes| lanes.get(0).is_finite()) && state.time > 0.0);
}

#[test]
fn a_film_may_be_left_at_any_event() {
    for events in 0..9 {
        let mut player = player(true);
        player.by_ref().take(events).for_each(|event| drop(event.unwrap()));
        drop(player);
    }
}
