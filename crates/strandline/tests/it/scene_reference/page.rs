//! docs/scene.md, written from the settings table.

use std::fmt::Write;

use glam::Vec3;
use strandline::{
    Light, Scene, Style,
    look::GroupLook,
    scene::{
        BodyPart, CapsuleSection, ColliderSection, GroomPart, KeyframeSection, SphereSection, TeleportSection,
    },
    settings::{Group, Kind, Row, Table, rods::GroupSettings},
};

const HEAD: &str = r#"# Scene files

<!-- Written by `cargo xtask docs` from the settings table in the code: change it there. -->

A scene is one TOML file: groom, body, motion, colliders, simulation, look, camera, lights, picture and film. Every key has a default, which holds where the key or its whole section is left out; unknown keys, and values outside their range, are refused by name before anything is loaded. Paths are relative to the file. `strandline scene demo` prints the demo, which is what an empty file says, with every key spelled out.

Units are SI: metres, seconds, kilograms, radians unless a key says otherwise. y is up and the face looks along +z; a vector is `[x, y, z]`, a colour `[r, g, b]` in linear RGB. Both ends of a range are allowed; the range of a vector or a list is that of each of its numbers.

```toml
[style]
style = "wavy"
strand_count = 1500

[motion]
name = "nod"

[[colliders]]
shape = "sphere"
center = [0.0, -0.1, 0.3]
radius = 0.05

[camera]
view = "front"

[film]
frames = 60
```

"#;

const OLD: &str = "\n## Keys of older files

`simulation.backend` and `picture.backend` are read as `devices.simulation` and `devices.pictures`, which win where both are given.

`iterations`, `mass_per_length`, `springs`, `angles` and `length_pass` of `[simulation]` are read as those of `[simulation.strands.constrain]`, likewise; `first_highlight`, `second_highlight`, `sparkle` and `translucency` of `[look]` as those of `[look.fibre.scheuermann]`.

`simulation.angles.hold`, a rate at which segments turned back to their style, is refused: rods keep a style by the stiffness of hair (`[simulation.strands.rods]`). Scenes that move hair by springs and rounds of constraints say `method = \"constrain\"` in `[simulation.strands]`.
";

/// The whole page.
pub fn written() -> String {
    let mut page = HEAD.to_owned();
    page.push_str(&styles());
    let defaults: toml::Table = Scene::default().to_toml().parse().unwrap();
    section(&mut page, &Scene::TABLE, "", &defaults, 2);
    page.push_str(OLD);
    page
}

/// Settings of a style beside strands.
fn styles() -> String {
    let mut text = "Without a groom file the `[style]` is grown, and two keys of other sections take their default from it:\n\n\
                    | style | `groom.points_per_strand` | `level_of_detail.segments_per_span` |\n|---|---|---|\n"
        .to_owned();
    let mut line = |name: &str, scene: &Scene| {
        let (points, segments) = (scene.groom.points_per_strand, scene.level_of_detail.segments_per_span);
        writeln!(text, "| {name} | {points} | {segments} |").unwrap();
    };
    for style in Style::ALL {
        let mut scene = Scene::demo();
        scene.set_style(style);
        line(&format!("`{}`", style.name()), &scene);
    }
    line("with a groom file", &Scene::parse("groom.file = \"a.hair\"", "scene").unwrap());
    text
}

/// The settings of a section and those of the sections in it.
fn section(page: &mut String, table: &Table, path: &str, defaults: &toml::Table, depth: usize) {
    let inner = |row: &Row| matches!(row.kind, Kind::Group(_) | Kind::List(_));
    if table.rows.iter().any(|row| !inner(row)) {
        page.push_str("\n| key | default | range | meaning |\n|---|---|---|---|\n");
    }
    for row in table.rows.iter().filter(|row| !inner(row)) {
        let default = defaults.get(row.name).map_or_else(|| "none".to_owned(), shown);
        let default = if row.required { "required".to_owned() } else { default };
        writeln!(page, "| `{}` | {default} | {} | {} |", row.name, range(row), meaning(row)).unwrap();
    }
    for row in table.rows.iter().filter(|row| inner(row)) {
        let path = if path.is_empty() { row.name.to_owned() } else { format!("{path}.{}", row.name) };
        let (table, heading, own) = match row.kind {
            Kind::Group(table) => {
                let own = defaults.get(row.name).and_then(|own| own.as_table().cloned());
                (table, format!("[{path}]"), own.unwrap_or_default())
            }
            Kind::List(items) => (items.table(), format!("[[{path}]]"), item(&path)),
            _ => unreachable!("only sections are left"),
        };
        writeln!(page, "\n{} `{heading}`\n\n{}", "#".repeat(depth), row.sentence()).unwrap();
        section(page, table, &path, &own, depth + 1);
    }
}

/// The defaults of an item of a list, by the whole key of the list.
fn item(list: &str) -> toml::Table {
    let defaults = match list {
        "groom.parts" => toml::Table::try_from(GroomPart::default()),
        "body.parts" => toml::Table::try_from(BodyPart::default()),
        "body.teleports" | "body.parts.teleports" | "motion.teleports" => {
            toml::Table::try_from(TeleportSection::default())
        }
        "motion.keyframes" | "colliders.keyframes" => toml::Table::try_from(KeyframeSection::default()),
        "wind.keyframes" => toml::Table::try_from(strandline::scene::WindKeyframe::default()),
        "wind.sources" => toml::Table::try_from(strandline::scene::WindSource::default()),
        "ties" => toml::Table::try_from(strandline::scene::TieSection::default()),
        "strokes" => toml::Table::try_from(strandline::settings::Stroke::default()),
        "camera.kept" => toml::Table::try_from(strandline::scene::KeptView::default()),
        "camera.keyframes" => toml::Table::try_from(strandline::scene::CameraKeyframe::default()),
        "colliders" => {
            let sphere = ColliderSection::Sphere(SphereSection { center: Vec3::ZERO, ..Default::default() });
            let capsule = ColliderSection::Capsule(CapsuleSection::default());
            let both = [sphere, capsule].map(|solid| toml::Table::try_from(solid).unwrap());
            return both.into_iter().flatten().collect();
        }
        "simulation.groups" => toml::Table::try_from(GroupSettings::default()),
        "look.group" => toml::Table::try_from(GroupLook::default()),
        "lights" => toml::Table::try_from(Light::default()),
        _ => panic!("{list}: nothing says what an item of this list is when a file says nothing"),
    };
    defaults.unwrap()
}

/// A default as a file has it, with no more digits than tell it from its neighbours.
fn shown(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(value) => match *value as f32 {
            small if small != 0.0 && small.abs() < 1e-3 => format!("{small:e}"),
            other => other.to_string(),
        },
        toml::Value::Array(items) => format!("[{}]", items.iter().map(shown).collect::<Vec<_>>().join(", ")),
        other => other.to_string(),
    }
}

fn range(row: &Row) -> String {
    match row.kind {
        Kind::Flag => "true, false".to_owned(),
        Kind::Words(words) => {
            words.iter().map(|word| format!("\"{}\"", word.name)).collect::<Vec<_>>().join(", ")
        }
        Kind::Text(form) => form.to_owned(),
        Kind::NumberOr(word) => format!("\"{word}\" or {}", row.limits()),
        Kind::Whole(1) if row.range.is_none() => "0 to 2^63 - 1".to_owned(),
        _ => row.limits(),
    }
}

/// The sentence of a setting, what its words mean, and what more of it does.
fn meaning(row: &Row) -> String {
    let mut text = row.sentence();
    if let Kind::Words(words) = row.kind {
        for word in words {
            write!(text, " \"{}\": {}", word.name, lower(&word.about())).unwrap();
        }
    }
    if !row.more.is_empty() {
        write!(text, " *More*: {}.", row.more).unwrap();
    }
    text
}

/// A sentence behind a colon.
fn lower(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}
