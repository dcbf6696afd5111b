//! Changes that lead from one scene to another.

use toml::{Table, Value};

use crate::{Change, Look, PictureSettings, Scene};

/// The changes of hair that plays which lead from one scene to another; `None` where the other has to be loaded. The size
/// of the pictures, which is that of a window, stays.
pub fn changes(from: &Scene, to: &Scene) -> Option<Vec<Change>> {
    let mut near = from.clone();
    near.wind.clone_from(&to.wind);
    near.motion.clone_from(&to.motion);
    near.simulation.clone_from(&to.simulation);
    near.look.clone_from(&to.look);
    near.body_look.clone_from(&to.body_look);
    near.level_of_detail = to.level_of_detail;
    near.lights.clone_from(&to.lights);
    near.groom.length = to.groom.length;
    near.film.frames = to.film.frames;
    near.camera.keyframes.clone_from(&to.camera.keyframes);
    near.camera.kept.clone_from(&to.camera.kept);
    let PictureSettings { width, height, .. } = from.picture;
    near.picture = PictureSettings { width, height, ..to.picture };
    let sized = Scene { picture: near.picture, ..to.clone() };
    // Maps, groups, locks, the file of a motion, its pivot and the ways of solids are taken in when a scene is loaded.
    let loaded =
        |look: &Look| (look.color_map.clone(), look.width_map.clone(), look.group.clone(), look.coat.gather);
    let is_near = near == sized && loaded(&from.look) == loaded(&to.look) && follows(from, to);
    is_near.then(|| {
        let mut changes = Vec::new();
        let mut add = |differs: bool, change: &dyn Fn() -> Change| {
            if differs {
                changes.push(change());
            }
        };
        let picture = near.picture;
        add(from.wind != to.wind, &|| Change::Wind(to.wind.clone()));
        add(from.motion != to.motion, &|| Change::Motion(Box::new(to.motion.clone())));
        add(from.simulation != to.simulation, &|| Change::Settings(Box::new(to.simulation.clone())));
        let keys = &to.camera.keyframes;
        add(from.camera.keyframes != *keys, &|| Change::CameraKeys(keys.clone()));
        add(from.look != to.look, &|| Change::Look(Box::new(to.look.clone())));
        add(from.body_look != to.body_look, &|| Change::BodyLook(to.body_look));
        add(from.level_of_detail != to.level_of_detail, &|| Change::LevelOfDetail(to.level_of_detail));
        add(from.lights != to.lights, &|| Change::Lights(to.lights.clone()));
        add(from.groom.length != to.groom.length, &|| Change::Length(to.groom.length));
        add(from.picture != picture, &|| Change::Picture(picture));
        changes
    })
}

/// True where the head and the solids of one scene, as loaded, can move as another scene says.
fn follows(from: &Scene, to: &Scene) -> bool {
    let (motion, other) = (&from.motion, &to.motion);
    let solids_stay = from.colliders.iter().all(|solid| solid.keyframes().is_empty());
    motion.differs_in_file(other).is_none()
        && motion.pivot == other.pivot
        && (motion.interpolation == other.interpolation || solids_stay)
}

/// Keys whose values differ between two scenes, and the values of the second as a file has them; nothing where it has none.
pub fn difference(from: &Scene, to: &Scene) -> Vec<(String, String)> {
    let table = |scene: &Scene| Table::try_from(scene).unwrap_or_default();
    let mut found = Vec::new();
    walk("", &table(from), &table(to), &mut found);
    found
}

fn walk(section: &str, from: &Table, to: &Table, found: &mut Vec<(String, String)>) {
    let gone = from.keys().filter(|key| !to.contains_key(*key));
    for name in to.keys().chain(gone) {
        let key = if section.is_empty() { name.clone() } else { format!("{section}.{name}") };
        match (from.get(name), to.get(name)) {
            (Some(Value::Table(from)), Some(Value::Table(to))) => walk(&key, from, to, found),
            (one, other) if one == other => {}
            (_, Some(Value::Array(items))) if items.iter().any(Value::is_table) => {
                found.push((key, format!("{} of them", items.len())));
            }
            (_, other) => found.push((key, other.map_or_else(String::new, written))),
        }
    }
}

/// A value with no more digits than a person reads.
fn written(value: &Value) -> String {
    match value {
        Value::Float(number) => short(*number),
        Value::Array(items) => format!("[{}]", items.iter().map(written).collect::<Vec<_>>().join(", ")),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

fn short(number: f64) -> String {
    let text =
        if number != 0.0 && number.abs() < 1e-3 { format!("{number:.2e}") } else { format!("{number:.4}") };
    if !text.contains('.') || text.contains('e') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;
    use crate::scene::{
        ColliderSection, Interpolation, KeyframeSection, MotionName, SphereSection, TeleportSection,
    };

    #[test]
    fn what_can_be_changed_while_it_plays_is_and_the_rest_is_loaded() {
        let from = Scene::demo();
        assert_eq!(changes(&from, &from).map(|changes| changes.len()), Some(0));
        let mut to = from.clone();
        to.look.width_scale = 2.0;
        to.wind.velocity.x = 3.0;
        (to.picture.width, to.picture.exposure) = (9, 1.0);
        let list = changes(&from, &to).unwrap();
        let PictureSettings { width, .. } = from.picture;
        assert!(matches!(
            &list[..],
            [Change::Wind(_), Change::Look(_), Change::Picture(picture)] if picture.width == width
        ));
        let mut other = to.clone();
        other.set_style(Style::ALL[0]);
        other.style.strand_count += 1;
        assert!(changes(&to, &other).is_none());
        let mut mapped = to.clone();
        mapped.look.color_map = Some("map.png".into());
        assert!(changes(&to, &mapped).is_none(), "a map is read when the scene is loaded");
    }

    #[test]
    fn a_motion_that_is_read_otherwise_is_loaded() {
        type Set = fn(&mut Scene);
        let mut from = Scene::demo();
        (from.motion.name, from.motion.file) = (MotionName::File, Some("walk.bvh".into()));
        let is_loaded = |from: &Scene, set: Set| {
            let mut to = from.clone();
            set(&mut to);
            assert!(to != *from);
            changes(from, &to).is_none()
        };
        let read: [(&str, Set); 5] = [
            ("joint", |to| to.motion.joint = "Hips".to_owned()),
            ("clip", |to| to.motion.clip = Some("run".to_owned())),
            ("scale", |to| to.motion.scale = 0.01),
            ("teleports", |to| to.motion.teleports = vec![TeleportSection { time: 1.0 }]),
            ("pivot", |to| to.motion.pivot = Some(glam::Vec3::Y)),
        ];
        for (key, set) in read {
            assert!(is_loaded(&from, set), "motion.{key}");
        }
        let linear: Set = |to| to.motion.interpolation = Interpolation::Linear;
        assert!(!is_loaded(&from, linear) && !is_loaded(&from, |to| to.motion.start = 0.5));
        let keyframes = vec![KeyframeSection::default()];
        from.colliders = vec![ColliderSection::Sphere(SphereSection { keyframes, ..Default::default() })];
        assert!(is_loaded(&from, linear), "the way of a solid");
    }

    #[test]
    fn differences_have_keys_and_values() {
        let from = Scene::demo();
        let mut to = from.clone();
        to.look.width_scale = 0.3;
        to.wind.velocity.x = 3.0;
        to.lights.push(crate::Light::default());
        let found = difference(&from, &to);
        let has = |key: &str, value: &str| found.iter().any(|found| *found == (key.into(), value.into()));
        assert!(has("look.width_scale", "0.3") && has("lights", "1 of them"), "{found:?}");
        assert!(found.iter().any(|(key, _)| key == "wind.velocity") && found.len() == 3, "{found:?}");
        assert!(difference(&from, &from).is_empty());
    }
}
