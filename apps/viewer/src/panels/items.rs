//! Lists of a scene, item by item: solids, ties, looks of groups, further files.

use eframe::egui::{self, Ui};
use strandline::edit::{Table, Value, Values, items_of, with_item, without_item};

use crate::{App, clips, controls::button, setting_row};

/// A button that adds an item: its name, its tip, and the item as a file has it.
type Add = (&'static str, &'static str, fn(&App) -> Table);

/// Solids beside the body.
pub fn colliders(app: &mut App, ui: &mut Ui) {
    let ball: Add = ("Add ball", "a ball before the hair, which hair hits", |app| {
        solid(app, "sphere", &[("center", [0.0, 0.0, 0.2])])
    });
    let capsule: Add = ("Add capsule", "a segment with a radius before the hair, which hair hits", |app| {
        solid(app, "capsule", &[("start", [-0.1, 0.0, 0.2]), ("end", [0.1, 0.0, 0.2])])
    });
    show(app, ui, ("colliders", "solid"), &[ball, capsule]);
}

/// Bands about hair.
pub fn ties(app: &mut App, ui: &mut Ui) {
    let tie: Add = ("Add tie", "a band behind the hair: it holds the strands that pass through it", |app| {
        Table::from_iter([("position".to_owned(), place(app, [0.0, 0.0, -0.1]))])
    });
    show(app, ui, ("ties", "tie"), &[tie]);
}

/// Looks of groups of strands.
pub fn groups(app: &mut App, ui: &mut Ui) {
    let group: Add =
        ("Add group", "a look of one group of strands, by its name or number in the groom", |app| {
            let number = app.scene.look.group.len().to_string();
            Table::from_iter([("name".to_owned(), Value::String(number))])
        });
    show(app, ui, ("look.group", "group"), &[group]);
}

/// Further files of groom or body.
pub fn files(app: &mut App, ui: &mut Ui, key: &str) {
    show(app, ui, (key, "file"), &[]);
}

fn solid(app: &App, shape: &str, places: &[(&str, [f32; 3])]) -> Table {
    let mut table = Table::from_iter([
        ("shape".to_owned(), Value::String(shape.to_owned())),
        ("radius".to_owned(), Value::Float(0.05)),
    ]);
    table.extend(places.iter().map(|(name, beside)| ((*name).to_owned(), place(app, *beside))));
    table
}

/// A place beside the middle of hair and body \[m\], to the millimetre.
fn place(app: &App, beside: [f32; 3]) -> Value {
    let place = app.center + glam::Vec3::from(beside);
    place.to_array().map(|part| Value::Float((1e3 * f64::from(part)).round() / 1e3)).to_vec().into()
}

/// The items of a list with their settings, and buttons that add some. `one` is the name of an item without one.
fn show(app: &mut App, ui: &mut Ui, (list, one): (&str, &str), adds: &[Add]) {
    let values = Values::of(&app.scene);
    let mut changed = None;
    for (index, settings) in items_of(&values, list).iter().enumerate() {
        let item = format!("{list}[{index}]");
        ui.horizontal_top(|ui| {
            if button(ui, "x", "takes this out; ctrl Z brings it back") {
                changed = Some(without_item(&app.scene, list, index));
            }
            let title = title(&values, &item).map_or_else(
                || format!("{one} {}", index + 1),
                |name| format!("{one} {}: {name}", index + 1),
            );
            egui::CollapsingHeader::new(title).id_salt(&item).show(ui, |ui| {
                for found in settings {
                    let name = found.key[item.len() + 1..].replace('_', " ");
                    if list == "body.parts" && name == "clip" {
                        clips::row(app, found, &values, ui);
                    } else {
                        setting_row::show(app, found, &values, &name, ui);
                    }
                }
            });
        });
    }
    ui.horizontal(|ui| {
        for (name, tip, make) in adds {
            if button(ui, name, tip) {
                changed = Some(with_item(&app.scene, list, make(app)));
            }
        }
    });
    match changed {
        Some(Ok(scene)) => app.apply(scene),
        Some(Err(error)) => app.error = Some(error.to_string()),
        None => {}
    }
}

/// The words that name an item: its name, its file without folders, or its shape.
fn title<'a>(values: &'a Values, item: &str) -> Option<&'a str> {
    let of = |name: &str| values.get(&format!("{item}.{name}")).and_then(Value::as_str);
    let file = of("file").map(|file| file.rsplit(['/', '\\']).next().unwrap_or(file));
    of("name").or(file).or_else(|| of("shape"))
}
