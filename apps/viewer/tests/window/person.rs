//! A window without a display, and a person at its mouse and keys who finds controls by their labels.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, accesskit::Role};
use egui_kittest::{Harness, Node, kittest::Queryable};
use strandline::{Picture, Scene};
use strandline_viewer::App;

use crate::drawn::Textures;

/// A window, its textures, and the steps of its person: clicks, drags, keys and typed values.
pub struct Window {
    harness: Harness<'static, App>,
    textures: Textures,
    pub steps: usize,
}

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

    /// A window of 900 x 600 points.
    pub fn on(scene: Scene) -> Self {
        Self::of_size(scene, egui::vec2(900.0, 600.0), 1.0)
    }

    /// A window of a size \[point\] with so many pixels to a point.
    pub fn of_size(scene: Scene, size: egui::Vec2, scale: f32) -> Self {
        let (app, textures) = (App::new(scene).unwrap(), Textures::default());
        let builder = Harness::builder().with_size(size).with_pixels_per_point(scale);
        let builder = builder.renderer(textures.clone());
        let harness = builder.build_ui_state(|ui, app: &mut App| app.show(ui), app);
        Self { harness, textures, steps: 0 }
    }

    /// The window as a display would show it.
    pub fn drawn(&self) -> image::RgbImage {
        let output = self.harness.output();
        let scale = output.pixels_per_point;
        let primitives = self.harness.ctx.tessellate(output.shapes.clone(), scale);
        self.textures.draw(&primitives, self.harness.ctx.content_rect().size(), scale)
    }

    /// The lower end of a label.
    pub fn bottom_of(&self, label: &str) -> f32 {
        self.harness.get_by_label(label).rect().bottom()
    }

    /// The right end of the controls in a part of the window.
    pub fn right_of_controls(&self, part: egui::Rect) -> f32 {
        let roles =
            [Role::Button, Role::Slider, Role::SpinButton, Role::CheckBox, Role::ComboBox, Role::RadioButton];
        let ends =
            roles.iter().flat_map(|role| self.harness.query_all_by_role(*role)).map(|node| node.rect());
        ends.filter(|rect| part.contains(rect.left_center())).map(|rect| rect.right()).fold(0.0, f32::max)
    }

    /// The place of the picture, the largest image.
    pub fn room(&self) -> egui::Rect {
        let images = self.harness.query_all_by_role(Role::Image).map(|node| node.rect());
        images.max_by(|one, two| one.area().total_cmp(&two.area())).expect("a picture")
    }

    pub fn app(&self) -> &App {
        self.harness.state()
    }

    pub fn app_mut(&mut self) -> &mut App {
        self.harness.state_mut()
    }

    /// Lays the window out once with events, as a display would.
    pub fn pass(&mut self, events: Vec<egui::Event>, dropped: Option<&Path>) {
        self.steps += usize::from(dropped.is_some());
        let input = self.harness.input_mut();
        input.events.extend(events);
        input.dropped_files.extend(dropped.map(|path| Arc::new(Dropped(path.to_owned())) as _));
        self.harness.step();
    }

    /// Lays the window out until something holds, for at most a minute.
    pub fn until(&mut self, what: &str, holds: impl Fn(&App) -> bool) {
        self.within(60, what, holds);
    }

    /// Lays the window out until something holds, for so many seconds at most.
    pub fn within(&mut self, seconds: u64, what: &str, holds: impl Fn(&App) -> bool) {
        let begin = Instant::now();
        while !holds(self.app()) {
            assert!(begin.elapsed() < Duration::from_secs(seconds), "never: {what}");
            self.pass(Vec::new(), None);
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    pub fn press(&mut self, key: egui::Key) {
        self.press_with(egui::Modifiers::NONE, key);
    }

    pub fn press_with(&mut self, modifiers: egui::Modifiers, key: egui::Key) {
        self.steps += 1;
        for pressed in [true, false] {
            let event = egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
            self.pass(vec![event], None);
        }
    }

    /// A control by its role and label; fails unless there is exactly one.
    pub fn control<'a>(&'a self, role: Role, label: &'a str) -> Node<'a> {
        self.harness.get_by_role_and_label(role, label)
    }

    /// Number of controls of a role.
    pub fn controls(&self, role: Role) -> usize {
        self.harness.query_all_by_role(role).count()
    }

    /// Controls without a name.
    pub fn unnamed(&self) -> Vec<String> {
        self.harness.unnamed_widgets()
    }

    /// Opens or closes a section of the panel.
    pub fn toggle(&mut self, label: &str) {
        self.steps += 1;
        self.control(Role::DisclosureTriangle, label).click_accesskit();
        self.harness.step();
    }

    /// Clicks a button.
    pub fn click(&mut self, label: &str) {
        self.steps += 1;
        self.control(Role::Button, label).click_accesskit();
        self.harness.step();
    }

    /// Clicks a label with the right button.
    pub fn right_click(&mut self, label: &str) {
        self.steps += 1;
        let place = self.control(Role::Label, label).rect().center();
        for pressed in [true, false] {
            let press = egui::Event::PointerButton {
                pos: place,
                button: egui::PointerButton::Secondary,
                pressed,
                modifiers: egui::Modifiers::NONE,
            };
            self.pass(vec![egui::Event::PointerMoved(place), press], None);
        }
    }

    /// Sets a slider to a value.
    pub fn slide(&mut self, label: &str, value: f64) {
        self.steps += 1;
        self.control(Role::Slider, label).set_value_accesskit(value);
        self.harness.step();
    }

    /// Sets the first of several sliders of a name to a value.
    pub fn slide_first(&mut self, label: &str, value: f64) {
        self.steps += 1;
        let slider = self.harness.query_all_by_role_and_label(Role::Slider, label).next();
        slider.expect(label).set_value_accesskit(value);
        self.harness.step();
    }

    /// True where there is a button with this name.
    pub fn has_button(&self, label: &str) -> bool {
        self.harness.query_by_role_and_label(Role::Button, label).is_some()
    }

    /// True where a label with this text is seen.
    pub fn has_label(&self, text: &str) -> bool {
        self.harness.query_all_by_label(text).next().is_some()
    }

    /// True where a label that contains this text is seen.
    pub fn shows(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }

    /// Types a value into the field beside a slider.
    pub fn type_into(&mut self, label: &str, text: &str) {
        let slider = self.control(Role::Slider, label).rect();
        let field = self.harness.query_all_by_role(Role::SpinButton);
        let field = field.filter(|node| (node.rect().center().y - slider.center().y).abs() < 4.0);
        let place = field.map(|node| node.rect().center()).next().expect("a field beside the slider");
        self.type_in(place, text);
    }

    /// Types a value into a field with a label.
    pub fn type_at(&mut self, role: Role, label: &str, text: &str) {
        let place = self.control(role, label).rect().center();
        self.type_in(place, text);
    }

    /// Clicks the last of several fields of a label and types in place of its own value, without an end.
    pub fn begin_typing_last(&mut self, role: Role, label: &str, text: &str) {
        let field = self.harness.query_all_by_role_and_label(role, label).last();
        let place = field.expect(label).rect().center();
        self.type_over(place, text);
    }

    /// Clicks a field and types a value in place of its own: one step.
    fn type_in(&mut self, place: egui::Pos2, text: &str) {
        let steps = self.steps + 1;
        self.type_over(place, text);
        self.press(egui::Key::Enter);
        self.steps = steps;
    }

    fn type_over(&mut self, place: egui::Pos2, text: &str) {
        self.pass(vec![egui::Event::PointerMoved(place), button(place, true)], None);
        self.pass(vec![button(place, false)], None);
        self.pass(Vec::new(), None);
        self.press_with(egui::Modifiers::COMMAND, egui::Key::A);
        self.pass(vec![egui::Event::Text(text.to_owned())], None);
    }

    /// True where the panels are dark.
    pub fn is_dark(&self) -> bool {
        self.harness.ctx.theme() == egui::Theme::Dark
    }

    /// Drags with the left button from one place to another.
    pub fn drag(&mut self, from: egui::Pos2, to: egui::Pos2) {
        self.steps += 1;
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
