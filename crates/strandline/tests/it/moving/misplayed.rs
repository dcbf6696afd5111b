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
