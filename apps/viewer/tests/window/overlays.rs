//! Overlays, the progress of a load, files that are watched, and mends as buttons.

use std::cell::RefCell;
use std::time::Duration;

use eframe::egui::{self, Key, accesskit::Role};
use strandline::{
    Scene,
    live::{LoadStage, Overlay},
};

use strandline_viewer::App;

use crate::person::{Window, scene};

/// Chooses an overlay by its menu, and waits for its numbers.
fn choose(window: &mut Window, overlay: Overlay) {
    // The list may still be open from the last time.
    while !window.has_button(overlay.name()) {
        window.control(Role::ComboBox, "overlay").click_accesskit();
        (0..4).for_each(|_| window.pass(Vec::new(), None));
    }
    window.click(overlay.name());
    window.until(overlay.name(), |app| {
        app.shown().and_then(|shown| shown.overlaid.as_ref()).is_some_and(|shown| shown.overlay == overlay)
    });
    window.settle();
}

/// The numbers of the overlay that is shown.
fn values(window: &Window) -> Vec<f32> {
    window.app().shown().unwrap().overlaid.as_ref().unwrap().values.clone()
}

fn most(values: &[f32]) -> f32 {
    values.iter().copied().fold(0.0, f32::max)
}

#[test]
fn overlays_are_chosen_by_their_names_and_have_numbers_of_the_hair() {
    let mut window = Window::still();
    let guides = scene().style.strand_count;
    choose(&mut window, Overlay::Guides);
    let overlaid = window.app().shown().unwrap().overlaid.clone().unwrap();
    let each = overlaid.points_per_strand;
    assert_eq!(overlaid.points.len(), guides * each);
    assert!(overlaid.values.is_empty());
    let hidden = overlaid.hidden.iter().filter(|hidden| **hidden).count();
    assert!(hidden > 0 && 4 * hidden < 3 * overlaid.hidden.len(), "{hidden} behind the head");
    choose(&mut window, Overlay::Roots);
    assert_eq!(window.app().shown().unwrap().overlaid.as_ref().unwrap().points.len(), guides);
    choose(&mut window, Overlay::Contact);
    let near = values(&window);
    // Roots lie on the skin, tips of long hair hang beside it.
    let roots: Vec<f32> = near.iter().step_by(each).copied().collect();
    assert!(most(&roots) < 4.0 && most(&near) > 10.0, "{} and {} mm", most(&roots), most(&near));
    choose(&mut window, Overlay::Stiffness);
    let stiff = values(&window);
    assert!(stiff[0] > 0.0 && stiff[each - 1] > 0.0);
    choose(&mut window, Overlay::Stretch);
    assert!(most(&values(&window)) < 2.0, "{} %", most(&values(&window)));
    // Hair that was blown moves, and at the first frame it stands still.
    choose(&mut window, Overlay::Speed);
    window.slide("wind x", 6.0);
    for _ in 0..4 {
        window.press(Key::Period);
    }
    let speed = |app: &App| app.shown().and_then(|shown| shown.overlaid.clone()).map(|all| most(&all.values));
    window.until("it moves", |app| speed(app).is_some_and(|most| most > 0.05));
    window.press(Key::Home);
    window.until("it stands still", |app| speed(app) == Some(0.0));
    // Groups are those of the groom; the key goes on to the next overlay, and after the last to none.
    choose(&mut window, Overlay::Group);
    window.press(Key::L);
    window.until("contact", |app| {
        app.shown().unwrap().overlaid.as_ref().is_some_and(|shown| shown.overlay == Overlay::Contact)
    });
    window.press(Key::L);
    window.press(Key::L);
    window.until("none", |app| app.shown().unwrap().overlaid.is_none());
}

#[test]
fn a_load_tells_its_stage_and_shows_the_hair_before_there_is_a_picture() {
    let mut own = scene();
    // A load that is done within one pass of the window, on a machine with much to do, has nothing to tell: it grows.
    while !a_load_is_told(own.clone()) {
        own.style.strand_count *= 4;
        assert!(own.style.strand_count < 100_000, "never told");
    }
}

/// True if a window told the stages of a load and showed its hair, before there was a picture.
fn a_load_is_told(scene: Scene) -> bool {
    let mut window = Window::on(scene);
    let (mut stages, mut seen, mut told) = (Vec::new(), false, false);
    while window.app().shown().is_none() {
        window.pass(Vec::new(), None);
        assert_eq!(window.app().error(), None);
        if let Some((stage, has_hair)) = window.app().load_stage() {
            if stages.last() != Some(&stage) {
                stages.push(stage);
            }
            seen |= has_hair;
            told |= window.shows(stage.name());
        }
        assert!(!window.shows("open a"), "it asks for a scene while one loads");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(
        stages.is_sorted_by_key(|stage| LoadStage::ALL.iter().position(|other| other == stage)),
        "{stages:?}"
    );
    told && seen
}

#[test]
fn a_first_scene_that_is_not_there_asks_for_another() {
    let mut scene = scene();
    scene.groom.file = Some("nowhere.hair".into());
    let mut window = Window::on(scene);
    window.until("the error", |app| app.error().is_some());
    window.pass(Vec::new(), None);
    assert!(window.shows("open another"));
}

#[test]
fn files_that_change_are_loaded_again_and_the_view_stays() {
    let folder = tempfile::tempdir().unwrap();
    let [groom, file] = ["strands.hair", "scene.toml"].map(|name| folder.path().join(name));
    let grown = |count| strandline::settings::StyleSettings { strand_count: count, ..scene().style };
    grown(40).grow().unwrap().save(&groom).unwrap();
    let mut own = scene();
    own.groom.file = Some("strands.hair".into());
    std::fs::write(&file, own.to_toml()).unwrap();
    let mut window = Window::still();
    window.pass(Vec::new(), Some(&file));
    let strands = |app: &App| app.shown().map_or(0, |shown| shown.drawing.strands);
    window.until("the groom", |app| strands(app) == 40 && !app.is_loading());
    window.press_with(egui::Modifiers::ALT, Key::ArrowLeft);
    window.settle();
    let view = window.app().seen().camera.position;
    grown(30).grow().unwrap().save(&groom).unwrap();
    window.settle();
    assert_eq!(strands(window.app()), 40, "nothing is watched yet");
    window.control(Role::CheckBox, "watch files").click_accesskit();
    window.pass(Vec::new(), None);
    grown(20).grow().unwrap().save(&groom).unwrap();
    window.until("the other groom", |app| strands(app) == 20 && !app.is_loading());
    assert_eq!(window.app().seen().camera.position, view);
    // The scene's file, with a step that takes the change back.
    own.look.grey = 0.5;
    std::fs::write(&file, own.to_toml()).unwrap();
    window.until("the other look", |app| app.seen().look.grey == 0.5 && !app.is_loading());
    window.press_with(egui::Modifiers::COMMAND, Key::Z);
    window.until("the look before", |app| app.seen().look.grey == 0.0);
}

#[test]
fn a_message_has_its_mend_as_a_button_which_is_a_step() {
    let mut window = Window::still();
    let before = window.app().seen().to_toml();
    let mut wrong = scene();
    (wrong.look.grey, wrong.look.width_scale) = (0.4, -3.0);
    window.app_mut().open_scene(wrong);
    window.until("the error", |app| app.error().is_some());
    window.pass(Vec::new(), None);
    window.click("look.width_scale = 1.0");
    window.until("it is mended", |app| !app.is_loading() && app.seen().look.grey == 0.4);
    assert_eq!((window.app().error(), window.app().seen().look.width_scale), (None, 1.0));
    window.press_with(egui::Modifiers::COMMAND, Key::Z);
    window.until("it is undone", |app| !app.is_loading() && app.seen().look.grey == 0.0);
    window.settle();
    let after = window.app().seen().to_toml();
    let differ: Vec<_> = before.lines().zip(after.lines()).filter(|(was, is)| was != is).collect();
    assert!(before == after, "lines that differ, before and after: {differ:?}");
}

#[test]
fn words_that_come_and_go_leave_the_picture_its_size() {
    // Narrow enough that the words of the status bar are wider than the window.
    let mut window = Window::of_size(scene(), egui::vec2(560.0, 420.0), 1.0);
    window.pass(Vec::new(), None);
    let size = |app: &App| [app.seen().picture.width, app.seen().picture.height];
    let first = size(window.app());
    // Between the end of the load and the first picture the bar has no words.
    let others = RefCell::new(Vec::new());
    window.until("a picture", |app| {
        let now = size(app);
        if now != first && !others.borrow().contains(&now) {
            others.borrow_mut().push(now);
        }
        app.shown().is_some_and(|shown| shown.step.is_some())
    });
    assert_eq!(*others.borrow(), [[0; 2]; 0], "the first was {first:?}");
    window.press(Key::Space);
    window.settle();
    assert!(window.has_label("simulated and drawn on the CPU"));
    assert_eq!(size(window.app()), first);
}
