//! Controls of the panels, found by their labels.

use eframe::egui::{self, accesskit::Role};
use egui_kittest::kittest::NodeT;
use strandline::{Event, Player, Scene};

use crate::person::{Window, hair};

#[test]
fn buttons_and_sliders_of_the_panels_change_the_picture() {
    let mut window = Window::new();
    window.until("a picture", |app| app.shown().is_some());
    window.click("Pause");
    assert!(!window.app().is_playing());
    window.settle();
    let long = hair(&window.picture());
    assert!(long > 1000, "{long} pixels of hair");

    window.slide("length", 0.3);
    assert_eq!(window.app().seen().groom.length, 0.3);
    window.click("Step");
    window.settle();
    let short = hair(&window.picture());
    assert!(short * 10 < long * 8, "{long} pixels of hair became {short}");
    window.slide("length", 1.0);

    let before = window.frame();
    window.click("Play");
    window.until("it plays", |app| app.is_playing() && app.shown().is_some_and(|shown| shown.frame > before));
}

#[test]
fn a_motion_that_is_chosen_turns_the_head() {
    let mut window = Window::still();
    assert!(!window.has_label("file"), "no head follows a file that the scene does not name");
    let before = window.picture();
    window.click("nod");
    assert_eq!(window.app().seen().motion.name, strandline::scene::MotionName::Nod);
    window.press(egui::Key::Space);
    let frame = window.frame();
    window.until("the head nods", |app| app.shown().is_some_and(|shown| shown.frame > frame + 20));
    assert!(window.picture() != before);
}

#[test]
fn the_wind_is_dragged_at_its_dial_and_stands_in_its_sliders() {
    let mut window = Window::still();
    let dial = window.control(Role::Canvas, "wind").rect();
    window.drag(dial.center(), dial.center() + egui::vec2(-36.0, 0.0));
    let wind = window.app().seen().wind.velocity;
    assert!(wind.x < -5.0 && wind.length() < 10.1, "{wind}");
    let slider = window.control(Role::Slider, "wind x").accesskit_node().numeric_value();
    assert_eq!(slider, Some(f64::from(wind.x)));
}

#[test]
fn a_scene_saved_after_changes_makes_the_picture_that_was_seen() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::still();
    window.app_mut().folder = folder.path().to_owned();
    // Shorter hair, a head turned by hand, another view.
    window.slide("length", 0.8);
    window.slide("turn", 10.0);
    window.drag(egui::pos2(600.0, 200.0), egui::pos2(560.0, 190.0));
    window.click("nod");
    window.click("Play");
    let frame = window.frame();
    window.until("it plays", |app| app.shown().is_some_and(|shown| shown.frame > frame + 20));
    window.click("Pause");
    window.settle();
    window.press_with(egui::Modifiers::COMMAND, egui::Key::S);
    let file = folder.path().join("view_000.toml");
    window.until("the file", |_| file.exists());

    let saved = Scene::load(&file).unwrap();
    assert_eq!((saved.groom.length, saved.motion.rotation.y), (0.8, 10.0));
    let mut player = Player::new(&saved, saved.devices, true).unwrap();
    let first = player.find_map(|event| match event.unwrap() {
        Event::Drawn { picture, .. } => Some(picture),
        _ => None,
    });
    assert!(first.unwrap() == window.picture(), "the saved scene shows something else");
}

#[test]
fn every_control_has_a_label() {
    let mut window = Window::still();
    let closed = window.controls(Role::Slider);
    for section in ["Simulation", "Lights", "Detail", "Save", "Keys"] {
        window.toggle(section);
    }
    window.settle();
    let open = window.controls(Role::Slider);
    assert!(closed > 5 && open > closed + 15, "{closed} sliders, then {open}");
    assert_eq!(window.unnamed(), Vec::<String>::new());
}
