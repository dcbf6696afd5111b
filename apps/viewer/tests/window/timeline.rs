//! The timeline under the picture, undo, looks as files and the search of settings, as a person uses them.

use eframe::egui::{self, Key, Modifiers, accesskit::Role};
use strandline::Picture;
use strandline_viewer::App;

use crate::person::{STRANDS, Window, scene};

/// A window whose hair has played for some frames and stands still.
fn played(frames: u32) -> Window {
    let mut window = Window::new();
    window.until("some frames", |app| app.timeline().good > frames);
    window.press(Key::Space);
    window.settle();
    window
}

/// The picture of a kept frame that a key leads to.
fn after(window: &mut Window, key: Key) -> (u32, Picture) {
    window.press(key);
    window.settle();
    (window.app().timeline().playhead, window.picture())
}

#[test]
fn keys_and_the_bar_show_kept_frames() {
    let mut window = played(12);
    let last = window.app().timeline().good;
    let end = window.picture();
    assert_eq!(after(&mut window, Key::Home).0, 0);
    let (first, picture) = after(&mut window, Key::ArrowRight);
    assert!(first == 1 && picture != end);
    assert_eq!(after(&mut window, Key::ArrowUp).0, 11);
    assert_eq!(after(&mut window, Key::ArrowLeft).0, 10);
    let (at, shown) = after(&mut window, Key::End);
    assert!(at == last && shown == end, "the last frame is as it was");
    // A frame after the last is simulated.
    assert_eq!(after(&mut window, Key::ArrowRight).0, last + 1);
    let bar = window.control(Role::Slider, "timeline").rect();
    let (left, right) = (bar.left_center(), bar.right_center());
    let film_end = window.app().timeline().film_end.max(last + 1) as f32;
    let place = |frame: f32| left.lerp(right, frame / film_end);
    window.drag(place(9.0), place(4.0));
    window.settle();
    assert_eq!(window.app().timeline().playhead, 4);
    assert!(!window.app().is_playing());
    window.click("|<");
    window.settle();
    assert_eq!(window.app().timeline().playhead, 0);
}

#[test]
fn a_change_in_the_past_makes_later_frames_stale_and_they_are_played_anew() {
    let mut window = played(10);
    let last = window.app().timeline().good;
    after(&mut window, Key::Home);
    after(&mut window, Key::ArrowRight);
    window.slide("wind x", 5.0);
    window.settle();
    let timeline = window.app().timeline();
    assert_eq!((timeline.playhead, timeline.good), (1, 1));
    assert_eq!(timeline.last, last, "stale frames are still seen");
    window.press(Key::Space);
    window.until("it plays anew", |app| app.timeline().good >= last);
}

#[test]
fn a_drag_of_a_slider_is_one_step_that_is_undone_and_done_again() {
    let mut window = Window::still();
    let slider = window.control(Role::Slider, "turn").rect();
    window.drag(slider.center(), slider.center() + egui::vec2(30.0, 0.0));
    let turn = window.app().seen().motion.rotation.y;
    assert!(turn > 5.0, "{turn}");
    window.press_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.app().seen().motion.rotation.y, 0.0, "one step");
    window.press_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.app().seen().motion.rotation.y, turn);
    window.toggle("Steps");
    window.click("Undo");
    assert_eq!(window.app().seen().motion.rotation.y, 0.0);
    // The picture follows.
    window.settle();
    let before = window.picture();
    window.slide("tip width", 1.0);
    window.settle();
    assert!(window.picture() != before);
    window.press_with(Modifiers::COMMAND, Key::Z);
    window.settle();
    assert!(window.picture() == before, "the hair is as it was");
    // A wind and a look: two steps, undone one by one.
    window.slide("wind x", 3.0);
    window.slide("tip width", 0.9);
    window.press_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.app().seen().wind.velocity.x, 3.0);
    window.press_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.app().seen().wind.velocity.x, 0.0);
}

#[test]
fn another_groom_is_undone_by_loading_the_scene_before() {
    let folder = tempfile::tempdir().unwrap();
    let groom = folder.path().join("strands.hair");
    let style = strandline::settings::StyleSettings { strand_count: 40, ..scene().style };
    style.grow().unwrap().save(&groom).unwrap();
    let mut window = Window::still();
    let picture = after(&mut window, Key::Home).1;
    let before = window.app().seen();
    window.pass(Vec::new(), Some(&groom));
    let strands = |app: &App| app.shown().map_or(0, |shown| shown.drawing.strands);
    window.until("the groom", |app| strands(app) == 40);
    window.press_with(Modifiers::COMMAND, Key::Z);
    window.until("the scene before", |app| strands(app) == STRANDS);
    window.settle();
    assert_eq!(window.app().seen().to_toml(), before.to_toml());
    assert!(window.picture() == picture);
}

#[test]
fn a_look_is_saved_as_a_file_and_comes_back_by_dropping_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::still();
    window.app_mut().folder = folder.path().to_owned();
    window.slide("tip width", 0.9);
    window.settle();
    let look = window.app().seen().look;
    window.click("Save look");
    let file = folder.path().join("look_000.toml");
    assert!(file.exists(), "{:?}", window.app().error());
    window.slide("tip width", 0.1);
    window.slide("length", 0.8);
    window.pass(Vec::new(), Some(&file));
    window.settle();
    assert_eq!(window.app().seen().look, look);
    assert_eq!(window.app().seen().groom.length, 0.8, "the rest stays");
}

#[test]
fn a_setting_is_found_by_its_words() {
    let mut window = Window::still();
    window.control(Role::TextInput, "find a setting").focus();
    window.pass(Vec::new(), None);
    window.pass(vec![egui::Event::Text("turned white".to_owned())], None);
    window.settle();
    assert!(window.has_label("look.grey"));
    assert!(!window.has_label("look.tip_width"));
}

#[test]
fn numbers_are_typed_with_units() {
    let mut window = Window::still();
    window.type_into("turn", "0.1 rad");
    let turn = window.app().seen().motion.rotation.y;
    assert!((turn - 0.1_f32.to_degrees()).abs() < 0.01, "{turn}");
}

#[test]
fn a_kept_scene_is_compared_at_the_same_frame_with_the_same_camera() {
    let mut window = played(3);
    after(&mut window, Key::Home);
    (0..3).for_each(|_| window.press(Key::ArrowRight));
    window.settle();
    window.toggle("View");
    window.click("Compare");
    let third = |app: &App| app.compared().and_then(|kept| kept.frame()) == Some(3);
    window.until("the kept scene at the frame", third);
    let kept = |app: &App| app.compared().and_then(|kept| kept.picture().cloned());
    let own = |app: &App| app.shown().map(|shown| shown.picture.clone());
    window.until("the same scene, frame and camera", |app| kept(app).is_some() && kept(app) == own(app));
    let before = kept(window.app());
    window.slide("tip width", 1.0);
    window.settle();
    assert!(own(window.app()) != before && kept(window.app()) == before);
    window.press_with(Modifiers::ALT, Key::ArrowLeft);
    window.until("the camera moves for both", |app| kept(app) != before);
    window.click("End comparison");
    assert!(window.app().compared().is_none());
}
