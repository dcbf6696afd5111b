//! An artist's tasks, done by the labels of controls and counted in steps: a click, a drag, a key, a typed value and a
//! dropped file are one each. docs/window.md has the counts beside those of Blender's own interface.

use eframe::egui::{self, Key, Modifiers, accesskit::Role};
use strandline::Scene;
use strandline_viewer::App;

use crate::person::{Window, scene};

/// The table of docs/window.md.
const PAGE: &str = include_str!("../../../../docs/window.md");

/// Steps of a task in the window and in Blender's own interface, as the page has them.
fn counted(task: &str) -> [usize; 2] {
    let rows = PAGE.lines().filter(|line| line.starts_with(&format!("| {task} |")));
    // A table of other things may have a row of that name.
    let mut counts = rows.map(|row| row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect());
    counts.find_map(|row: Vec<usize>| row.try_into().ok()).expect(task)
}

/// Fails unless the steps since the last task are those of the page, and no more than Blender needs.
fn finish(window: &mut Window, task: &str) {
    let [own, blender] = counted(task);
    assert_eq!(window.steps, own, "steps of: {task}");
    assert!(own <= blender, "{task}: {own} steps, {blender} in Blender");
    window.steps = 0;
}

fn ready(mut window: Window) -> Window {
    window.steps = 0;
    window
}

#[test]
fn an_own_groom_and_head_are_dropped_on_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let [groom, head] = ["own.hair", "head.obj"].map(|name| folder.path().join(name));
    let style = strandline::settings::StyleSettings { strand_count: 40, ..scene().style };
    style.grow().unwrap().save(&groom).unwrap();
    std::fs::write(&head, crate::loading::head("obj", glam::Vec3::ZERO)).unwrap();
    let mut window = ready(Window::still());
    window.pass(Vec::new(), Some(&groom));
    window.pass(Vec::new(), Some(&head));
    let both = |app: &App| app.seen().body.file.is_some() && app.seen().groom.file.is_some();
    window.until("both", |app| !app.is_loading() && both(app));
    assert_eq!(window.app().error(), None);
    finish(&mut window, "own groom and head");
}

#[test]
fn hair_is_coloured_lit_and_blown_and_its_length_style_and_stiffness_are_set() {
    let mut window = ready(Window::still());
    let picture = window.picture();
    window.click("blonde");
    window.until("the colour", |app| app.shown().is_some_and(|shown| shown.picture != picture));
    finish(&mut window, "colour");
    window.steps = 0;
    window.toggle("Lights");
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    let before = window.app().seen().lights;
    window.slide_first("intensity", 3.0);
    assert!(window.app().seen().lights != before || before.is_empty());
    finish(&mut window, "light");
    let dial = window.control(Role::Canvas, "wind").rect();
    window.drag(dial.center(), dial.center() + egui::vec2(-30.0, 0.0));
    assert!(window.app().seen().wind.velocity.length() > 2.0);
    finish(&mut window, "wind");
    window.slide("length", 0.6);
    assert_eq!(window.app().seen().groom.length, 0.6);
    finish(&mut window, "length");
    window.control(Role::ComboBox, "style").click_accesskit();
    window.steps += 1;
    (0..4).for_each(|_| window.pass(Vec::new(), None));
    window.click("curly");
    window.until("the style", |app| !app.is_loading() && app.seen().style.style.name() == "curly");
    finish(&mut window, "style");
    window.toggle("Simulation");
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    let before = window.app().seen().simulation;
    window.slide("stiffness, GPa", 6.0);
    assert!(window.app().seen().simulation != before);
    finish(&mut window, "stiffness");
    window.press_with(Modifiers::COMMAND, Key::Z);
    assert!(window.app().seen().simulation == before);
    finish(&mut window, "undo");
}

#[test]
fn a_frame_is_gone_to_and_two_settings_are_compared() {
    let mut window = Window::new();
    window.within(600, "frames", |app| app.timeline().good > 40);
    window.press(Key::Space);
    window.settle();
    window.steps = 0;
    window.type_at(Role::SpinButton, "frame", "40");
    window.until("frame 40", |app| app.timeline().playhead == 40);
    finish(&mut window, "frame 40");
    window.toggle("View");
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    window.click("Compare");
    window.slide("tip width", 1.0);
    window.until("the kept scene", |app| app.compared().is_some_and(|kept| kept.picture().is_some()));
    finish(&mut window, "compare two settings");
}

#[test]
fn a_look_is_saved_hair_is_exported_and_the_camera_turns() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::new();
    window.app_mut().folder = folder.path().to_owned();
    window.until("frames", |app| app.timeline().good > 3);
    window.press(Key::Space);
    window.settle();
    window.steps = 0;
    window.click("Save look");
    assert!(folder.path().join("look_000.toml").exists());
    finish(&mut window, "save a look");
    for (target, name) in [("blender", "hair_000.usda"), ("unreal", "hair_001.usda")] {
        window.toggle("Save");
        (0..20).for_each(|_| window.pass(Vec::new(), None));
        window.control(Role::RadioButton, target).click_accesskit();
        window.steps += 1;
        window.pass(Vec::new(), None);
        window.click("Kept frames");
        window.until(name, |_| folder.path().join(name).exists());
        assert_eq!(window.app().error(), None);
        finish(
            &mut window,
            &format!("export for {}", if target == "blender" { "Blender" } else { "Unreal" }),
        );
        window.toggle("Save");
        (0..20).for_each(|_| window.pass(Vec::new(), None));
        window.steps = 0;
    }
    window.toggle("View");
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    window.click("Turntable");
    window.until("the turn", |app| !app.is_loading());
    let scene: Scene = window.app().seen();
    assert_eq!(scene.camera.keyframes.last().map(|key| key.turn), Some(360.0));
    finish(&mut window, "turntable");
}

#[test]
fn paths_are_completed_and_everything_is_done_by_keys() {
    let folder = tempfile::tempdir().unwrap();
    let groom = folder.path().join("own_groom.hair");
    let style = strandline::settings::StyleSettings { strand_count: 40, ..scene().style };
    style.grow().unwrap().save(&groom).unwrap();
    let mut window = Window::still();
    window.control(Role::TextInput, "path of a file").focus();
    window.pass(Vec::new(), None);
    let start = folder.path().join("own").display().to_string();
    window.pass(vec![egui::Event::Text(start)], None);
    window.pass(Vec::new(), None);
    assert!(window.shows("own_groom.hair"));
    window.press(Key::Tab);
    window.press(Key::Enter);
    let strands = |app: &App| app.shown().map_or(0, |shown| shown.drawing.strands);
    window.until("the groom", |app| strands(app) == 40);
    window.settle();
    // Tab goes from control to control, the space bar and arrows work them.
    let view = window.app().seen().camera.position;
    window.press_with(Modifiers::ALT, Key::ArrowLeft);
    assert!(window.app().seen().camera.position != view);
    window.control(Role::Slider, "tip width").focus();
    window.pass(Vec::new(), None);
    let width = window.app().seen().look.tip_width;
    window.press(Key::ArrowRight);
    assert!(window.app().seen().look.tip_width > width, "a slider is moved by its keys");
}

#[test]
fn the_lens_is_in_millimetres_and_the_panels_are_light_or_dark() {
    let mut window = Window::still();
    window.toggle("View");
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    window.slide("lens", 50.0);
    let angle = window.app().seen().camera.field_of_view.unwrap();
    // 2 atan(12 / 50).
    assert!((angle - 26.99).abs() < 0.02, "{angle}");
    window.toggle("View");
    window.toggle("Window");
    (0..20).for_each(|_| window.pass(Vec::new(), None));
    window.control(Role::RadioButton, "light").click_accesskit();
    (0..3).for_each(|_| window.pass(Vec::new(), None));
    assert!(!window.is_dark());
    window.control(Role::RadioButton, "dark").click_accesskit();
    (0..3).for_each(|_| window.pass(Vec::new(), None));
    assert!(window.is_dark());
}
