//! Clips of a body's glTF file, in a list.

use eframe::egui::{self, Ui};
use strandline::edit::{SettingMatch, Value, Values, with_value};

use crate::{App, controls::about, setting_row};

/// Name of no clip.
const NONE: &str = "no clip";

/// The row of a clip: a list of those of the file beside it, or a field where the file has none.
pub fn row(app: &mut App, found: &SettingMatch, values: &Values, ui: &mut Ui) {
    let file = found.key.strip_suffix("clip").and_then(|section| values.get(&format!("{section}file")));
    let file = file.and_then(Value::as_str).map(|file| app.scene.folder.join(file));
    let known = app.clips.entry(found.key.clone()).or_default();
    let names = match &file {
        Some(file) => known.of(file).to_vec(),
        None => Vec::new(),
    };
    if names.is_empty() {
        return setting_row::show(app, found, values, "clip", ui);
    }
    let now = values.get(&found.key).and_then(Value::as_str);
    let mut chosen = now;
    ui.horizontal(|ui| {
        let list = egui::ComboBox::from_label("clip").selected_text(now.unwrap_or(NONE));
        let list = list.show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, None, NONE);
            for name in &names {
                ui.selectable_value(&mut chosen, Some(name.as_str()), name.as_str());
            }
        });
        list.response.on_hover_text(about(found.row));
    });
    if chosen != now {
        match with_value(&app.scene, &found.key, chosen.map(|name| Value::String(name.to_owned()))) {
            Ok(scene) => app.apply(scene),
            Err(error) => app.error = Some(error.to_string()),
        }
    }
}
