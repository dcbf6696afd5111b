//! Panels of whole sections, keys on the timeline, and views that a scene keeps.

use eframe::egui::{self, Key, Modifiers, accesskit::Role};
use strandline::{
    Scene,
    scene::{KeyframeSection, MotionName},
};

use crate::person::{Window, scene};

#[test]
fn any_setting_of_groom_body_surroundings_and_film_is_changed_in_its_panel() {
    let mut window = Window::of_size(scene(), egui::vec2(900.0, 1600.0), 0.5);
    window.until("a picture", |app| app.shown().is_some());
    window.press(Key::Space);
    for name in ["Scene", "Motion", "Look"] {
        window.toggle(name);
    }
    window.toggle("Groom");
    window.settle();
    window.type_at(Role::SpinButton, "groom.points_per_strand", "10");
    window.until("finer strands", |app| app.seen().groom.points_per_strand == 10 && !app.is_loading());
    window.type_at(Role::TextInput, "groom.per_strand", "90");
    window.until("a number", |app| app.seen().groom.per_strand == Some(90) && !app.is_loading());
    window.right_click("per strand");
    window.until("no number", |app| app.seen().groom.per_strand.is_none() && !app.is_loading());
    window.type_at(Role::TextInput, "groom.rotation", "90, 0");
    assert!(window.app().error().is_some_and(|error| error.contains("groom.rotation must be 3 numbers")));
    window.press_with(Modifiers::COMMAND, Key::Z);
    window.until("undone", |app| app.seen().groom.per_strand == Some(90) && !app.is_loading());
    window.toggle("Groom");
    window.toggle("Body");
    window.settle();
    window.type_at(Role::TextInput, "body.file", "no_such.glb");
    window.until("a message", |app| app.error().is_some_and(|error| error.contains("no_such.glb")));
    assert_eq!(window.app().seen().body.file, None, "the body stays");
    window.toggle("Body");
    window.toggle("Film");
    window.settle();
    window.type_at(Role::SpinButton, "film.start", "2");
    window.until("a later beginning", |app| app.seen().film.start == 2.0 && !app.is_loading());
}

#[test]
fn a_setting_that_is_seen_twice_is_typed_in_one_row() {
    let mut window = Window::of_size(scene(), egui::vec2(900.0, 1600.0), 0.5);
    window.until("a picture", |app| app.shown().is_some());
    window.press(Key::Space);
    window.settle();
    window.type_at(Role::TextInput, "find a setting", "body rotation");
    assert!(window.has_label("body.rotation"));
    ["Scene", "Motion", "Look", "Body"].into_iter().for_each(|name| window.toggle(name));
    window.settle();
    // The row of the panel is below that of the search, which has no focus meanwhile.
    window.begin_typing_last(Role::TextInput, "body.rotation", "1, 2");
    (0..3).for_each(|_| window.pass(Vec::new(), None));
    assert_eq!(window.app().error(), None, "half of it was taken");
    window.pass(vec![egui::Event::Text(", 3".to_owned())], None);
    window.press(Key::Enter);
    let wanted = glam::Vec3::new(1.0, 2.0, 3.0);
    window.until("the whole of it", |app| app.seen().body.rotation == wanted && !app.is_loading());
}

/// A window that stands still with two keys of the head.
fn keyed() -> Window {
    let mut scene = scene();
    scene.motion.name = MotionName::Keyframes;
    let key = |time, yaw| KeyframeSection {
        time,
        rotation: glam::Vec3::new(0.0, yaw, 0.0),
        ..KeyframeSection::default()
    };
    scene.motion.keyframes = vec![key(0.0, 0.0), key(1.0, 30.0)];
    scene.film.frames = 60;
    let mut window = Window::on(scene);
    window.until("some frames", |app| app.timeline().good > 6);
    window.press(Key::Space);
    window.settle();
    window
}

#[test]
fn a_key_of_the_head_is_dragged_along_its_strip_in_one_step() {
    let mut window = keyed();
    let timeline = window.app().timeline();
    let strip = window.control(Role::Group, "keys of the head").rect();
    let end = f64::from(timeline.film_end.max(timeline.last));
    let place =
        |seconds: f64| strip.left_center().lerp(strip.right_center(), (seconds * timeline.rate / end) as f32);
    window.drag(place(1.0), place(1.5));
    window.settle();
    let times =
        |window: &Window| window.app().seen().motion.keyframes.iter().map(|key| key.time).collect::<Vec<_>>();
    let moved = times(&window);
    assert!(moved[0] == 0.0 && (moved[1] - 1.5).abs() < 0.05, "{moved:?}");
    let timeline = window.app().timeline();
    assert_eq!((timeline.good, timeline.offset), (timeline.playhead, 0.0), "it goes on where it is");
    // A key stays behind the one before it.
    window.drag(place(moved[1]), strip.left_center() - egui::vec2(50.0, 0.0));
    assert_eq!(times(&window)[1], 0.01);
    window.press_with(Modifiers::COMMAND, Key::Z);
    window.press_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(times(&window), [0.0, 1.0]);
    // Beside a key nothing is dragged, and nothing is shown.
    window.drag(place(0.5), place(0.7));
    assert_eq!(times(&window), [0.0, 1.0]);
}

#[test]
fn keys_of_the_camera_are_added_where_one_looks_and_keep_the_frames() {
    let mut window = Window::new();
    window.until("some frames", |app| app.timeline().good > 12);
    window.press(Key::Space);
    window.settle();
    window.toggle("Scene");
    window.toggle("Look");
    window.toggle("View");
    let last = window.app().timeline().good;
    window.press(Key::Home);
    window.click("Add key");
    window.press(Key::ArrowUp);
    window.settle();
    let middle = egui::pos2(650.0, 250.0);
    window.drag(middle, middle + egui::vec2(80.0, 20.0));
    window.click("Add key");
    window.settle();
    let keys = window.app().seen().camera.keyframes;
    let tenth = 10.0 / window.app().timeline().rate;
    assert!(keys.len() == 2 && keys[0].time == 0.0 && (keys[1].time - tenth).abs() < 1e-9, "{keys:?}");
    assert!(keys[1].turn.abs() > 10.0, "{keys:?}");
    assert_eq!(window.app().timeline().good, last, "no frame is stale");
    // The picture of each frame is that of its key.
    let second = window.picture();
    window.press(Key::Home);
    window.settle();
    assert!(window.picture() != second);
    window.press(Key::ArrowUp);
    window.settle();
    assert!(window.picture() == second);
    assert_eq!(window.controls(Role::Group), 1, "a strip of the camera's keys");
}

#[test]
fn kept_views_are_saved_with_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::still();
    window.app_mut().folder = folder.path().to_owned();
    window.toggle("Scene");
    window.toggle("Look");
    window.toggle("View");
    window.click("Keep view");
    let middle = egui::pos2(650.0, 250.0);
    window.drag(middle, middle + egui::vec2(80.0, 0.0));
    window.click("Keep view");
    window.press_with(Modifiers::COMMAND, Key::S);
    let file = folder.path().join("view_000.toml");
    window.until("the file", |_| file.exists());
    let saved = Scene::load(&file).unwrap();
    let names: Vec<&str> = saved.camera.kept.iter().map(|view| view.name.as_str()).collect();
    assert_eq!(names, ["view 1", "view 2"]);
    let position = saved.camera.kept[0].position;
    window.click("view 1");
    window.settle();
    let seen = window.app().seen().camera.position.unwrap();
    assert!(seen.distance(position) < 1e-6, "{seen} {position}");
}
