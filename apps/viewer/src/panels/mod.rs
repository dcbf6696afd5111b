//! The controls beside the picture.

mod detail;
mod lights;
mod look;
mod motion;
mod save;
mod scene;
mod simulation;

use eframe::egui::{self, Ui};
use strandline::{Change, live::Command};

use crate::{
    App,
    controls::{button, section},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    egui::ScrollArea::vertical().show(ui, |ui| {
        play(app, ui);
        section(ui, "Scene", true, |ui| scene::show(app, ui));
        section(ui, "Motion", true, |ui| motion::show(app, ui));
        section(ui, "Simulation", false, |ui| simulation::show(app, ui));
        section(ui, "Look", true, |ui| look::show(app, ui));
        section(ui, "Lights", false, |ui| lights::show(app, ui));
        section(ui, "Detail", false, |ui| detail::show(app, ui));
        section(ui, "Save", false, |ui| save::show(app, ui));
        section(ui, "Keys", false, keys);
    });
}

fn play(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        if button(ui, if app.playing { "Pause" } else { "Play" }, "stand still or play on: space") {
            app.play(!app.playing);
        }
        if button(ui, "Step", "one frame of 1/60 s: the full stop") {
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

fn keys(ui: &mut Ui) {
    let keys = [
        ("space", "play, pause"),
        (".", "one frame"),
        ("R", "back to rest"),
        ("G", "the mouse grabs, or orbits again"),
        ("arrows", "orbit; with shift pan"),
        ("+ and -", "nearer, farther"),
        ("F", "the view of the scene"),
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
