//! Items of a scene's lists and clips of a body, changed in their panels.

use eframe::egui::{self, Key, Modifiers, accesskit::Role};
use strandline::scene::{BodyPart, ColliderSection};

use crate::person::{Window, scene};

/// A high window that stands still, with one panel open.
fn open(scene: strandline::Scene, panel: &str) -> Window {
    let mut window = Window::of_size(scene, egui::vec2(900.0, 2400.0), 0.25);
    window.until("a picture", |app| app.shown().is_some() && !app.is_loading());
    window.press(Key::Space);
    for name in ["Scene", "Motion", "Look"].into_iter().filter(|name| *name != panel) {
        window.toggle(name);
    }
    if !["Scene", "Motion", "Look"].contains(&panel) {
        window.toggle(panel);
    }
    window.settle();
    window
}

fn settles(window: &mut Window) {
    window.until("it is loaded", |app| !app.is_loading());
    // Sections open by and by.
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    assert_eq!(window.app().error(), None);
}

#[test]
fn solids_are_added_changed_taken_out_and_undone_in_their_panel() {
    let mut window = open(scene(), "Motion");
    let radius = |window: &Window| match window.app().seen().colliders.first() {
        Some(ColliderSection::Sphere(ball)) => ball.radius,
        _ => 0.0,
    };
    window.click("Add ball");
    settles(&mut window);
    assert_eq!(radius(&window), 0.05);
    window.toggle("solid 1: sphere");
    settles(&mut window);
    window.type_at(Role::SpinButton, "colliders[0].radius", "8cm");
    settles(&mut window);
    assert_eq!(radius(&window), 0.08);
    window.click("Add capsule");
    settles(&mut window);
    assert_eq!(window.app().seen().colliders.len(), 2);
    for left in [1, 1, 0] {
        window.press_with(Modifiers::COMMAND, Key::Z);
        settles(&mut window);
        assert_eq!(window.app().seen().colliders.len(), left);
    }
    window.press_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    settles(&mut window);
    assert_eq!(radius(&window), 0.05, "done again");
    window.click("x");
    settles(&mut window);
    assert!(window.app().seen().colliders.is_empty());
}

#[test]
fn ties_and_looks_of_groups_are_added_and_changed_in_their_panels() {
    let mut window = open(scene(), "Groom");
    window.click("Add tie");
    settles(&mut window);
    window.toggle("tie 1");
    settles(&mut window);
    window.type_at(Role::SpinButton, "ties[0].radius", "3cm");
    settles(&mut window);
    assert_eq!(window.app().seen().ties[0].radius, 0.03);
    drop(window);
    let folder = tempfile::tempdir().unwrap();
    let [hair, brows] = ["hair.hair", "brows.hair"].map(|name| folder.path().join(name));
    let style = strandline::settings::StyleSettings { strand_count: 40, ..scene().style };
    [&hair, &brows].into_iter().for_each(|path| drop(style.grow().unwrap().save(path).unwrap()));
    let mut two = scene();
    two.groom.file = Some(hair);
    two.groom.parts.push(strandline::scene::GroomPart { file: brows, ..Default::default() });
    let mut window = open(two, "Look");
    window.click("Add group");
    settles(&mut window);
    window.toggle("group 1: 0");
    settles(&mut window);
    window.type_at(Role::TextInput, "look.group[0].grey", "50%");
    settles(&mut window);
    assert_eq!(window.app().seen().look.group[0].grey, Some(0.5));
}

#[test]
fn clips_of_a_body_and_of_its_parts_are_chosen_from_those_of_their_files() {
    let bust = std::path::absolute("../../examples/bust.glb").unwrap();
    let names = strandline::Mesh::clip_names(&bust).unwrap();
    let mut scene = scene();
    scene.body.file = Some(bust.clone());
    scene.body.spacing = 0.02;
    scene.body.parts.push(BodyPart { file: bust, ..BodyPart::default() });
    let mut window = open(scene, "Body");
    window.control(Role::ComboBox, "clip").click_accesskit();
    (0..4).for_each(|_| window.pass(Vec::new(), None));
    assert!(names.iter().all(|name| window.has_label(name)), "{names:?}");
    window.click(&names[0]);
    settles(&mut window);
    assert_eq!(window.app().seen().body.clip.as_ref(), Some(&names[0]));
    assert_eq!(window.app().seen().body.parts[0].clip, None, "that of the part stays");
    assert_eq!(window.app().seen().motion.name, strandline::scene::MotionName::Still, "nobody chose a shake");
}
