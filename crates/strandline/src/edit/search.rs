//! Settings found by words, and changed by their keys.

use strandline_base::{Group, Kind, Row, Table};
use toml::Value;

use crate::{Error, Scene};

/// A setting that was found.
#[derive(Clone, Debug)]
pub struct SettingMatch {
    /// Its name in its sections: `simulation.drag.across`.
    pub key: String,
    /// Its description.
    pub row: &'static Row,
}

/// Settings whose names or sentences have all of these words, those with the words in their names first. Items of lists
/// are not among them.
pub fn find(words: &str) -> Vec<SettingMatch> {
    let words: Vec<String> = words.split_whitespace().map(str::to_lowercase).collect();
    if words.is_empty() {
        return Vec::new();
    }
    let mut all = Vec::new();
    collect(&Scene::TABLE, "", &mut all);
    let has = |text: &str| words.iter().all(|word| text.contains(word.as_str()));
    let named = |found: &SettingMatch| has(&found.key.replace('_', " ")) || has(&found.key);
    let (mut first, rest): (Vec<SettingMatch>, Vec<SettingMatch>) = all.into_iter().partition(named);
    first.extend(rest.into_iter().filter(|found| {
        let text = format!("{} {} {}", found.key.replace('_', " "), found.row.sentence(), found.row.more);
        has(&text.to_lowercase())
    }));
    first
}

/// The settings of a section and of the sections in it, in the order of a file. Items of lists are not among them.
pub fn settings_of(section: &str) -> Vec<SettingMatch> {
    match Scene::TABLE.row(section).map(|row| row.kind) {
        Some(Kind::Group(table)) => settings_in(table, section),
        _ => Vec::new(),
    }
}

/// The settings of a table that stands in a section.
pub(super) fn settings_in(table: &Table, section: &str) -> Vec<SettingMatch> {
    let mut all = Vec::new();
    collect(table, section, &mut all);
    all
}

fn collect(table: &Table, section: &str, all: &mut Vec<SettingMatch>) {
    for row in table.rows {
        let key = if section.is_empty() { row.name.to_owned() } else { format!("{section}.{}", row.name) };
        match row.kind {
            Kind::Group(table) => collect(table, &key, all),
            Kind::List(_) => {}
            _ => all.push(SettingMatch { key, row }),
        }
    }
}

/// The values of a scene's settings, as a file has them.
pub struct Values(Value);

impl Values {
    /// Values of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self(Value::Table(toml::Table::try_from(scene).unwrap_or_default()))
    }

    /// The value of a setting, or of an item's, `ties[1].radius`; `None` where the scene has none.
    pub fn get(&self, key: &str) -> Option<&Value> {
        key.split('.').try_fold(&self.0, |value, part| {
            let (name, index) = item(part);
            let value = value.as_table()?.get(name)?;
            match index {
                Some(index) => value.as_array()?.get(index.parse::<usize>().ok()?),
                None => Some(value),
            }
        })
    }
}

/// A part of a key: its name, and the index of an item where there is one.
fn item(part: &str) -> (&str, Option<&str>) {
    let split = part.strip_suffix(']').and_then(|part| part.split_once('['));
    split.map_or((part, None), |(name, index)| (name, Some(index)))
}

/// The table of a section, or of an item, of a setting with a key; a section that is not there is made.
pub(super) fn table_of<'a>(
    mut at: &'a mut toml::Table,
    sections: &str,
    key: &str,
) -> Result<&'a mut toml::Table, Error> {
    let refuse = |message: String| Error::ParseScene { origin: key.to_owned(), message };
    for part in sections.split('.').filter(|part| !part.is_empty()) {
        let (name, index) = item(part);
        let entry = at.entry(name).or_insert_with(|| Value::Table(toml::Table::new()));
        let entry = match index {
            None => Some(entry),
            Some(index) => index
                .parse::<usize>()
                .ok()
                .zip(entry.as_array_mut())
                .and_then(|(index, items)| items.get_mut(index)),
        };
        let Some(entry) = entry else { return Err(refuse(format!("no such item as `{part}` of {key}"))) };
        let Value::Table(inner) = entry else {
            return Err(refuse(format!("`{part}` of {key} is no section")));
        };
        at = inner;
    }
    Ok(at)
}

/// The scene of a table, with what no file has of another.
pub(super) fn changed(scene: &Scene, table: &toml::Table, key: &str) -> Result<Scene, Error> {
    let mut changed = Scene::parse(&toml::to_string(table).unwrap_or_default(), key)?;
    (changed.folder, changed.given) = (scene.folder.clone(), scene.given);
    // Surroundings of a file that is named no longer go with it.
    if scene.surroundings.file.is_none() || changed.surroundings.file.is_some() {
        changed.look.surroundings.clone_from(&scene.look.surroundings);
    }
    Ok(changed)
}

/// The scene with another value of a setting; `None` leaves the setting out, which then has its default.
///
/// # Errors
/// A key that no setting has; a value of another kind or outside its range.
pub fn with_value(scene: &Scene, key: &str, value: impl Into<Option<Value>>) -> Result<Scene, Error> {
    let mut table = toml::Table::try_from(scene).unwrap_or_default();
    let (sections, name) = key.rsplit_once('.').unwrap_or(("", key));
    let at = table_of(&mut table, sections, key)?;
    let value = value.into();
    let is_given = value.is_some();
    match value {
        Some(value) => at.insert(name.to_owned(), value),
        None => at.remove(name),
    };
    let mut changed = changed(scene, &table, key)?;
    if key == "motion.name" {
        // A body that moves by itself keeps a motion that a person chose.
        changed.given.motion_name = is_given;
    }
    Ok(changed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_found_by_name_and_by_sentence() {
        let keys = |words: &str| find(words).into_iter().map(|found| found.key).collect::<Vec<_>>();
        assert_eq!(keys("drag across").first().map(String::as_str), Some("simulation.drag.across"));
        assert!(keys("Turned White").contains(&"look.grey".to_owned()), "{:?}", keys("Turned White"));
        assert_eq!(keys("look.width_scale").len(), 1);
        assert!(keys("").is_empty() && keys("no such setting at all").is_empty());
        assert!(find("e").len() > 100);
    }

    #[test]
    fn sections_have_their_settings_and_those_of_sections_within() {
        let keys: Vec<String> = settings_of("groom").into_iter().map(|found| found.key).collect();
        assert!(keys[0] == "groom.file" && keys.iter().all(|key| key.starts_with("groom.")), "{keys:?}");
        assert!(settings_of("simulation").iter().any(|found| found.key == "simulation.drag.across"));
        assert!(settings_of("no_such").is_empty() && settings_of("lights").is_empty());
    }

    #[test]
    fn a_value_is_read_and_set_by_its_key_and_nothing_else_changes() {
        let scene = Scene::demo();
        let before = Values::of(&scene).get("look.width_scale").unwrap().clone();
        let changed = with_value(&scene, "look.width_scale", Value::Float(1.25)).unwrap();
        assert_eq!(changed.look.width_scale, 1.25);
        assert!(with_value(&changed, "look.width_scale", before).unwrap() == scene);
        // One that has no value yet.
        assert_eq!(Values::of(&scene).get("camera.field_of_view"), None);
        let wide = with_value(&scene, "camera.field_of_view", Value::Float(60.0)).unwrap();
        assert_eq!(wide.camera.field_of_view, Some(60.0));
        assert!(with_value(&wide, "camera.field_of_view", None).unwrap() == scene);
        let refused =
            |key: &str, number| with_value(&scene, key, Value::Float(number)).unwrap_err().to_string();
        assert!(refused("look.width_scale", -1.0).contains("width_scale"));
        assert!(refused("look.no_such", 1.0).contains("no_such"));
        assert!(refused("look.width_scale.more", 1.0).contains("is no section"));
    }
}
