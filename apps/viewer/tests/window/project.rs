//! Projects, as a person saves and opens them.

use eframe::egui::{Key, accesskit::Role};

use strandline_viewer::App;

use crate::person::Window;

#[test]
fn a_project_is_saved_by_its_button_and_dropped_on_another_window() {
    let home = tempfile::tempdir().unwrap();
    let mut window = Window::new();
    window.until("some frames", |app| app.timeline().good > 6);
    window.press(Key::Space);
    window.app_mut().folder = home.path().to_owned();
    window.settle();
    let (last, picture) = (window.app().timeline().good, window.picture());
    window.toggle("Save");
    window.click("Project");
    let folder = home.path().join("project_000");
    window.until("the project", |_| folder.join("scene.toml").exists());
    assert_eq!(window.app().error(), None);
    drop(window);

    let mut window = Window::still();
    window.pass(Vec::new(), Some(&folder));
    // Of the window's own hair there may be as many.
    let is_there = |app: &App| app.shown().is_some_and(|shown| shown.picture == picture);
    window.until("its last frame", |app| !app.is_loading() && app.timeline().last == last && is_there(app));
    assert_eq!(window.app().error(), None);
    window.press(Key::Home);
    window.settle();
    assert_eq!((window.app().timeline().playhead, window.app().timeline().good), (0, last));
    assert!(window.picture() != picture);
    window.press(Key::End);
    window.press(Key::ArrowRight);
    window.settle();
    assert_eq!(window.app().timeline().good, last + 1, "it goes on");
    window.control(Role::Button, "Project...");
    assert!(window.app().seen().timeline.frames.is_none());
}
