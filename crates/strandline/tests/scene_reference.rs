//! docs/scene.md names every key of a scene file, and its example is a scene.

use strandline::{Scene, Style, groom::StyleSettings, render::Light, scene::KeyframeSection};

const REFERENCE: &str = include_str!("../../../docs/scene.md");

/// A scene with one of everything that is optional.
fn full() -> toml::Table {
    let mut scene = Scene::demo();
    scene.groom.file = Some("a.hair".into());
    scene.groom.pose = Some("a.safetensors".into());
    scene.body.file = Some("a.obj".into());
    scene.body.collider_file = Some("b.obj".into());
    scene.motion.pivot = Some(glam::Vec3::ZERO);
    scene.motion.keyframes = vec![KeyframeSection::default()];
    scene.camera.position = Some(glam::Vec3::ZERO);
    scene.camera.target = Some(glam::Vec3::ZERO);
    scene.camera.field_of_view = Some(30.0);
    scene.lights = vec![Light::default()];
    scene.to_toml().parse().unwrap()
}

/// Keys of a table that the reference does not name under its heading.
fn missing(reference: &str, table: &toml::Table, path: &str) -> Vec<String> {
    let under = |heading: &str| {
        let begin = reference.find(&format!("`{heading}`\n"))?;
        let rest = &reference[begin..];
        Some(&rest[..rest.find("\n#").unwrap_or(rest.len())])
    };
    let mut found = Vec::new();
    for (key, value) in table {
        let inner = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        match value {
            toml::Value::Table(table) => found.extend(missing(reference, table, &inner)),
            toml::Value::Array(items) if items.first().is_some_and(toml::Value::is_table) => {
                found.extend(missing(reference, items[0].as_table().unwrap(), &format!("[{inner}]")));
            }
            toml::Value::Array(items) if items.is_empty() => {}
            _ => {
                let heading = format!("[{path}]");
                let named = under(&heading).is_some_and(|text| text.contains(&format!("| `{key}` |")));
                if !named {
                    found.push(inner);
                }
            }
        }
    }
    found
}

#[test]
fn every_key_is_in_the_reference() {
    assert_eq!(missing(REFERENCE, &full(), ""), Vec::<String>::new());
    let torn = REFERENCE.replace("| `gravity` |", "| `levity` |");
    assert_eq!(missing(&torn, &full(), ""), ["simulation.gravity"], "the comparison can fail");
}

#[test]
fn the_example_is_a_scene() {
    let example = REFERENCE.split("```toml").nth(1).unwrap().split("```").next().unwrap();
    let scene = Scene::parse(example, "example").unwrap();
    assert_eq!(scene.style, StyleSettings { strand_count: 1500, ..StyleSettings::new(Style::Wavy) });
}

#[test]
fn scenes_survive_the_way_through_toml() {
    for scene in [Scene::demo(), Scene::thesis()] {
        assert_eq!(Scene::parse(&scene.to_toml(), "scene").unwrap(), scene);
    }
}
