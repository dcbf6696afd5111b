//! The controls beside the picture.

mod detail;
mod items;
mod lights;
mod look;
mod motion;
mod save;
mod scene;
mod simulation;
mod table;

use eframe::egui::{self, ThemePreference, Ui};
use strandline::{Change, live::Command};

use crate::{
    App, brushing, compare,
    controls::{button, section},
    finding, keys, looks,
    undoing::{self, ScenePart},
};

/// Room of a number and a name beside a slider \[point\].
const BESIDE_SLIDERS: f32 = 220.0;

pub fn show(app: &mut App, ui: &mut Ui) {
    egui::ScrollArea::vertical().show(ui, |ui| {
        // A wider panel gives its room to the sliders.
        ui.spacing_mut().slider_width = (ui.available_width() - BESIDE_SLIDERS).max(100.0);
        play(app, ui);
        finding::show(app, ui);
        section(ui, "Scene", true, |ui| scene::show(app, ui));
        panel(app, ui, "Groom", false, ScenePart::Groom, table::groom);
        panel(app, ui, "Body", false, ScenePart::Body, table::body);
        section(ui, "Brushes", false, |ui| brushing::panel(app, ui));
        panel(app, ui, "Motion", true, ScenePart::Motion, motion::show);
        panel(app, ui, "Simulation", false, ScenePart::Simulation, simulation::show);
        panel(app, ui, "Look", true, ScenePart::Look, look::show);
        panel(app, ui, "Lights", false, ScenePart::Lights, lights::show);
        panel(app, ui, "Surroundings", false, ScenePart::Surroundings, table::surroundings);
        panel(app, ui, "Detail", false, ScenePart::Detail, detail::show);
        section(ui, "View", false, |ui| {
            looks::views(app, ui);
            keys::list(app, ui);
            compare::controls(app, ui);
        });
        panel(app, ui, "Film", false, ScenePart::Film, table::film);
        section(ui, "Save", false, |ui| save::show(app, ui));
        section(ui, "Steps", false, |ui| undoing::show(app, ui));
        section(ui, "Window", false, window);
        section(ui, "Keys", false, keyboard);
    });
}

/// A panel that can be set back.
fn panel(
    app: &mut App,
    ui: &mut Ui,
    name: &str,
    open: bool,
    part: ScenePart,
    show: impl FnOnce(&mut App, &mut Ui),
) {
    section(ui, name, open, |ui| {
        show(app, ui);
        ui.push_id(name, |ui| undoing::resets(app, ui, part));
    });
}

fn play(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        if button(ui, if app.playing { "Pause" } else { "Play" }, "stand still or play on: space") {
            app.play(!app.playing);
        }
        if button(ui, "Step", "one frame of the film: the full stop") {
            app.play(false);
            app.live.send(Command::Step);
        }
        if button(ui, "Reset", "back to rest, and to the beginning of the motion: R") {
            app.live.send(Change::Reset);
        }
        let (name, tip) = match app.recording {
            true => ("Stop recording", "finishes the video: V"),
            false => ("Record", "a video of every frame, in full, into out/: V"),
        };
        if button(ui, name, tip) {
            app.record();
        }
    });
}

/// Colours and size of the window's own controls.
fn window(ui: &mut Ui) {
    ui.horizontal(|ui| {
        let mut theme = ui.ctx().options(|options| options.theme_preference);
        let before = theme;
        for (value, name, tip) in [
            (ThemePreference::System, "as the system", "light or dark as the desktop says\ndefault"),
            (ThemePreference::Dark, "dark", "dark panels"),
            (ThemePreference::Light, "light", "light panels"),
        ] {
            ui.radio_value(&mut theme, value, name).on_hover_text(tip);
        }
        if theme != before {
            ui.ctx().set_theme(theme);
        }
    });
    ui.horizontal(|ui| {
        let factor = ui.ctx().zoom_factor();
        for (name, next, tip) in [
            ("smaller", factor / 1.1, "smaller texts and controls"),
            ("larger", factor * 1.1, "larger texts and controls, for displays with many pixels"),
            ("own size", 1.0, "the size that the display asks for"),
        ] {
            if button(ui, name, tip) {
                ui.ctx().set_zoom_factor(next.clamp(0.5, 4.0));
            }
        }
        ui.label(format!("{:.0} %", 100.0 * factor));
    });
}

fn keyboard(ui: &mut Ui) {
    let keys = [
        ("space", "play, pause"),
        (".", "one frame"),
        ("R", "back to rest"),
        ("G", "the mouse grabs, or orbits again"),
        ("left, right", "a frame back, a frame on"),
        ("down, up", "ten frames back, ten on"),
        ("Home, End", "the first and the last kept frame"),
        ("I, O", "the first, last frame that is played"),
        ("alt arrows", "orbit; with shift pan"),
        ("ctrl Z", "undo; with shift redo"),
        ("+ and -", "nearer, farther"),
        ("F", "the view of the scene"),
        ("L", "the next overlay"),
        ("V", "begin or end a video"),
        ("ctrl O", "open a file"),
        ("ctrl S", "save the scene"),
        ("ctrl P", "save the picture"),
    ];
    egui::Grid::new("keys").show(ui, |ui| {
        for (key, what) in keys {
            ui.strong(key);
            ui.label(what);
            ui.end_row();
        }
    });
}
