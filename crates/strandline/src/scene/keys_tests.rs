use glam::Vec3;

use super::*;
use crate::{
    Style,
    render::{Coat, LightKind},
    scene::{FilmSection, MotionName},
    sim::rods::Rest,
};

fn refused(key: &str, value: &str) -> String {
    let mut scene = full();
    let before = scene.clone();
    let error = scene.set(key, value).expect_err(&format!("{key} = {value} was taken")).to_string();
    assert!(scene == before, "{key}: a refused value has changed the scene");
    error
}

/// A scene with one item in every list, so that each key of the table has a value or may have one.
fn full() -> Scene {
    let text = "groom = { file = \"a.hair\", parts = [{ file = \"b.hair\" }] }\n\
                body = { file = \"a.obj\", parts = [{ file = \"b.obj\" }] }\n\
                colliders = [{ shape = \"capsule\", start = [0,0,0], end = [0,0,1], radius = 0.1 }]\n\
                lights = [{ position = [0,1,2] }]\n\
                look.group = [{ name = \"brows\" }]\n\
                simulation.groups = [{ group = \"fringe\" }]\n\
                motion.keyframes = [{ time = 0 }]\n\
                wind.keyframes = [{ time = 0 }]\n\
                camera.keyframes = [{ time = 0 }]";
    Scene::parse(text, "scene").unwrap()
}

/// Every key with its row.
fn all() -> Vec<(String, &'static Row)> {
    let mut found = Vec::new();
    keys(&Scene::TABLE, "", &mut found);
    found.into_iter().map(|key| (key.clone(), Scene::row(&key).unwrap())).collect()
}

#[test]
fn every_key_takes_the_value_that_it_has() {
    let scene = full();
    let mut set = 0;
    for (key, row) in all() {
        let value = scene.get(&key).unwrap();
        // An absent value, and settings that bring others along or let hair begin at rest.
        let rates = ["simulation.drag.across", "simulation.drag.along"];
        let brings = ["style.style", "groom.file", "body.file", "look.root_color", "look.tip_color"];
        let alone = !brings.contains(&key.as_str()) && !rates.contains(&key.as_str());
        if value.is_empty() || matches!(row.kind, Kind::Group(_)) || !alone {
            continue;
        }
        let mut same = scene.clone();
        same.set(&key, &value).unwrap_or_else(|error| panic!("{key} = {value}: {error}"));
        assert!(same == scene, "{key} = {value} has changed the scene");
        set += 1;
    }
    assert!(set > 200, "{set} settings");
}

#[test]
fn a_rate_of_the_air_stands_for_its_force_unless_both_are_given() {
    let factor = |text: &str| Scene::parse(text, "scene").unwrap().simulation.drag.factor;
    assert_eq!(factor(""), 1.0);
    assert_eq!(factor("simulation.drag.along = 3"), 0.0);
    assert_eq!(factor("[simulation.drag]\nacross = 3\nfactor = 2"), 2.0);
    let mut scene = Scene::default();
    scene.set("simulation.drag.across", "3").unwrap();
    assert_eq!((scene.simulation.drag.across, scene.simulation.drag.factor), (3.0, 0.0));
    scene.set("simulation.drag.factor", "1").unwrap();
    // A written scene holds both.
    assert_eq!(Scene::parse(&scene.to_toml(), "scene").unwrap().simulation, scene.simulation);
}

#[test]
fn every_number_outside_its_range_is_refused_with_key_and_range() {
    for (key, row) in all() {
        let (Some([least, most]), true) =
            (row.range, matches!(row.kind, Kind::Number(_) | Kind::Whole(_) | Kind::NumberOr(_)))
        else {
            continue;
        };
        let count = match row.kind {
            Kind::Number(count) | Kind::Whole(count) => count,
            _ => 1,
        };
        let beyond = 2.0 * (least.abs() + most.abs()) + 1.0;
        for value in [beyond, -beyond] {
            let one =
                if matches!(row.kind, Kind::Whole(_)) { format!("{value:.0}") } else { format!("{value:e}") };
            let value = if count > 1 { format!("[{}]", vec![one; count].join(", ")) } else { one };
            let error = refused(&key, &value);
            let names = error.contains(&key) || error.contains(&key.replace("[0]", ""));
            assert!(names, "{key} = {value}: {error}");
        }
        let error = refused(&key, "[true]");
        assert!(error.contains(&key), "{key}: {error}");
    }
}

#[test]
fn values_need_no_quotes_and_lists_grow_by_index() {
    let mut scene = Scene::default();
    for (key, value) in [
        ("simulation.gravity", "[0, -1.6, 0]"),
        ("motion.name", "nod"),
        ("groom.file", "hair of 2026.npz"),
        ("lights[0].kind", "rectangle"),
        ("lights[0].position", "[0, 1, 2]"),
        ("lights[1].position", "[3, 1, 2]"),
        ("look.shadow.layers", "[0.001, 0.002, 0.003]"),
    ] {
        scene.set(key, value).unwrap_or_else(|error| panic!("{key} = {value}: {error}"));
    }
    assert_eq!(scene.simulation.gravity, Vec3::new(0.0, -1.6, 0.0));
    assert_eq!((scene.motion.name, scene.lights.len()), (MotionName::Nod, 2));
    assert_eq!(scene.groom.file.as_deref(), Some("hair of 2026.npz".as_ref()));
    assert_eq!((scene.lights[0].kind, scene.lights[1].position.x), (LightKind::Rectangle, 3.0));
    assert!(refused("lights[2].position", "[0, 0, 0]").contains("up to 1"));
}

#[test]
fn words_bring_along_what_they_bring_in_a_file() {
    let mut scene = Scene::default();
    scene.set("style.style", "curly").unwrap();
    let mut expected = Scene::default();
    expected.set_style(Style::Curly);
    assert_eq!(scene, expected);
    scene.set("look.preset", "thesis").unwrap();
    let file = Scene::parse("style.style = \"curly\"\nlook.preset = \"thesis\"", "scene").unwrap();
    assert_eq!(scene, file);
    scene.set("simulation.strands.method", "constrain").unwrap();
    assert_eq!(scene.film.settle, FilmSection::SETTLE);
    // Nothing else changes with it.
    scene.set("style.strand_count", "77").unwrap();
    assert_eq!((scene.style.strand_count, scene.style.style), (77, Style::Curly));
    assert!(scene.given.follow_strands == file.given.follow_strands);
    scene.set("look.follow_strands", "3").unwrap();
    assert!(scene.given.follow_strands, "a groom does not choose it");
}

#[test]
fn a_kind_of_hair_brings_its_look_and_time_to_droop_and_leaves_what_is_given() {
    let key = "simulation.strands.rods.hair";
    for (hair, coat) in [("medium", Coat::NONE), ("wet", Coat::WATER), ("sprayed", Coat::LACQUER)] {
        let mut set = Scene::default();
        set.set(key, hair).unwrap();
        assert_eq!(set, Scene::parse(&format!("{key} = \"{hair}\""), "scene").unwrap());
        assert_eq!(set.look.coat, coat);
        assert_eq!(set.film.settle > 0.0, hair == "wet", "{hair}");
        // A preset of the look leaves it.
        set.set("look.preset", "black").unwrap();
        assert_eq!(set.look.coat, coat);
        set.set(key, "medium").unwrap();
        let mut black = Scene::default();
        black.set("look.preset", "black").unwrap();
        black.set(key, "medium").unwrap();
        assert_eq!(set, black);
    }
    let text = "look.coat.gather = 0.1\nfilm.settle = 0.5\n[simulation.strands.rods]\nhair = \"wet\"\nload = 0.05\nrest = \"sag_free\"";
    let own = Scene::parse(text, "scene").unwrap();
    assert_eq!(own.look.coat, Coat { gather: 0.1, ..Coat::WATER });
    let rods = own.simulation.strands.rods;
    assert_eq!((rods.load, rods.rest, own.film.settle), (0.05, Rest::SagFree, 0.5));
    // Written whole and read again it stays.
    assert_eq!(Scene::parse(&own.to_toml(), "scene").unwrap(), own);
    // Older files have the share of a wisp beside the settings of contact.
    let older = Scene::parse("simulation.contact.packing = 0.5", "scene").unwrap();
    assert_eq!(older.simulation.strands.rods.packing, 0.5);
    let text = "[simulation]\ncontact.packing = 0.5\nstrands.rods.hair = \"wet\"";
    assert_eq!(Scene::parse(text, "scene").unwrap().simulation.strands.rods.packing, 0.5);
    // A wet group droops before the film begins.
    let text = "[[simulation.groups]]\ngroup = \"1\"\nhair = \"wet\"";
    assert_eq!(Scene::parse(text, "scene").unwrap().film.settle, 2.0);
    let mut set = Scene::default();
    set.set("simulation.groups", "[{ group = \"1\", hair = \"wet\" }]").unwrap();
    assert_eq!(set.film.settle, 2.0);
    // Constrained strands do not droop, whatever the order of the keys.
    let text = "[simulation.strands]\nmethod = \"constrain\"\nrods.hair = \"wet\"";
    assert_eq!(Scene::parse(text, "scene").unwrap().film.settle, 1.0);
}

#[test]
fn mistakes_are_refused_with_the_nearest_key_or_the_values_that_may_be() {
    for (key, near) in [
        ("simulation.gravty", "`simulation.gravity`"),
        ("gravity", "`simulation.gravity`"),
        ("look.shadow.layer", "`look.shadow.layers`"),
        ("lights[0].colour", "`lights[0].color`"),
        ("simulation.gravity[0]", "`simulation.gravity`"),
        ("lights[x].color", "`lights[0].color`"),
        ("simulation.gravity.x", "`simulation.gravity`"),
    ] {
        let error = refused(key, "1");
        assert!(error.contains("no setting of a scene") && error.contains(near), "{key}: {error}");
    }
    for (key, value, words) in [
        ("motion.name", "jump", "still"),
        ("simulation.volume.enabled", "maybe", "true or false"),
        ("simulation.gravity", "down", "3 numbers of"),
        ("simulation.gravity", "[0, 1]", "3 numbers of"),
        ("look.grey", "0.5\nvariation = 1", "0 to 1"),
        ("lights", "3", "invalid type"),
        ("film.frames", "-1", "1 to"),
    ] {
        let error = refused(key, value);
        assert!(error.contains(words) && error.contains(key), "{key} = {value}: {error}");
    }
}

#[test]
fn settings_explain_themselves() {
    let text = Scene::default().explain("simulation.gravity").unwrap();
    assert!(
        text.starts_with("simulation.gravity: ") && text.contains("-9.81") && text.contains("m/s^2"),
        "{text}"
    );
    let text = Scene::default().explain("wind").unwrap();
    assert!(text.lines().count() > 2 && text.contains("  wind."), "{text}");
    for key in ["lights", "lights[0]"] {
        let text = Scene::default().explain(key).unwrap();
        assert!(text.contains("  lights[0].color: "), "{text}");
    }
}

#[test]
fn colours_are_set_as_in_other_programs() {
    let mut scene = full();
    for text in ["#ff0000", "\"#FF0000\"", "[1, 0, 0]"] {
        scene.set("look.root_color", "[0, 1, 0]").unwrap();
        scene.set("look.root_color", text).unwrap();
        assert_eq!(scene.look.root_color, Vec3::X, "{text}");
    }
    scene.set("lights[0].color", "#00ff00").unwrap();
    assert_eq!(scene.lights[0].color, Vec3::Y);
    assert!(refused("simulation.gravity", "#ff0000").contains("expected 3 numbers"));
    assert!(refused("look.root_color", "#ff00").contains("expected 3 numbers"));
    scene.set("look.preset", "Copper").unwrap();
    assert_eq!(scene.look.preset.name(), "copper");
    assert!(refused("look.preset", "plaid").contains("brown, black, blonde, red, copper, grey"));
}
