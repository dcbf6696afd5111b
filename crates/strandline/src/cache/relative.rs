//! Paths of a scene as seen from the folder of a cache: a cache moves with its files and tells nothing of the machine.

use std::path::{Component, Path, PathBuf};

use crate::Scene;

/// A scene whose paths start from the folder of a file. Paths on another drive stay absolute.
pub(crate) fn from(file: &Path, scene: &Scene) -> Scene {
    let mut moved = scene.clone();
    let home = real(folder_of(file));
    let folder = std::mem::take(&mut moved.folder);
    let to = |path: &Path| relative(&home, &real(&folder.join(path)));
    moved.paths_mut().for_each(|path| *path = to(path));
    moved.groom.pose = moved.groom.pose.map(|path| to(&path));
    moved
}

/// A scene with absolute paths.
pub(crate) fn resolved(scene: &Scene) -> Scene {
    let mut resolved = scene.clone();
    let folder = std::mem::take(&mut resolved.folder);
    resolved.paths_mut().for_each(|path| *path = real(&folder.join(&path)));
    resolved.groom.pose = resolved.groom.pose.map(|path| real(&folder.join(path)));
    resolved
}

/// The folder of a file; empty for the current one.
pub(super) fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// A path without links and dots, as far as it is there.
fn real(path: &Path) -> PathBuf {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut missing = Vec::new();
    for known in whole.ancestors() {
        if let Ok(found) = known.canonicalize() {
            return missing.into_iter().rev().fold(found, |path, name| path.join(name));
        }
        missing.extend(known.file_name());
    }
    whole
}

/// The way from a folder to a path, both real.
fn relative(folder: &Path, path: &Path) -> PathBuf {
    let (from, to): (Vec<Component>, Vec<Component>) =
        (folder.components().collect(), path.components().collect());
    let shared = from.iter().zip(&to).take_while(|(one, other)| one == other).count();
    if shared == 0 {
        return path.to_owned();
    }
    let up = std::iter::repeat_n(Component::ParentDir, from.len() - shared);
    up.chain(to[shared..].iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_up_and_down() {
        for (folder, path, way) in [
            ("/a/b", "/a/b/c.hair", "c.hair"),
            ("/a/b", "/a/c/d.hair", "../c/d.hair"),
            ("/a/b/c", "/d.hair", "../../../d.hair"),
        ] {
            assert_eq!(relative(Path::new(folder), Path::new(path)), Path::new(way));
        }
    }

    #[test]
    fn a_scene_in_a_cache_names_files_from_there() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        std::fs::create_dir_all(at("scenes")).unwrap();
        std::fs::create_dir_all(at("out")).unwrap();
        std::fs::write(at("scenes/a.hair"), b"").unwrap();
        let mut scene = Scene { folder: at("scenes"), ..Scene::default() };
        (scene.groom.file, scene.body.file) = (Some("a.hair".into()), Some(at("scenes/../head.obj")));
        let moved = from(&at("out/a.npz"), &scene);
        assert_eq!(moved.groom.file.as_deref(), Some(Path::new("../scenes/a.hair")));
        assert_eq!(moved.folder, Path::new(""));
        let mut back = moved.clone();
        back.folder = at("out");
        assert_eq!(resolved(&back).groom.file, resolved(&scene).groom.file);
        assert!(!moved.to_toml().contains(&*home.path().to_string_lossy()), "{}", moved.to_toml());
    }
}
