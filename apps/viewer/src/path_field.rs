//! The field for the path of a file.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, TextEdit, Ui, accesskit::Role};

use crate::{App, controls::button};

/// The field with its completions; Tab takes what they have in common, Enter loads the file.
pub fn show(app: &mut App, ui: &mut Ui) {
    let mut wanted = None;
    let typed = &mut app.typed;
    ui.horizontal(|ui| {
        typed.look_up();
        let field = TextEdit::singleline(&mut typed.path).hint_text("path of a file").desired_width(180.0);
        let response = ui.add(field.lock_focus(!typed.offered.is_empty()));
        response.widget_info(|| egui::WidgetInfo::labeled(Role::TextInput, true, "path of a file"));
        let tabbed = response.has_focus() && ui.input(|input| input.key_pressed(Key::Tab));
        if response.changed() {
            typed.is_open = true;
            typed.look_up();
        }
        if tabbed && !typed.offered.is_empty() {
            typed.complete();
            to_end(ui, response.id, &typed.path);
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        response.on_hover_text("path of a scene, groom or body; Tab completes it\ndefault none");
        if button(ui, "Load", "loads the file") || entered {
            wanted = Some(typed.path.trim().to_owned());
        }
    });
    let offered = if typed.is_open { typed.offered.clone() } else { Vec::new() };
    for path in &offered {
        let (folder, name) = path.trim_end_matches('/').rsplit_once('/').unwrap_or(("", path));
        let name = format!("{name}{}", if path.len() > folder.len() + name.len() + 1 { "/" } else { "" });
        if ui.small_button(name).on_hover_text(path).clicked() {
            typed.path.clone_from(path);
            typed.look_up();
            let is_whole = !path.ends_with('/') || strandline::scene::is_file(Path::new(path));
            wanted = is_whole.then(|| path.clone());
        }
    }
    match wanted {
        Some(path) if path.is_empty() => {
            app.note("type the path of a file first, or drop one on the window".to_owned());
        }
        Some(path) => {
            app.typed.is_open = false;
            app.open_file(&PathBuf::from(path));
        }
        None => {}
    }
}

/// Puts the cursor of a field behind its text.
fn to_end(ui: &Ui, id: egui::Id, text: &str) {
    if let Some(mut state) = TextEdit::load_state(ui.ctx(), id) {
        let end = egui::text::CCursor::new(text.chars().count());
        state.cursor.set_char_range(Some(egui::text::CCursorRange::one(end)));
        state.store(ui.ctx(), id);
    }
}
