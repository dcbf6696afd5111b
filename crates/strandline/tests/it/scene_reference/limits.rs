//! For every number of the table: both ends of its range are taken, and the next value beyond each and what
//! is no number are refused by its key, in every component, before anything is grown.

use strandline::{
    Error, Prepared, Scene,
    settings::{Group, Kind, Row, Table},
};

/// Every number with the key that a file names it by and the lines that have to stand before it.
fn numbers(table: &'static Table, path: &str, before: &str, found: &mut Vec<(String, String, &'static Row)>) {
    for row in table.rows {
        let inner = if path.is_empty() { row.name.to_owned() } else { format!("{path}.{}", row.name) };
        match row.kind {
            Kind::Group(table) => numbers(table, &inner, before, found),
            Kind::List(items) => {
                numbers(items.table(), &format!("{inner}[0]"), &format!("[[{inner}]]\n"), found);
            }
            Kind::Number(_) | Kind::Whole(_) | Kind::NumberOr(_) => {
                found.push((inner, before.to_owned(), row));
            }
            Kind::Flag | Kind::Words(_) | Kind::Text(_) => {}
        }
    }
}

/// A scene with one setting as given; a solid, a further file, a mark of a body and the look of a group also have what they need.
fn scene(key: &str, before: &str, value: &str) -> String {
    let name = key.rsplit('.').next().unwrap();
    let list = key.split('[').next().unwrap();
    let whole = match list {
        "groom.parts" => "[groom]\nfile = \"a.hair\"\n",
        "body.parts" | "body.teleports" => "[body]\nfile = \"a.obj\"\n",
        "motion.teleports" => "[motion]\nfile = \"a.bvh\"\n",
        _ => "",
    };
    let rest = match (list, name) {
        ("groom.parts" | "body.parts", _) => "file = \"b.obj\"\n",
        ("look.group", _) => "name = \"brows\"\n",
        ("colliders", "start" | "end") => {
            "shape = \"capsule\"\nstart = [0,0,0]\nend = [0,0,1]\nradius = 0.1\n"
        }
        ("colliders", _) => "shape = \"sphere\"\ncenter = [0,0,0]\nradius = 0.1\n",
        ("simulation.groups", _) => "group = \"fringe\"\n",
        ("lights", "position") => "target = [0.5, 0.5, 0.5]\n",
        _ => "",
    };
    let rest: String =
        rest.lines().filter(|line| !line.starts_with(name)).map(|line| format!("{line}\n")).collect();
    if key.starts_with("body.parts[0].teleports[0].") {
        format!("{whole}[[body.parts]]\n{rest}clip = \"a\"\n[[body.parts.teleports]]\n{name} = {value}\n")
    } else if key.starts_with("colliders[0].keyframes[0].") {
        format!("[[colliders]]\n{rest}[[colliders.keyframes]]\n{name} = {value}\n")
    } else if before.is_empty() {
        format!("{key} = {value}\n")
    } else {
        format!("{whole}{before}{rest}{name} = {value}\n")
    }
}

/// A value in one component of what a row holds; the others are in the middle of the least and the most, or
/// rise as layers have to.
fn written(row: &Row, component: usize, value: &str) -> String {
    let (count, whole) = match row.kind {
        Kind::Number(count) => (count, false),
        Kind::Whole(count) => (count, true),
        _ => (1, false),
    };
    if count == 1 {
        return value.to_owned();
    }
    let [least, most] = row.range.unwrap();
    let other = |index: usize| {
        let middle = match row.name {
            "layers" => 0.1 * (1.0 + index as f64),
            _ => least + (most - least) * (0.4 + 0.1 * index as f64),
        };
        if whole { format!("{middle:.0}") } else { format!("{middle:e}") }
    };
    let items: Vec<String> =
        (0..count).map(|index| if index == component { value.to_owned() } else { other(index) }).collect();
    format!("[{}]", items.join(", "))
}

/// The next number below the least and above the most, as a file has them.
fn beyond(row: &Row) -> [String; 2] {
    let [least, most] = row.range.unwrap();
    if matches!(row.kind, Kind::Whole(_)) {
        return [format!("{:.0}", least - 1.0), format!("{:.0}", most + 1.0)];
    }
    // Numbers of 64 bits are times only; the next of 32 bits is outside for both.
    let next = [(least as f32).next_down(), (most as f32).next_up()];
    next.map(|value| format!("{:e}", f64::from(value)))
}

fn ends(row: &Row) -> [String; 2] {
    let text = |value: f64| match row.kind {
        Kind::Whole(_) => format!("{value:.0}"),
        _ => format!("{value:e}"),
    };
    row.range.unwrap().map(text)
}

fn refused(text: &str, key: &str) -> bool {
    match Scene::parse(text, "scene") {
        Err(Error::Value(error)) => error.key == key,
        // A whole number below 0 or above what its type holds.
        Err(Error::ParseScene { message, .. }) => message.contains("invalid value"),
        _ => false,
    }
}

#[test]
fn both_ends_of_every_range_are_taken_and_nothing_beyond() {
    let mut all = Vec::new();
    numbers(&Scene::TABLE, "", "", &mut all);
    assert!(all.len() > 100, "{} numbers", all.len());
    let mut wrong = Vec::new();
    for (key, before, row) in &all {
        if row.range.is_none() {
            assert_eq!(key, "style.seed", "every number has a range");
            continue;
        }
        let components = match row.kind {
            Kind::Number(count) | Kind::Whole(count) => count,
            _ => 1,
        };
        for component in 0..components {
            let text = |value: &str| scene(key, before, &written(row, component, value));
            for (end, value) in ends(row).iter().enumerate() {
                // Layers rise: only the first has room for the least, only the last for the most.
                let room = row.name != "layers" || component == 2 * end;
                if room && let Err(error) = Scene::parse(&text(value), "scene") {
                    wrong.push(format!("{key} = {value} is refused: {error}"));
                }
            }
            let nan = if matches!(row.kind, Kind::Whole(_)) { None } else { Some("nan".to_owned()) };
            for value in beyond(row).into_iter().chain(nan) {
                if !refused(&text(&value), key) {
                    wrong.push(format!("{key}, component {component}: {value} is taken"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Reported cases.
#[test]
fn what_passed_or_failed_once_does_not_again() {
    let taken = [
        "body.spacing = 0.1",
        "body.scale = 1e-6",
        "look.shadow.layers = [1e-6, 0.05, 1000]",
        "groom.length = 0.05",
    ];
    for text in taken {
        Scene::parse(text, "scene").unwrap();
    }
    let refused = [
        (
            "motion.pivot = [nan, 0, 0]",
            "motion.pivot is [NaN, 0, 0], expected 3 numbers of -10,000 to 10,000 m",
        ),
        ("motion.pivot = [1e30, 0, 0]", "motion.pivot"),
        ("simulation.gravity = [1e30, 0, 0]", "simulation.gravity"),
        ("look.root_color = [nan, 0, 0]", "look.root_color is [NaN, 0, 0], expected 3 numbers of 0 to 1"),
        ("look.tip_color = [0.5, nan, 0.5]", "look.tip_color"),
        ("look.sparkle = 7", "look.fibre.scheuermann.sparkle is 7, expected 0 to 1"),
        ("simulation.iterations = 0", "simulation.strands.constrain.iterations is 0, expected 1 to 10,000"),
        ("camera.field_of_view = 400", "camera.field_of_view is 400, expected 1 to 170 degrees"),
        ("body_look.roughness = 0", "body_look.roughness"),
        ("[[lights]]\n[[lights]]\ncone_angle = 0", "lights[1].cone_angle is 0, expected 1 to 85 degrees"),
        ("lights = [{ position = [0, 0, 0] }]", "lights[0].position is [0, 0, 0], expected a place apart"),
        ("picture = { width = 16384, height = 16384 }", "28672 MiB"),
        ("motion.name = \"keyframes\"", "the list of keyframes is empty"),
        ("look.shadow.layers = [0.1, 0.05, 0.2]", "look.shadow.layers is [0.1, 0.05, 0.2], expected three"),
        (
            "[[colliders]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1e38",
            "colliders[0].radius is 1e38, expected 1e-6 to 1000 m",
        ),
        ("devices.simulation = \"gpu\"\nsimulation.volume.preconditioner = \"mic0\"", "on a GPU"),
    ];
    for (text, message) in refused {
        let error = Scene::parse(text, "scene").unwrap_err().to_string();
        assert!(error.contains(message), "{text}: {error}");
    }
}

#[test]
fn a_scene_is_refused_before_anything_is_loaded() {
    let mut scene = Scene::demo();
    scene.groom.file = Some("absent.hair".into());
    scene.look.fibre.scheuermann.sparkle = 7.0;
    let error = Prepared::new(&scene).err().unwrap().to_string();
    assert!(error.starts_with("look.fibre.scheuermann.sparkle is 7"), "{error}");
}
