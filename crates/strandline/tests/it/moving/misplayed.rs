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
