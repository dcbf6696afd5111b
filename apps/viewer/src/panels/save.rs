//! Buttons that save what is seen.

use eframe::egui::Ui;

use crate::{App, controls::button, files};

pub fn show(app: &mut App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if button(ui, "Picture", "as PNG into out/, in full: ctrl P") {
            app.save_picture(None);
        }
        if button(ui, "as...", "as PNG, to a place of your choice") {
            files::ask(app, files::Wanted::Picture, ui.ctx());
        }
    });
    ui.horizontal(|ui| {
        let tip = "the TOML that begins with what is seen, and the hair's pose beside it, into out/: ctrl S";
        if button(ui, "Scene", tip) {
            app.save_scene(None);
        }
        if button(ui, "as...", "the same, to a place of your choice") {
            files::ask(app, files::Wanted::Scene, ui.ctx());
        }
    });
}
