//! Buttons that save the shown picture, scene and film.

use eframe::egui::{self, DragValue, Ui};
use strandline::{Target, What};

use crate::{App, controls::button, files::Wanted};

pub fn show(app: &mut App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if button(ui, "Picture", "as PNG into out/, in full: ctrl P") {
            app.save_picture(None);
        }
        if button(ui, "as...", "as PNG, to a place of your choice") {
            app.ask(Wanted::Picture, ui.ctx());
        }
    });
    ui.horizontal(|ui| {
        let tip = "a TOML scene that begins as shown, with the hair's pose beside it, into out/: ctrl S";
        if button(ui, "Scene", tip) {
            app.save_scene(None);
        }
        if button(ui, "as...", "the same, to a place of your choice") {
            app.ask(Wanted::Scene, ui.ctx());
        }
    });
    ui.horizontal(|ui| {
        let tip = "a folder with the scene and its kept frames, into out/: where it is opened they are there at once";
        if button(ui, "Project", tip) {
            app.save_project(None);
        }
        if button(ui, "as...", "the same, into a folder of your choice") {
            app.ask(Wanted::Project, ui.ctx());
        }
        if let Some(share) = app.saves.project {
            ui.add(egui::ProgressBar::new(share).desired_width(80.0).show_percentage());
        }
    });
    moving(app, ui);
}

/// Moving hair: a range of the film, which strands, for whom.
fn moving(app: &mut App, ui: &mut Ui) {
    if let Some(export) = &app.exporting {
        ui.add(egui::ProgressBar::new(export.share()).show_percentage());
        if button(ui, "Stop", "ends the file; written frames stay") {
            app.export(None);
        }
        return;
    }
    let wanted = &mut app.export_wanted;
    ui.horizontal(|ui| {
        for (value, name) in [(&mut wanted.from, "from"), (&mut wanted.to, "to")] {
            let tip = "time of the film; it is simulated from its beginning, with the current scene";
            ui.label(name);
            ui.add(DragValue::new(value).range(0.0..=3600.0).speed(0.05).suffix(" s")).on_hover_text(tip);
        }
        ui.label("every");
        let tip = "every n-th frame of these";
        ui.add(DragValue::new(&mut wanted.every).range(1..=1000).speed(0.05)).on_hover_text(tip);
    });
    ui.horizontal(|ui| {
        for what in What::ALL {
            ui.radio_value(&mut wanted.what, what, what.name()).on_hover_text("strands that are written");
        }
    });
    ui.horizontal(|ui| {
        for target in Target::ALL {
            ui.radio_value(&mut wanted.target, target, target.name())
                .on_hover_text("units and axes of a .usda");
        }
    });
    let tip = "the frames from in to out as they are kept, without simulating them again, into out/";
    if button(ui, "Kept frames", tip) {
        app.export_kept(None);
    }
    ui.horizontal(|ui| {
        let tip = "into out/: as a moving cache (.npz) for any, as text USD (.usda) for a program";
        if button(ui, "Moving hair", tip) {
            app.export(None);
        }
        if button(ui, "as...", "as .npz or .usda, or a groom file a frame, to a place of your choice") {
            app.ask(Wanted::Moving, ui.ctx());
        }
    });
}
