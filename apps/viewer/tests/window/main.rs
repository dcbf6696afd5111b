//! The window as a person uses it, without a display: its contents are laid out, found by their labels and fed events.

mod brushes;
mod drawn;
mod items;
mod loading;
mod measured;
mod overlays;
mod panels;
mod person;
mod pictures;
mod project;
mod table;
mod tasks;
mod timeline;

use std::time::Duration;

use eframe::egui;
use person::{STRANDS, Window, button, scene};
use strandline::{Picture, Scene};
use strandline_viewer::App;

#[test]
fn hair_is_grabbed_where_the_button_was_pressed_and_follows_though_nothing_plays() {
    let mut window = Window::new();
    window.until("a picture", |app| app.shown().is_some());
    window.press(egui::Key::Space);
    window.settle();
    window.press(egui::Key::G);
    let picture = window.picture();
    let width = picture.width as usize;
    // Brown on grey, in the lower half, at the right, where there is no skin behind it nor its shadow.
    let is_hair = |index: usize| {
        let pixel = &picture.pixels[3 * index..3 * index + 3];
        3 * (index % width) > 2 * width && i16::from(pixel[0]) - i16::from(pixel[2]) > 15
    };
    let hair =
        (picture.height as usize * width / 2..picture.height as usize * width).find(|index| is_hair(*index));
    let hair = hair.expect("hair in the picture");
    let room = window.room();
    let scale = egui::vec2(room.width() / width as f32, room.height() / picture.height as f32);
    let place = room.min + egui::vec2((hair % width) as f32 + 0.5, (hair / width) as f32 + 0.5) * scale;
    // The whole drag in one pass, as in a slow window.
    let away = egui::pos2(320.0, 300.0);
    window.pass(
        vec![egui::Event::PointerMoved(place), button(place, true), egui::Event::PointerMoved(away)],
        None,
    );
    window.until("hair in the hand", |app| app.shown().is_some_and(|shown| shown.grabbed > 0));
    window.settle();
    let before = window.picture();
    // Of moves that come faster than pictures the last counts.
    for step in 1..=8 {
        window.pass(vec![egui::Event::PointerMoved(away + egui::vec2(-2.0, 4.0) * step as f32)], None);
    }
    window.settle();
    let after = window.picture();
    let size = |picture: &Picture| [picture.width, picture.height];
    assert_eq!(size(&after), size(&before));
    assert!(after != before, "it does not follow");
    assert!(!window.app().is_playing());
    window.pass(vec![button(away, false)], None);
    window.until("it is let go", |app| app.shown().is_some_and(|shown| shown.grabbed == 0));
}

#[test]
fn pictures_are_saved_in_full_while_it_plays_though_the_window_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::new();
    window.app_mut().folder = folder.path().to_owned();
    window.until("a picture", |app| app.shown().is_some());
    window.app_mut().save_picture(Some(folder.path().join("named")));
    window.app_mut().save_picture(None);
    window.app_mut().save_picture(None);
    assert!(window.app().is_playing());
    drop(window);
    for name in ["named.png", "view_000.png", "view_001.png"] {
        let picture = image::open(folder.path().join(name)).unwrap();
        assert!(picture.width() >= 480, "{name}");
    }
}

#[test]
fn it_opens_plays_and_stands_still_at_the_space_bar() {
    let mut window = Window::new();
    window.until("a picture", |app| app.shown().is_some());
    let first = window.frame();
    window.until("it plays", |app| app.shown().is_some_and(|shown| shown.frame > first + 2));
    window.press(egui::Key::Space);
    assert!(!window.app().is_playing());
    window.settle();
    let picture = window.picture();
    // The picture fills the room beside the panels.
    assert!(picture.width >= 480 && picture.width < 640 && picture.height >= 480, "{}", picture.width);
    window.press(egui::Key::Period);
    let frame = window.frame();
    window.until("one more frame", |app| app.shown().is_some_and(|shown| shown.frame > frame));
    assert!(window.picture() != picture);
}

#[test]
fn dragging_turns_the_view() {
    let mut window = Window::new();
    window.until("a picture", |app| app.shown().is_some());
    window.press(egui::Key::Space);
    window.settle();
    let before = window.picture();
    let at = |x: f32| egui::pos2(x, 300.0);
    window.pass(vec![egui::Event::PointerMoved(at(600.0)), button(at(600.0), true)], None);
    for step in 1..8 {
        window.pass(vec![egui::Event::PointerMoved(at(600.0 + 12.0 * step as f32))], None);
    }
    window.pass(vec![button(at(684.0), false)], None);
    window.settle();
    assert!(window.picture() != before);
}

#[test]
fn a_dropped_groom_is_loaded_and_a_bad_file_shows_its_error_while_the_old_hair_stays() {
    let folder = tempfile::tempdir().unwrap();
    let groom = folder.path().join("strands.hair");
    strandline::settings::StyleSettings { strand_count: 40, ..scene().style }
        .grow()
        .unwrap()
        .save(&groom)
        .unwrap();
    let mut window = Window::new();
    window.until("a picture", |app| app.shown().is_some());
    window.press(egui::Key::Space);
    window.settle();
    let before = window.picture();

    let bad = folder.path().join("bad.hair");
    std::fs::write(&bad, b"PK nothing").unwrap();
    window.pass(Vec::new(), Some(&bad));
    window.until("the error", |app| app.error().is_some());
    assert!(window.app().error().unwrap().contains("bad.hair"), "{:?}", window.app().error());
    window.settle();
    assert_eq!(window.app().shown().unwrap().drawing.strands, STRANDS, "the old hair stays");
    assert_eq!(window.picture(), before);
    assert_eq!(window.app().seen().groom.file, None, "a scene that is saved now is that of the old hair");
    let text = folder.path().join("notes.txt");
    std::fs::write(&text, b"x").unwrap();
    window.pass(Vec::new(), Some(&text));
    assert!(window.app().error().unwrap().contains(".toml scene"));

    window.pass(Vec::new(), Some(&groom));
    let segments = |app: &App| app.shown().map_or(0, |shown| shown.drawing.strands);
    window.until("the groom", |app| segments(app) == 40);
    assert_eq!(window.app().error(), None);
}

#[test]
fn a_scene_saved_in_mid_swing_begins_with_the_picture_that_was_seen() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::new();
    window.app_mut().folder = folder.path().join("saved");
    window.until("pictures", |app| app.shown().is_some_and(|shown| shown.frame > 20));
    window.press(egui::Key::Space);
    window.press_with(egui::Modifiers::ALT, egui::Key::ArrowLeft);
    window.settle();
    for key in [egui::Key::S, egui::Key::P, egui::Key::P] {
        window.press_with(egui::Modifiers::COMMAND, key);
    }
    let path = |name: &str| folder.path().join("saved").join(name);
    window.until("the files", |_| {
        ["view_000.toml", "view_000.png", "view_001.png"].iter().all(|name| path(name).exists())
    });
    let seen = window.picture();

    let saved = Scene::load(&path("view_000.toml")).unwrap();
    assert!(saved.film.start > 0.2, "{}", saved.film.start);
    let first = |scene: &Scene| {
        let mut player = strandline::Player::new(scene, scene.devices, true).unwrap();
        let first = player.find_map(|event| match event.unwrap() {
            strandline::Event::Drawn { picture, .. } => Some(picture),
            _ => None,
        });
        first.unwrap()
    };
    assert!(first(&saved) == seen, "the saved scene shows something else");
    let mut rest = saved.clone();
    rest.begin_at_rest();
    assert!(first(&rest) != seen);
}

#[test]
fn it_closes_in_the_middle_of_loading() {
    for wait in [0, 30, 300] {
        let mut window = Window::new();
        window.pass(Vec::new(), None);
        std::thread::sleep(Duration::from_millis(wait));
        drop(window);
    }
}
