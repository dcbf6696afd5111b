//! Solids of a body that moves, and a body that moves and is not drawn.

use glam::Vec3;
use strandline::{
    Backend, Hair, Prepared, Style, low_level::body::Shape, scene::BodyPart, settings::StyleSettings,
};

use super::{bust, scene, twin};

/// Triangles of the skin that hair hits.
fn hit(prepared: &Prepared) -> usize {
    match &prepared.colliders[0].shape {
        Shape::Skin(skin) => skin.triangle_count(),
        _ => panic!("a body that moves is hit where it is"),
    }
}

#[test]
fn hair_hits_the_solid_parts_of_a_body_that_moves_alone() {
    let alone = hit(&Prepared::new(&scene("nod")).unwrap());
    let mut both = scene("nod");
    // Beside the body: shells within another are no skin.
    let beside = BodyPart { translation: Vec3::X, ..twin("shrug") };
    both.body.parts = vec![beside.clone()];
    assert_eq!(hit(&Prepared::new(&both).unwrap()), alone, "solid = false");
    both.body.parts = vec![BodyPart { solid: Some(true), ..beside.clone() }];
    assert_eq!(hit(&Prepared::new(&both).unwrap()), 2 * alone);
    // An open part with a colour of its own.
    let folder = tempfile::tempdir().unwrap();
    let cloth = folder.path().join("cloth.obj");
    std::fs::write(folder.path().join("red.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let text = "mtllib red.mtl\nusemtl red\nv .3 0 0\nv .4 0 0\nv .4 .1 0\nv .3 .1 0\nf 1 2 3 4\n";
    std::fs::write(&cloth, text).unwrap();
    both.body.parts = vec![BodyPart { file: cloth, ..BodyPart::default() }];
    let prepared = Prepared::new(&both).unwrap();
    assert!(prepared.mesh.as_ref().unwrap().materials.is_some(), "the cloth has a colour");
    assert_eq!(hit(&prepared), alone);
    both.body.parts = vec![BodyPart { solid: Some(true), visible: false, clip: None, ..beside }];
    let prepared = Prepared::new(&both).unwrap();
    assert_eq!(hit(&prepared), alone);
    let notes = prepared.notes.join("\n");
    assert!(notes.contains("bust.glb: hair does not hit what is not drawn of a body that moves"), "{notes}");
}

#[test]
fn a_collider_in_place_of_a_moving_skin_gets_a_note() {
    let mut still = scene("nod");
    still.body.collider_file = Some(bust());
    let notes = Prepared::new(&still).unwrap().notes.join("\n");
    assert!(notes.contains("body.collider_file rides the head and keeps its shape"), "{notes}");
    still.body.clip = None;
    let notes = Prepared::new(&still).unwrap().notes.join("\n");
    assert!(!notes.contains("body.collider_file"), "{notes}");
}

/// Points of the hair after half a second \[m\].
fn after(visible: bool, clip: Option<&str>) -> Vec<Vec3> {
    let mut scene = scene("smile");
    scene.style = StyleSettings { strand_count: 40, ..StyleSettings::new(Style::Beard) };
    (scene.body.visible, scene.body.clip) = (visible, clip.map(str::to_owned));
    let prepared = Prepared::new(&scene).unwrap();
    let head = prepared.head.clone();
    let mut hair = Hair::from_prepared(prepared, Backend::Cpu).unwrap();
    for step in 1..=30 {
        let time = f64::from(step) / 60.0;
        hair.step(1.0 / 60.0, head.frame(time)).unwrap();
    }
    hair.points().unwrap().to_vec()
}

#[test]
fn roots_ride_a_skin_that_is_not_drawn() {
    // A smile moves the skin under a beard, not the head.
    let (seen, hidden) = (after(true, Some("smile")), after(false, Some("smile")));
    assert_eq!(seen, hidden);
    assert_ne!(seen, after(true, None), "the comparison can fail");
}
