//! A field that finds any setting by its name or its sentence, and changes it in place.

use eframe::egui::{self, DragValue, Ui};
use strandline::edit::{Found, Value, find, quantity, value, with_value};
use strandline::settings::Kind;

use crate::{App, controls::about};

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
    let found: Vec<Found> = finding.found.iter().take(MOST).cloned().collect();
    for found in &found {
        if let Some(changed) = row(app, found, ui) {
            match with_value(&app.scene, &found.key, changed) {
                Ok(scene) => app.restore(scene),
                Err(error) => app.error = Some(error.to_string()),
            }
        }
    }
    let more = app.finding.found.len().saturating_sub(MOST);
    if more > 0 {
        ui.small(format!("and {more} more: add a word"));
    } else if found.is_empty() && !app.finding.words.trim().is_empty() {
        ui.small("no setting has all of these words");
    }
}

/// A setting with its value. Returns another value where it was changed.
fn row(app: &mut App, found: &Found, ui: &mut Ui) -> Option<Value> {
    let now = value(&app.scene, &found.key);
    let tip = about(found.row);
    ui.horizontal_wrapped(|ui| {
        let changed = match (found.row.kind, now) {
            (Kind::Number(1) | Kind::Whole(1), Some(value)) => number(app, found, &value, ui),
            (Kind::Flag, Some(Value::Boolean(mut flag))) => {
                ui.checkbox(&mut flag, "").changed().then_some(Value::Boolean(flag))
            }
            (Kind::Words(words), Some(Value::String(mut word))) => {
                let before = word.clone();
                let list = egui::ComboBox::from_id_salt(&found.key).selected_text(&word);
                list.show_ui(ui, |ui| {
                    for choice in words {
                        ui.selectable_value(&mut word, choice.name.to_owned(), choice.name);
                    }
                });
                (word != before).then_some(Value::String(word))
            }
            (_, Some(value)) => {
                ui.small(value.to_string());
                None
            }
            (_, None) => {
                ui.small("not given");
                None
            }
        };
        ui.label(&found.key).on_hover_text(tip);
        changed
    })
    .inner
}

/// A number that is dragged or typed; it counts when the mouse or the field lets go.
fn number(app: &mut App, found: &Found, value: &Value, ui: &mut Ui) -> Option<Value> {
    let is_whole = matches!(value, Value::Integer(_));
    let now = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))?;
    let edited = app.finding.edited.as_ref().filter(|(key, _)| *key == found.key);
    let mut number = edited.map_or(now, |(_, number)| *number);
    let [least, most] = found.row.range.unwrap_or([f64::MIN, f64::MAX]);
    let [from, to] = found.row.slider();
    let unit = found.row.unit;
    let field = DragValue::new(&mut number).range(least..=most).clamp_existing_to_range(false);
    let field = field.speed(if is_whole { 0.2 } else { (to - from) / 300.0 }).max_decimals(6);
    let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let response = ui.add(field.suffix(suffix).custom_parser(move |text| quantity(text, unit)));
    if response.changed() {
        app.finding.edited = Some((found.key.clone(), number));
    }
    let rests = !response.dragged() && !response.has_focus();
    let (_, number) = app.finding.edited.take_if(|(key, _)| rests && *key == found.key)?;
    Some(if is_whole { Value::Integer(number.round() as i64) } else { Value::Float(number) })
}
