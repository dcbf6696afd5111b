//! Items of a scene's lists: `[[colliders]]`, `[[ties]]`, `[[look.group]]` and further files.

use strandline_base::{Group, Kind};
use toml::{Table, Value};

use super::search::{SettingMatch, Values, changed, settings_in, table_of};
use crate::{Error, Scene};

/// The settings of each item of a list, with keys such as `ties[1].radius`: those that an item of its shape has, without
/// lists of its own.
pub fn items_of(values: &Values, list: &str) -> Vec<Vec<SettingMatch>> {
    let Some(Kind::List(items)) = Scene::TABLE.row(list).map(|row| row.kind) else { return Vec::new() };
    let count = values.get(list).and_then(Value::as_array).map_or(0, Vec::len);
    let item = |index: usize| {
        let mut all = settings_in(items.table(), &format!("{list}[{index}]"));
        // Another shape has other settings: it is another item.
        all.retain(|found| {
            let is_shape = matches!(found.row.kind, Kind::Words(_));
            !found.row.required || !is_shape && values.get(&found.key).is_some()
        });
        all
    };
    (0..count).map(item).collect()
}

/// The scene with a further item at the end of a list.
///
/// # Errors
/// A list that no scene has; an item that is refused.
pub fn with_item(scene: &Scene, list: &str, item: Table) -> Result<Scene, Error> {
    edited(scene, list, |items| items.push(Value::Table(item)))
}

/// The scene without an item of a list.
///
/// # Errors
/// A list that no scene has; a scene that needs the item.
pub fn without_item(scene: &Scene, list: &str, index: usize) -> Result<Scene, Error> {
    edited(scene, list, |items| {
        if index < items.len() {
            items.remove(index);
        }
    })
}

fn edited(scene: &Scene, list: &str, edit: impl FnOnce(&mut Vec<Value>)) -> Result<Scene, Error> {
    let mut table = Table::try_from(scene).unwrap_or_default();
    let (section, name) = list.rsplit_once('.').unwrap_or(("", list));
    let entry = table_of(&mut table, section, list)?.entry(name).or_insert_with(|| Value::Array(Vec::new()));
    match entry {
        Value::Array(items) => edit(items),
        _ => {
            let message = format!("`{name}` of {list} is no list");
            return Err(Error::ParseScene { origin: list.to_owned(), message });
        }
    }
    changed(scene, &table, list)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::with_value;

    fn table(text: &str) -> Table {
        text.parse().unwrap()
    }

    #[test]
    fn items_are_added_changed_and_taken_out() {
        let scene = Scene::demo();
        let ball = "shape = \"sphere\"\ncenter = [0.0, 0.1, 0.2]\nradius = 0.05";
        let one = with_item(&scene, "colliders", table(ball)).unwrap();
        let two = with_item(&one, "colliders", table(&ball.replace("0.05", "0.07"))).unwrap();
        let items = items_of(&Values::of(&two), "colliders");
        let keys: Vec<&str> = items[1].iter().map(|found| found.key.as_str()).collect();
        let wanted = ["center", "radius", "carrier", "friction"].map(|name| format!("colliders[1].{name}"));
        assert_eq!(keys, wanted, "neither the shape nor the ends of a capsule");
        let larger = with_value(&two, "colliders[1].radius", Value::Float(0.25)).unwrap();
        let (before, after) = (Values::of(&two), Values::of(&larger));
        assert_eq!(after.get("colliders[1].radius"), Some(&Value::Float(0.25)));
        assert_eq!(after.get("colliders[0].radius"), before.get("colliders[0].radius"));
        assert!(without_item(&two, "colliders", 1).unwrap() == one);
        assert!(without_item(&one, "colliders", 0).unwrap() == scene);
        for (list, item) in [("ties", "radius = 0.03"), ("look.group", "name = \"brows\"")] {
            let more = with_item(&scene, list, table(item)).unwrap();
            let items = items_of(&Values::of(&more), list);
            assert!(items.len() == 1 && items[0].len() >= 2, "{list}");
            assert!(without_item(&more, list, 0).unwrap() == scene);
        }
        // A value that an item does not give yet.
        let group = with_item(&scene, "look.group", table("name = \"brows\"")).unwrap();
        let grey = with_value(&group, "look.group[0].grey", Value::Float(0.5)).unwrap();
        assert_eq!(grey.look.group[0].grey, Some(0.5));
        assert!(with_value(&grey, "look.group[0].grey", None).unwrap() == group);
    }

    #[test]
    fn what_no_list_or_no_item_is_is_refused() {
        let scene = Scene::demo();
        let refused = |list: &str, item: &str| with_item(&scene, list, table(item)).unwrap_err().to_string();
        assert!(refused("colliders", "shape = \"cube\"").contains("cube"));
        assert!(refused("ties", "radius = -1.0").contains("ties[0].radius"));
        assert!(refused("style", "").contains("is no list"));
        assert!(refused("nothing", "").contains("nothing"));
        let value = |key: &str| with_value(&scene, key, Value::Float(1.0)).unwrap_err().to_string();
        assert!(value("ties[0].radius").contains("no such item"), "{}", value("ties[0].radius"));
        assert!(value("ties[x].radius").contains("ties[x]") && value("style[0].seed").contains("style"));
        assert!(items_of(&Values::of(&scene), "style").is_empty());
        assert_eq!(Values::of(&scene).get("ties[7].radius"), None);
    }
}
