//! Pictures of the panels for docs/window.md: `cargo xtask panels` writes them.

use std::path::Path;

use eframe::egui::{self, Key, Rect, accesskit::Role};
use strandline::{Scene, live::Overlay};

use crate::person::{Window, scene};

/// Sections of the panel, from the top, and whether they are open at first.
const SECTIONS: [(&str, bool); 16] = [
    ("Scene", true),
    ("Groom", false),
    ("Body", false),
    ("Brushes", false),
    ("Motion", true),
    ("Simulation", false),
    ("Look", true),
    ("Lights", false),
    ("Surroundings", false),
    ("Detail", false),
    ("View", false),
    ("Film", false),
    ("Save", false),
    ("Steps", false),
    ("Window", false),
    ("Keys", false),
];
/// Width of the panel \[point\], and pixels of a point.
const WIDTH: f32 = 300.0;
const SCALE: f32 = 1.5;

/// The scene of the pictures: that of the demo on the CPU.
fn demo() -> Scene {
    let mut scene = Scene::demo();
    (scene.devices.simulation, scene.devices.pictures) = (strandline::Backend::Cpu, strandline::Backend::Cpu);
    scene
}

fn save(picture: &image::RgbImage, folder: &Path, name: &str) {
    std::fs::create_dir_all(folder).unwrap();
    picture.save(folder.join(format!("{}.png", name.to_lowercase()))).unwrap();
}

fn crop(picture: &image::RgbImage, part: Rect) -> image::RgbImage {
    let [left, top, right, bottom] =
        [part.left(), part.top(), part.right(), part.bottom()].map(|side| (side * SCALE) as u32);
    let (right, bottom) = (right.min(picture.width()), bottom.min(picture.height()));
    image::imageops::crop_imm(picture, left, top, right - left, bottom - top).to_image()
}

/// The panel from the header of a section to the next one.
fn panel(window: &Window, index: usize) -> Rect {
    let top = window.control(Role::DisclosureTriangle, SECTIONS[index].0).rect().top();
    let next = SECTIONS.get(index + 1);
    let top_of = |(name, _): &(&str, bool)| window.control(Role::DisclosureTriangle, name).rect().top();
    // The last one ends with the last key.
    let bottom = next.map_or_else(|| window.bottom_of("save the picture") + 6.0, top_of);
    Rect::from_min_max(egui::pos2(0.0, top - 3.0), egui::pos2(WIDTH, bottom))
}

/// Every section has its header and its controls inside the panel; with `STRANDLINE_PANELS` the pictures are written.
#[test]
fn pictures_of_the_panels_show_each_section_whole() {
    let folder = std::env::var_os("STRANDLINE_PANELS").map(std::path::PathBuf::from);
    let height = 1500.0;
    // The places of controls are all that is looked at where no picture is written.
    let scale = if folder.is_some() { SCALE } else { 0.5 };
    let mut window = Window::of_size(scene(), egui::vec2(620.0, height), scale);
    window.until("a picture", |app| app.shown().is_some());
    window.press(Key::Space);
    window.settle();
    for (name, _) in SECTIONS.iter().filter(|(_, open)| *open) {
        window.toggle(name);
    }
    for (index, (name, _)) in SECTIONS.iter().enumerate() {
        window.toggle(name);
        (0..30).for_each(|_| window.pass(Vec::new(), None));
        let part = panel(&window, index);
        assert!(part.bottom() < height, "{name} is longer than the window");
        assert!(part.height() > 40.0, "{name} has no contents");
        let widest = window.right_of_controls(part);
        assert!(widest <= WIDTH + 6.0, "a control of {name} ends at {widest}, beyond the panel");
        if let Some(folder) = &folder {
            // The picture of the whole window has that name.
            let name = if *name == "Window" { "window_panel" } else { name };
            save(&crop(&window.drawn(), part), folder, name);
        }
        window.toggle(name);
        (0..30).for_each(|_| window.pass(Vec::new(), None));
    }
    if let Some(folder) = &folder {
        whole(folder);
    }
}

/// The window while it loads, with its hair, an overlay, and a message with its mend.
fn whole(folder: &Path) {
    let mut window = Window::of_size(demo(), egui::vec2(1100.0, 700.0), 1.0);
    window.until("the hair", |app| app.load_stage().is_some_and(|(_, has_hair)| has_hair));
    window.pass(Vec::new(), None);
    save(&window.drawn(), folder, "loading");
    let width = window.control(Role::TextInput, "find a setting").rect().right();
    assert!(width < 400.0, "the panel is {width} wide");
    window.until("frames", |app| app.timeline().good > 20);
    window.press(Key::Space);
    window.settle();
    save(&window.drawn(), folder, "window");
    window.app_mut().overlay(Some(Overlay::Speed));
    window.settle();
    save(&window.drawn(), folder, "overlay");
    window.app_mut().overlay(None);
    let mut wrong = demo();
    wrong.look.width_scale = -3.0;
    window.app_mut().open_scene(wrong);
    window.until("the error", |app| app.error().is_some());
    (0..4).for_each(|_| window.pass(Vec::new(), None));
    save(&window.drawn(), folder, "message");
}
