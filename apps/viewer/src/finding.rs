//! A field that finds any setting by its name or its sentence, and changes it in place.

use eframe::egui::{self, Ui};
use strandline::edit::{SettingMatch, Values, find};

use crate::{App, setting_row};

/// Settings that are shown at once.
const MOST: usize = 12;

pub fn show(app: &mut App, ui: &mut Ui) {
    let field = egui::TextEdit::singleline(&mut app.finding.words).hint_text("find a setting");
    let response = ui.add(field.desired_width(f32::INFINITY));
    response
        .widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, "find a setting"));
    response.on_hover_text("words of its name or its sentence: any setting of a scene\ndefault none");
    let finding = &mut app.finding;
    if finding.words != finding.looked_for {
        finding.looked_for.clone_from(&finding.words);
        finding.found = find(&finding.words);
    }
    let found: Vec<SettingMatch> = finding.found.iter().take(MOST).cloned().collect();
    if !found.is_empty() {
        let values = Values::of(&app.scene);
        found.iter().for_each(|found| setting_row::show(app, found, &values, &found.key, ui));
    }
    let more = app.finding.found.len().saturating_sub(MOST);
    if more > 0 {
        ui.small(format!("and {more} more: add a word"));
    } else if found.is_empty() && !app.finding.words.trim().is_empty() {
        ui.small("no setting has all of these words");
    }
}
