//! Controls with unit and default.

use std::ops::RangeInclusive;

use eframe::egui::{self, Response, Slider, SliderClamping, Ui, emath::Numeric};
use glam::Vec3;
use strandline::{
    edit::quantity,
    settings::{Kind, Row},
};

/// A section of the panel.
pub fn section(ui: &mut Ui, name: &str, open: bool, add: impl FnOnce(&mut Ui)) {
    egui::CollapsingHeader::new(name).default_open(open).show(ui, add);
}

/// A slider for a setting with a default, over the range that its row names; true when it was moved. A value
/// outside that range, as a scene may have it, stays until it is moved.
pub fn slide<N: Numeric>(ui: &mut Ui, value: (&mut N, N), row: &Row, name: &str) -> bool {
    let [least, most] = row.slider().map(N::from_f64);
    slide_of(ui, value, least..=most, (name, row.unit), &about(row))
}

/// A slider for a value that is no setting.
pub fn slide_in<N: Numeric>(
    ui: &mut Ui,
    value: (&mut N, N),
    range: RangeInclusive<N>,
    name: &str,
    tip: &str,
) -> bool {
    slide_of(ui, value, range, (name, ""), tip)
}

/// A slider for a value with a unit, which may be typed with another: `3cm`.
fn slide_of<N: Numeric>(
    ui: &mut Ui,
    (value, default): (&mut N, N),
    range: RangeInclusive<N>,
    (name, unit): (&str, &'static str),
    tip: &str,
) -> bool {
    let slider = Slider::new(value, range).text(name).clamping(SliderClamping::Edits);
    let slider = slider.custom_parser(move |text| quantity(text, unit));
    let response = ui.add(slider).on_hover_text(tip_of(tip, &number(default.to_f64())));
    set_back(ui, &response, (value, default)) || response.changed()
}

/// Meaning of a setting, its unit, and the effect of a larger value.
pub fn about(row: &Row) -> String {
    let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
    let more = if row.more.is_empty() { String::new() } else { format!("\nmore: {}", row.more) };
    format!("{}{unit}{more}", row.sentence())
}

/// A box to tick for a setting; true when it changed.
pub fn tick(ui: &mut Ui, value: (&mut bool, bool), row: &Row, name: &str) -> bool {
    tick_of(ui, value, name, &about(row))
}

/// A check box for a value that is no setting.
pub fn tick_of(ui: &mut Ui, (value, default): (&mut bool, bool), name: &str, tip: &str) -> bool {
    let response = ui.checkbox(value, name);
    let response = response.on_hover_text(tip_of(tip, if default { "on" } else { "off" }));
    set_back(ui, &response, (value, default)) || response.changed()
}

/// A list of the words that a setting may be; true when it changed.
pub fn choose<C: Copy + PartialEq>(
    ui: &mut Ui,
    (value, default): (&mut C, C),
    choices: &[C],
    row: &Row,
    name: &str,
) -> bool {
    let Kind::Words(words) = row.kind else { unreachable!("{} is no choice", row.name) };
    let word = |choice: C| choices.iter().position(|other| *other == choice).map_or("", |at| words[at].name);
    let before = *value;
    let list = egui::ComboBox::from_label(name).selected_text(word(before));
    let response = list.show_ui(ui, |ui| {
        for (choice, word) in choices.iter().zip(words) {
            ui.selectable_value(value, *choice, word.name).on_hover_text(word.about());
        }
    });
    let response = response.response.on_hover_text(tip_of(&about(row), word(default)));
    set_back(ui, &response, (value, default)) || *value != before
}

/// A colour, linear RGB; true when it changed.
pub fn colour(ui: &mut Ui, (value, default): (&mut Vec3, Vec3), row: &Row, name: &str) -> bool {
    ui.horizontal(|ui| {
        let mut rgb = value.to_array();
        let response = ui.color_edit_button_rgb(&mut rgb);
        let [red, green, blue] = default.to_array().map(|part| number(f64::from(part)));
        let response = response.on_hover_text(tip_of(&about(row), &format!("{red}, {green}, {blue}")));
        ui.label(name);
        let changed = response.changed();
        if changed {
            *value = rgb.into();
        }
        set_back(ui, &response, (value, default)) || changed
    })
    .inner
}

/// A button with a tip; true when it was pressed.
pub fn button(ui: &mut Ui, name: &str, tip: &str) -> bool {
    ui.button(name).on_hover_text(tip).clicked()
}

fn tip_of(tip: &str, default: &str) -> String {
    format!("{tip}\ndefault {default}; a right click sets it")
}

/// Sets a value to its default at a right click; true when it did.
fn set_back<T>(ui: &Ui, response: &Response, (value, default): (&mut T, T)) -> bool {
    let wanted = response.contains_pointer() && ui.input(|input| input.pointer.secondary_clicked());
    if wanted {
        *value = default;
    }
    wanted
}

/// A number with no more digits than a person reads.
pub fn number(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [(0.0, "0"), (20.0, "20"), (0.95, "0.95"), (-9.81, "-9.81"), (2e-5, "2.0e-5")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!(number(f64::from(0.3_f32)), "0.3");
    }
}
