//! Panels of whole sections, setting by setting, from the settings table.

use std::path::PathBuf;

use eframe::egui::{self, Ui, WidgetInfo, accesskit::Role};
use strandline::{
    Scene,
    edit::{Values, settings_of},
    scene::GroomPart,
};

use super::items;
use crate::{App, clips, controls::button, files::Wanted, setting_row};

/// Files and strands: those of a groom, or of the style that is grown.
pub fn groom(app: &mut App, ui: &mut Ui) {
    open(app, ui, "a groom");
    let grown = app.scene.groom.file.is_none();
    // The length has a slider beside the motion.
    rows(app, ui, "groom", |name| name != "length");
    if !grown {
        let part = |scene: &mut Scene, file| scene.groom.parts.push(GroomPart { file, ..Default::default() });
        items::files(app, ui, "groom.parts");
        parts(app, ui, part);
    }
    items::ties(app, ui);
    if grown {
        ui.separator();
        rows(app, ui, "style", |name| name != "style");
    }
}

/// Files, clip and place of the body, and its colours.
pub fn body(app: &mut App, ui: &mut Ui) {
    open(app, ui, "a body");
    rows(app, ui, "body", |_| true);
    let part = |scene: &mut Scene, file| {
        scene.body.parts.push(strandline::scene::BodyPart { file, ..Default::default() });
    };
    items::files(app, ui, "body.parts");
    parts(app, ui, part);
    ui.separator();
    rows(app, ui, "body_look", |_| true);
}

/// The picture around hair and body, which lights them.
pub fn surroundings(app: &mut App, ui: &mut Ui) {
    rows(app, ui, "surroundings", |_| true);
}

/// Length, rate and beginning of the film, and its camera where no view is chosen by hand.
pub fn film(app: &mut App, ui: &mut Ui) {
    rows(app, ui, "film", |_| true);
    ui.separator();
    rows(app, ui, "camera", |_| true);
}

fn open(app: &mut App, ui: &mut Ui, what: &str) {
    if button(ui, "Open file...", &format!("{what} in place of this one; or drop its file on the window")) {
        app.ask(Wanted::Open, ui.ctx());
    }
}

/// The settings of a section whose names are wanted.
fn rows(app: &mut App, ui: &mut Ui, section: &str, is_wanted: impl Fn(&str) -> bool) {
    let values = Values::of(&app.scene);
    for found in settings_of(section) {
        let name = found.key[section.len() + 1..].to_owned();
        if found.key == "body.clip" {
            clips::row(app, &found, &values, ui);
        } else if is_wanted(&name) {
            setting_row::show(app, &found, &values, &name.replace('_', " "), ui);
        }
    }
}

/// A field for a further file.
fn parts(app: &mut App, ui: &mut Ui, add: impl Fn(&mut Scene, PathBuf)) {
    let mut changed = None;
    ui.horizontal(|ui| {
        let typed = ui.scope_id().with("part");
        let mut text: String = ui.data(|data| data.get_temp(typed)).unwrap_or_default();
        let field = egui::TextEdit::singleline(&mut text).hint_text("path of a file").desired_width(160.0);
        let response = ui.add(field.id(typed.with("field")));
        response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "path of a further file"));
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        response.on_hover_text("a further file of the same\ndefault none");
        let wanted = button(ui, "Add file", "loads it beside the others") || entered;
        if wanted && !text.trim().is_empty() {
            let path = PathBuf::from(text.trim());
            add(changed.get_or_insert_with(|| app.scene.clone()), std::path::absolute(&path).unwrap_or(path));
            text.clear();
        }
        ui.data_mut(|data| data.insert_temp(typed, text));
    });
    if let Some(scene) = changed {
        app.apply(scene);
    }
}
