//! Looks as files of their own.

use std::io::Write;
use std::path::Path;

use strandline_base::WholeFile;
use toml::Table;

use crate::{Error, Scene};

/// Sections of a look's file.
const SECTIONS: [&str; 2] = ["look", "body_look"];

/// Saves the look of hair and body of a scene: the sections `[look]` and `[body_look]` of a scene file, every key spelled
/// out. Maps are named by whole paths.
///
/// # Errors
/// The file cannot be written; what was there before stays.
pub fn save_look(scene: &Scene, path: &Path) -> Result<(), Error> {
    let mut scene = scene.clone();
    let folder = scene.folder.clone();
    for map in maps(&mut scene) {
        let whole = folder.join(&map);
        *map = std::path::absolute(&whole).unwrap_or(whole);
    }
    let mut table: Table = Table::try_from(&scene).unwrap_or_default();
    table.retain(|section, _| SECTIONS.contains(&section));
    let text = toml::to_string(&table).unwrap_or_default();
    let file = WholeFile::write(path, |file| file.write_all(text.as_bytes()));
    file.and_then(WholeFile::keep).map_err(Error::save("the look", path))
}

/// The scene with the look of a file; surroundings stay.
///
/// # Errors
/// A file that cannot be read or has other sections than a look; a value outside its range.
pub fn load_look(scene: &Scene, path: &Path) -> Result<Scene, Error> {
    let mut read = Scene::load(path)?;
    let table = sections(path)?;
    if !table.contains_key(SECTIONS[0]) {
        let message = "no section [look], expected those that `Save look` writes: open a scene in its place";
        return Err(Error::ParseScene { origin: path.display().to_string(), message: message.to_owned() });
    }
    let folder = read.folder.clone();
    maps(&mut read).into_iter().for_each(|map| *map = folder.join(&map));
    let mut scene = scene.clone();
    let surroundings = scene.look.surroundings.take();
    scene.look = read.look;
    scene.look.surroundings = surroundings;
    if table.contains_key(SECTIONS[1]) {
        scene.body_look = read.body_look;
    }
    scene.check()?;
    Ok(scene)
}

/// True for a file that holds a look and nothing else.
pub fn is_look(path: &Path) -> bool {
    sections(path).is_ok_and(|table| {
        table.contains_key(SECTIONS[0]) && table.keys().all(|section| SECTIONS.contains(&section.as_str()))
    })
}

fn sections(path: &Path) -> Result<Table, Error> {
    let text = strandline_base::read_plain(path, crate::scene::MAX_FILE_BYTES)
        .map_err(|source| Error::ReadScene { path: path.to_owned(), source })?;
    Ok(String::from_utf8_lossy(&text).parse().unwrap_or_default())
}

fn maps(scene: &mut Scene) -> Vec<&mut std::path::PathBuf> {
    let look = &mut scene.look;
    let of_groups = look.group.iter_mut().flat_map(|group| [&mut group.color_map, &mut group.width_map]);
    [&mut look.color_map, &mut look.width_map].into_iter().chain(of_groups).flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_comes_back_from_its_file_and_nothing_else_does() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("red.toml");
        let mut scene = Scene::demo();
        scene.look.dress(crate::look::Preset::ALL[2]);
        (scene.look.width_scale, scene.body_look.color.x) = (1.7, 0.123);
        scene.wind.gust = 0.9;
        save_look(&scene, &path).unwrap();
        assert!(is_look(&path));
        let onto = Scene { wind: Default::default(), ..Scene::thesis() };
        let dressed = load_look(&onto, &path).unwrap();
        assert_eq!((&dressed.look, &dressed.body_look), (&scene.look, &scene.body_look));
        let rest = Scene { look: onto.look.clone(), body_look: onto.body_look, ..dressed };
        assert!(rest == onto, "something else came too");
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("[wind]") && text.contains("[look"), "{text}");
        std::fs::write(&path, "[wind]\ngust = 0.5\n").unwrap();
        assert!(load_look(&onto, &path).unwrap_err().to_string().contains("no section [look]"));
        assert!(!is_look(&path) && !is_look(folder.path()));
        std::fs::write(&path, "[look]\nwidth_scale = -1\n").unwrap();
        assert!(load_look(&onto, &path).unwrap_err().to_string().contains("width_scale"));
        assert!(load_look(&onto, Path::new("missing.toml")).is_err());
    }
}
