//! A row for any setting of a scene: its value, to be changed in place, and its name.

use eframe::egui::{self, DragValue, Id, TextEdit, Ui, WidgetInfo, accesskit::Role};
use strandline::{
    edit::{SettingMatch, Value, Values, quantity, with_value},
    settings::{Kind, Row, Word},
};

use crate::{App, controls::about, found::Edited};

/// Name of a value that a scene does not give.
const ABSENT: &str = "not given";

/// Shows a setting by a name, and changes the scene where the row's value was changed. A right click on the name leaves
/// the setting out of the scene, which then has its default.
pub fn show(app: &mut App, found: &SettingMatch, values: &Values, name: &str, ui: &mut Ui) {
    let now = values.get(&found.key);
    let row = ui.scope_id().with(&found.key);
    let changed = ui.horizontal_wrapped(|ui| {
        let changed = match (found.row.kind, now) {
            (Kind::Number(1) | Kind::Whole(1), Some(value)) => number(app, (row, found), value, ui).map(Some),
            (Kind::Flag, Some(Value::Boolean(flag))) => tick(*flag, name, ui),
            (Kind::Flag, _) => choice(found, &FLAGS, None, ui),
            (Kind::Words(words), now) => choice(found, words, now.and_then(Value::as_str), ui),
            (_, now) => text(app, (row, found), now, ui),
        };
        let tip = format!("{}\na right click sets the default", about(found.row));
        let label = ui.add(egui::Label::new(name).sense(egui::Sense::click())).on_hover_text(tip);
        if label.secondary_clicked() { Some(None) } else { changed }
    });
    let Some(changed) = changed.inner else { return };
    match with_value(&app.scene, &found.key, changed) {
        Ok(scene) if scene == app.scene => {}
        Ok(scene) => app.apply(scene),
        Err(error) => app.error = Some(error.to_string()),
    }
}

/// Words of a flag that a scene may leave out.
static FLAGS: [Word; 2] = [Word::new("yes", ""), Word::new("no", "")];

fn tick(mut flag: bool, name: &str, ui: &mut Ui) -> Option<Option<Value>> {
    let response = ui.checkbox(&mut flag, "");
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, flag, name));
    response.changed().then_some(Some(Value::Boolean(flag)))
}

/// A list of words, one of which is the present one.
fn choice(found: &SettingMatch, words: &[Word], now: Option<&str>, ui: &mut Ui) -> Option<Option<Value>> {
    let mut chosen = now;
    let list = egui::ComboBox::from_id_salt(&found.key).selected_text(now.unwrap_or(ABSENT));
    list.show_ui(ui, |ui| {
        for word in words {
            ui.selectable_value(&mut chosen, Some(word.name), word.name).on_hover_text(word.about());
        }
    });
    let chosen = chosen.filter(|_| chosen != now)?;
    let flag = found.row.kind == Kind::Flag;
    Some(Some(if flag { Value::Boolean(chosen == "yes") } else { Value::String(chosen.to_owned()) }))
}

/// A number that is dragged or typed; it counts when the mouse or the field lets go.
fn number(app: &mut App, (row, found): (Id, &SettingMatch), value: &Value, ui: &mut Ui) -> Option<Value> {
    let is_whole = matches!(value, Value::Integer(_));
    let now = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))?;
    let mut number = match &app.finding.edited {
        Some((of, Edited::Number(number))) if *of == row => *number,
        _ => now,
    };
    let [least, most] = found.row.range.unwrap_or([f64::MIN, f64::MAX]);
    let [from, to] = found.row.slider();
    let unit = found.row.unit;
    let field = DragValue::new(&mut number).range(least..=most).clamp_existing_to_range(false);
    let field = field.speed(if is_whole { 0.2 } else { (to - from) / 300.0 });
    let field = field.max_decimals(if is_whole { 0 } else { 6 });
    let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let response = ui.add(field.suffix(suffix).custom_parser(move |text| quantity(text, unit)));
    response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &found.key));
    if response.changed() {
        app.finding.edited = Some((row, Edited::Number(number)));
    }
    let rests = !response.dragged() && !response.has_focus();
    let is_of = |edited: &mut (Id, Edited)| rests && edited.0 == row;
    let Some((_, Edited::Number(number))) = app.finding.edited.take_if(is_of) else { return None };
    Some(if is_whole { Value::Integer(number.round() as i64) } else { Value::Float(number) })
}

/// A value that is typed: a vector, a path, a name, a number that may be missing. It counts when the field lets go;
/// nothing in it leaves the setting out.
fn text(
    app: &mut App,
    (row, found): (Id, &SettingMatch),
    now: Option<&Value>,
    ui: &mut Ui,
) -> Option<Option<Value>> {
    let written = now.map_or_else(String::new, written);
    let mut text = match &app.finding.edited {
        Some((of, Edited::Text(text))) if *of == row => text.clone(),
        _ => written.clone(),
    };
    let field = TextEdit::singleline(&mut text).hint_text(ABSENT).desired_width(110.0);
    let response = ui.add(field.id_salt(&found.key));
    response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &found.key));
    if response.changed() {
        app.finding.edited = Some((row, Edited::Text(text)));
    }
    let is_of = |edited: &mut (Id, Edited)| !response.has_focus() && edited.0 == row;
    let Some((_, Edited::Text(text))) = app.finding.edited.take_if(is_of) else { return None };
    if text.trim() == written {
        return None;
    }
    let value = read(found.row, text.trim());
    if value.is_none() {
        app.error = Some(format!("{} must be {}, not {text}", found.key, found.row.expected()));
    }
    value
}

/// A value as a person reads it.
fn written(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => (*number as f32).to_string(),
        Value::Array(items) => items.iter().map(written).collect::<Vec<_>>().join(", "),
        other => other.to_string(),
    }
}

/// The value of a setting that a text stands for, `Some(None)` for an empty text; `None` where it stands for none.
fn read(row: &Row, text: &str) -> Option<Option<Value>> {
    if text.is_empty() {
        return Some(None);
    }
    let number = |text: &str| quantity(text, row.unit).map(Value::Float);
    let whole = |text: &str| text.trim().parse().ok().map(Value::Integer);
    Some(Some(match row.kind {
        Kind::Number(1) => number(text)?,
        Kind::Whole(1) => whole(text)?,
        Kind::Number(count) => several(text, count, number)?,
        Kind::Whole(count) => several(text, count, whole)?,
        Kind::NumberOr(word) if text.eq_ignore_ascii_case(word) => Value::String(word.to_owned()),
        Kind::NumberOr(_) => number(text)?,
        _ => Value::String(text.to_owned()),
    }))
}

/// As many values, with commas or blanks between them.
fn several(text: &str, count: usize, one: impl Fn(&str) -> Option<Value>) -> Option<Value> {
    let text = text.trim_matches(['[', ']']);
    let parts: Vec<&str> =
        if text.contains(',') { text.split(',').collect() } else { text.split_whitespace().collect() };
    let values: Vec<Value> = parts.into_iter().map_while(one).collect();
    (values.len() == count).then_some(Value::Array(values))
}

#[cfg(test)]
mod tests {
    use strandline::edit::settings_of;

    use super::*;

    #[test]
    fn typed_values_are_read_by_the_kind_of_their_setting() {
        let all: Vec<SettingMatch> = ["groom", "body", "camera"].into_iter().flat_map(settings_of).collect();
        let row = |key: &str| all.iter().find(|found| found.key == key).unwrap().row;
        let text = |text: &str| Some(Some(Value::String(text.to_owned())));
        let floats = |numbers: [f64; 3]| Some(Some(numbers.map(Value::Float).to_vec().into()));
        for (key, typed, wanted) in [
            ("groom.file", "hair.tfx", text("hair.tfx")),
            ("groom.file", "", Some(None)),
            ("groom.guides", "500", Some(Some(Value::Integer(500)))),
            ("groom.guides", "many", None),
            ("groom.scale", "AUTO", text("auto")),
            ("groom.scale", "1cm", Some(Some(Value::Float(0.01)))),
            ("groom.rotation", "90, 0, 0.5 turns", floats([90.0, 0.0, 180.0])),
            ("groom.rotation", "[90 0 0]", floats([90.0, 0.0, 0.0])),
            ("groom.rotation", "90, 0", None),
            ("groom.rotation", "90, 0, x", None),
            ("camera.field_of_view", "30", Some(Some(Value::Float(30.0)))),
        ] {
            assert_eq!(read(row(key), typed), wanted, "{key} = {typed}");
        }
        assert_eq!(written(&vec![Value::Float(0.1), Value::Float(-2.0)].into()), "0.1, -2");
    }
}
