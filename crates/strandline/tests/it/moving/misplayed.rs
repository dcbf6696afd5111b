//! Motions that are not seen, not used or in other units, and what is said of them.

use super::*;

/// Notes of a load.
fn notes(scene: &Scene) -> Vec<String> {
    Prepared::new(scene).unwrap().notes
}

/// Notes among those of a load that hold a word.
fn notes_on(scene: &Scene, word: &str) -> Vec<String> {
    notes(scene).into_iter().filter(|note| note.contains(word)).collect()
}

#[test]
fn a_motion_outside_of_the_film_is_told() {
    let mut late = scene("nod");
    late.body.start = 500.0;
    late.film.frames = 120;
    let note = "body.start: the motion lasts from 0 to 2 s, the film shows 500 to 504 s of it, where it stands still: with \
                body.start = 0 they begin together";
    assert_eq!(notes_on(&late, "body.start"), [note]);
    late.body.r#loop = true;
    assert!(notes_on(&late, "body.start").is_empty(), "it goes round");
    let mut head = scene("nod");
    head.body.clip = None;
    (head.motion.name, head.motion.file) = (MotionName::File, Some(bust()));
    (head.motion.joint, head.motion.clip) = ("head".to_owned(), Some("nod".to_owned()));
    (head.motion.start, head.motion.speed) = (-9.0, -1.0);
    let found = notes_on(&head, "motion.start");
    assert!(found.len() == 1 && found[0].ends_with("motion.start = 2 they begin together"), "{found:?}");
    head.motion.start = 2.0;
    assert!(notes_on(&head, "motion.start").is_empty());
}

#[test]
fn settings_of_a_motion_without_one_are_told() {
    let mut rests = scene("nod");
    (rests.body.clip, rests.body.start, rests.body.r#loop) = (None, 0.5, true);
    rests.body.parts = vec![BodyPart { file: bust(), speed: 2.0, visible: false, ..BodyPart::default() }];
    let note = "body.start, body.loop are not used, as the body does not move by itself: body.clip plays one of its clips: \
                `nod`, `look`, `shrug`, `smile`";
    let of_part = "body.parts[0].speed is not used, as the part rides the head: body.parts[0].clip plays one of its clips: \
                   `nod`, `look`, `shrug`, `smile`";
    assert_eq!(notes_on(&rests, "not used"), [note, of_part]);
    rests.body.parts.clear();
    rests.body.clip = Some("nod".to_owned());
    assert!(notes_on(&rests, "not used").is_empty());
}

#[test]
fn a_recording_in_centimetres_is_told_and_its_jumps_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.bvh");
    let place = |frame: i32| f64::from(600 * frame + frame * frame) / 100.0;
    let frames: String = (0..121).map(|frame| format!(" {}", place(frame))).collect();
    let text =
        "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 1 Xposition } MOTION Frames: 121 Frame Time: 0.04";
    std::fs::write(&path, text.to_owned() + &frames).unwrap();
    let mut walks = Scene::demo();
    walks.set_style(Style::Bob);
    (walks.style.strand_count, walks.body.spacing, walks.groom.bound) = (10, 0.02, Some(0));
    (walks.groom.points_per_strand, walks.devices.simulation) = (4, Backend::Cpu);
    (walks.motion.name, walks.motion.file) = (MotionName::File, Some(path));
    (walks.film.frames, walks.film.frames_per_second) = (121, 25.0);
    let note = "motion.file moves the head by 6.01 m in 0.04 s, again and again: motion.scale is 1 m, and of a file in centimetres \
                it is 0.01 m";
    assert_eq!(notes_on(&walks, "motion.scale"), [note]);
    let mut player = Player::new(&walks, walks.devices, false).unwrap();
    let told: Vec<String> = player
        .by_ref()
        .filter_map(|event| match event.unwrap() {
            Event::Note(note) if note.contains("jump") => Some(note),
            _ => None,
        })
        .collect();
    assert!(told.len() == 9 && told.iter().any(|note| note == "the body has jumped 100 times"), "{told:#?}");
    assert!(player.jumps().len() > 100, "{} jumps", player.jumps().len());
    let mut distinct = told.clone();
    distinct.dedup();
    assert_eq!(distinct, told);
    walks.motion.scale = 0.01;
    assert!(notes_on(&walks, "motion.scale").is_empty());
}
