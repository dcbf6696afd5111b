//! Comparison of the scene of a run with the one that it is resumed with.

use toml::Value;

use crate::{Scene, cache::relative};

/// Settings with which another film begins: a run is not resumed with another value of one of them. A section stands
/// for all that is in it.
const FIXED: [&str; 10] = [
    "groom",
    "style",
    "body.file",
    "body.parts",
    "motion.neck",
    "simulation.strands.method",
    "simulation.time_step",
    "film.frames_per_second",
    "film.start",
    "film.settle",
];
/// Settings that do not change how hair moves, in part or whole.
const FREE: [&str; 11] = [
    "film.frames",
    "devices",
    "picture",
    "look",
    "body_look",
    "lights",
    "camera",
    "surroundings",
    "level_of_detail",
    "timeline",
    "body.visible",
];

/// Compares the scene of a run with the one that it is to be resumed with. Returns a note on settings that differ.
///
/// # Errors
/// A setting that makes it another film, by its key.
pub(super) fn check(former: &Scene, now: &Scene) -> Result<Option<String>, String> {
    let mut differ = Vec::new();
    let [former, now] = [former, now].map(|scene| {
        let values = Value::try_from(relative::resolved(scene));
        values.expect("every section is plain data")
    });
    differences("", Some(&former), Some(&now), &mut differ);
    differ.retain(|(key, ..)| !is_in(key, &FREE));
    // In the order of the list: a method brings other settings along.
    let fixed = FIXED.iter().find_map(|fixed| differ.iter().find(|(key, ..)| is_in(key, &[fixed])));
    if let Some((key, former, now)) = fixed {
        return Err(format!(
            "its run has {key} = {former}, and the scene has {now}: leave out --scene and options that change it, or \
             begin another run"
        ));
    }
    let line = |(key, former, now): &(String, String, String)| format!("{key} = {now} (was {former})");
    let lines: Vec<String> = differ.iter().map(line).collect();
    Ok((!lines.is_empty()).then(|| format!("the film goes on with other settings: {}", lines.join(", "))))
}

/// Keys of settings that decide how hair moves and differ between two scenes, with both values. Names of files count
/// without their folders.
pub(crate) fn moving(former: &Scene, now: &Scene) -> Vec<String> {
    let mut differ = Vec::new();
    let [former, now] = [former, now].map(|scene| {
        let mut bare = scene.clone();
        bare.paths_mut().for_each(|path| *path = path.file_name().map(Into::into).unwrap_or_default());
        let pose = bare.groom.pose.take();
        bare.groom.pose = pose.and_then(|pose| pose.file_name().map(Into::into));
        Value::try_from(bare).expect("every section is plain data")
    });
    differences("", Some(&former), Some(&now), &mut differ);
    // The air that a guide meets depends on the hairs that it stands for.
    differ.retain(|(key, ..)| key == "look.hair_count" || !is_in(key, &FREE));
    differ.iter().map(|(key, former, now)| format!("{key} = {now} (was {former})")).collect()
}

/// True for a key that is one of these, or in a section that is.
fn is_in(key: &str, keys: &[&str]) -> bool {
    keys.iter().any(|known| {
        key.strip_prefix(known).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    })
}

/// Keys whose values differ, with both values.
fn differences(
    key: &str,
    one: Option<&Value>,
    other: Option<&Value>,
    found: &mut Vec<(String, String, String)>,
) {
    if one == other {
        return;
    }
    if let (Some(Value::Table(one)), Some(Value::Table(other))) = (one, other) {
        let names: std::collections::BTreeSet<&String> = one.keys().chain(other.keys()).collect();
        for name in names {
            let inner = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
            differences(&inner, one.get(name), other.get(name), found);
        }
        return;
    }
    let text = |value: Option<&Value>| match value {
        None => "not given".to_owned(),
        Some(Value::Array(items)) if items.iter().any(Value::is_table) => format!("{} items", items.len()),
        Some(value) => value.to_string(),
    };
    found.push((key.to_owned(), text(one), text(other)));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(key: &str, value: &str) -> Result<Option<String>, String> {
        let former = Scene::demo();
        let mut now = former.clone();
        now.set(key, value).unwrap();
        check(&former, &now)
    }

    #[test]
    fn another_film_is_refused_and_other_settings_are_noted() {
        assert_eq!(check(&Scene::demo(), &Scene::demo()), Ok(None));
        for (key, value) in [("film.frames", "999"), ("look.grey", "0.5"), ("camera.view", "front")] {
            assert_eq!(changed(key, value), Ok(None), "{key}");
        }
        for (key, value) in [
            ("film.frames_per_second", "24"),
            ("style.curl_radius", "0.02"),
            ("simulation.strands.method", "constrain"),
            ("simulation.time_step", "0.01"),
            ("groom.points_per_strand", "20"),
            ("film.start", "1"),
            ("motion.neck", "true"),
        ] {
            let refused = changed(key, value).unwrap_err();
            assert!(refused.contains(&format!("its run has {key} = ")), "{refused}");
        }
        let note = changed("simulation.gravity", "[0, -1, 0]").unwrap().unwrap();
        assert!(note.contains("simulation.gravity = [0.0, -1.0, 0.0]"), "{note}");
        let note = changed("wind.gust", "0.25").unwrap().unwrap();
        assert!(note.contains("wind.gust = 0.25 (was 0.5)"), "{note}");
    }
}
