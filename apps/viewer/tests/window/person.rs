//! A window without a display, and a person at its mouse and keys who finds controls by their labels.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, accesskit::Role};
use egui_kittest::{Harness, Node, kittest::Queryable};
use strandline::{Picture, Scene};
use strandline_viewer::App;

/// A window of 900 x 600 points.
pub struct Window(Harness<'static, App>);

/// A dropped file.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// Strands of [`scene`]: eight for each of its guides.
pub const STRANDS: usize = 8 * 60;

/// A scene that is drawn quickly on the CPU.
pub fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.devices.simulation = strandline::Backend::Cpu;
    scene.devices.pictures = strandline::Backend::Cpu;
    scene.look = strandline::Look {
        follow_strands: 1,
        hair_count: 0,
        width_scale: 10.0,
        ..strandline::Look::thesis()
    };
    scene
}

impl Window {
    pub fn new() -> Self {
        Self::on(scene())
    }

    pub fn on(scene: Scene) -> Self {
        let app = App::new(scene).unwrap();
        let builder = Harness::builder().with_size(egui::vec2(900.0, 600.0));
        Self(builder.build_ui_state(|ui, app: &mut App| app.show(ui), app))
    }

    pub fn app(&self) -> &App {
        self.0.state()
    }

    pub fn app_mut(&mut self) -> &mut App {
        self.0.state_mut()
    }

    /// Lays the window out once with events, as a display would.
    pub fn pass(&mut self, events: Vec<egui::Event>, dropped: Option<&Path>) {
        let input = self.0.input_mut();
        input.events.extend(events);
        input.dropped_files.extend(dropped.map(|path| Arc::new(Dropped(path.to_owned())) as _));
        self.0.step();
    }

    /// Lays the window out until something holds, for at most a minute.
    pub fn until(&mut self, what: &str, holds: impl Fn(&App) -> bool) {
        let begin = Instant::now();
        while !holds(self.app()) {
            assert!(begin.elapsed() < Duration::from_secs(60), "never: {what}");
            self.pass(Vec::new(), None);
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    pub fn press(&mut self, key: egui::Key) {
        self.press_with(egui::Modifiers::NONE, key);
    }

    pub fn press_with(&mut self, modifiers: egui::Modifiers, key: egui::Key) {
        for pressed in [true, false] {
            let event = egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
            self.pass(vec![event], None);
        }
    }

    /// A control by its role and label; fails unless there is exactly one.
    pub fn control<'a>(&'a self, role: Role, label: &'a str) -> Node<'a> {
        self.0.get_by_role_and_label(role, label)
    }

    /// Number of controls of a role.
    pub fn controls(&self, role: Role) -> usize {
        self.0.query_all_by_role(role).count()
    }

    /// Controls without a name.
    pub fn unnamed(&self) -> Vec<String> {
        self.0.unnamed_widgets()
    }

    /// Opens or closes a section of the panel.
    pub fn toggle(&mut self, label: &str) {
        self.control(Role::DisclosureTriangle, label).click_accesskit();
        self.0.step();
    }

    /// Clicks a button.
    pub fn click(&mut self, label: &str) {
        self.control(Role::Button, label).click_accesskit();
        self.0.step();
    }

    /// Sets a slider to a value.
    pub fn slide(&mut self, label: &str, value: f64) {
        self.control(Role::Slider, label).set_value_accesskit(value);
        self.0.step();
    }

    /// True where a label with this text is seen.
    pub fn has_label(&self, text: &str) -> bool {
        self.0.query_by_label(text).is_some()
    }

    /// Types a value into the field beside a slider.
    pub fn type_into(&mut self, label: &str, text: &str) {
        let slider = self.control(Role::Slider, label).rect();
        let field = self.0.query_all_by_role(Role::SpinButton);
        let field = field.filter(|node| (node.rect().center().y - slider.center().y).abs() < 4.0);
        let place = field.map(|node| node.rect().center()).next().expect("a field beside the slider");
        self.pass(vec![egui::Event::PointerMoved(place), button(place, true)], None);
        self.pass(vec![button(place, false)], None);
        self.pass(Vec::new(), None);
        self.press_with(egui::Modifiers::COMMAND, egui::Key::A);
        self.pass(vec![egui::Event::Text(text.to_owned())], None);
        self.press(egui::Key::Enter);
    }

    /// Drags with the left button from one place to another.
    pub fn drag(&mut self, from: egui::Pos2, to: egui::Pos2) {
        self.pass(vec![egui::Event::PointerMoved(from), button(from, true)], None);
        for step in 1..=8 {
            self.pass(vec![egui::Event::PointerMoved(from.lerp(to, step as f32 / 8.0))], None);
        }
        self.pass(vec![button(to, false)], None);
    }

    pub fn frame(&self) -> u64 {
        self.app().shown().map_or(0, |shown| shown.frame)
    }

    pub fn picture(&self) -> Picture {
        self.app().shown().unwrap().picture.clone()
    }

    /// Waits until no event comes any more and the picture is drawn in full.
    pub fn settle(&mut self) {
        let (mut last, mut since) = (self.frame(), Instant::now());
        let is_draft = |app: &App| app.shown().is_some_and(|shown| shown.draft);
        while since.elapsed() < Duration::from_millis(1500) || is_draft(self.app()) {
            self.pass(Vec::new(), None);
            if self.frame() != last {
                (last, since) = (self.frame(), Instant::now());
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Opens a scene that stands still, and waits for its picture.
    pub fn still() -> Self {
        let mut window = Self::new();
        window.until("a picture", |app| app.shown().is_some());
        window.press(egui::Key::Space);
        window.settle();
        window
    }
}

/// The left button, pressed or released.
pub fn button(pos: egui::Pos2, pressed: bool) -> egui::Event {
    let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::default());
    egui::Event::PointerButton { pos, button, pressed, modifiers }
}

/// Pixels of a picture that are hair: brown, darker than skin.
pub fn hair(picture: &Picture) -> usize {
    let is_hair = |pixel: &&[u8]| pixel[0] < 170 && i16::from(pixel[0]) - i16::from(pixel[2]) > 20;
    picture.pixels.chunks_exact(3).filter(is_hair).count()
}
