//! Controls of the scene: styles, scenes and files.

use eframe::egui::{self, Ui};
use strandline::{Scene, Style};

use crate::{
    App,
    controls::{button, tick_of},
    files::Wanted,
    path_field, thumbnails,
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let mut chosen = app.scene.style.style;
    let grown = app.scene.groom.file.is_none();
    let menu =
        egui::ComboBox::from_label("style").selected_text(if grown { chosen.name() } else { "from a file" });
    let mut picked = false;
    let menu = menu.show_ui(ui, |ui| {
        for style in Style::ALL {
            ui.horizontal(|ui| {
                ui.add(thumbnails::style(style, ui));
                picked |= ui.selectable_value(&mut chosen, style, style.name()).clicked();
            });
        }
    });
    menu.response.on_hover_text(format!("grown on the head\ndefault {}", app.base.style.style.name()));
    if picked && (!grown || chosen != app.scene.style.style) {
        let mut scene = app.own_scene();
        scene.groom.file = None;
        scene.groom.parts.clear();
        scene.set_style(chosen);
        app.load(scene);
    }
    ui.horizontal(|ui| {
        for (name, make) in [("demo", Scene::demo as fn() -> Scene), ("thesis", Scene::thesis)] {
            if button(ui, name, "a scene of the program's own") {
                app.load(make());
            }
        }
        if button(ui, "Open...", "a scene, groom or body: ctrl O") {
            app.ask(Wanted::Open, ui.ctx());
        }
        if button(ui, "Project...", "a folder that Save > Project wrote, with its kept frames") {
            app.ask(Wanted::OpenProject, ui.ctx());
        }
    });
    if !app.recent.files().is_empty() {
        let mut chosen = None;
        let list = egui::ComboBox::from_label("recent").selected_text("files");
        let list = list.show_ui(ui, |ui| {
            for file in app.recent.files() {
                let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                if ui.selectable_label(false, name).on_hover_text(file.display().to_string()).clicked() {
                    chosen = Some(file.clone());
                }
            }
        });
        list.response.on_hover_text("files that were opened lately\ndefault none");
        if let Some(file) = chosen {
            app.open_file(&file);
        }
    }
    path_field::show(app, ui);
    let before = app.watch.on;
    let tip = "files of the scene that change on disk are loaded again: --watch";
    tick_of(ui, (&mut app.watch.on, false), "watch files", tip);
    if app.watch.on && !before {
        app.watch(None);
    }
    ui.small("Drop a .toml scene, the folder of a project, a groom (.hair, .tfx, .ply, .npz ...) or a body (.obj, .glb, .stl ...) on the window.");
}
