//! Files of the scene that are loaded again when they change on disk.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use strandline::{Mesh, Scene};

/// Interval at which the times of files are read.
pub const INTERVAL: Duration = Duration::from_millis(500);

/// Most files of a sequence that are looked at: some of those that are written anew are among them.
const MOST_STAMPED: usize = 256;

/// Time of the last change and size of a file, or of the files of a sequence in all; `None` while it is not there.
type Stamp = Option<(SystemTime, u64)>;

/// Reads the scene of the window anew.
pub type Reload = Box<dyn Fn() -> Result<Scene, String> + Send>;

/// Files that are watched.
#[derive(Default)]
pub struct Watch {
    /// True while changes are loaded.
    pub on: bool,
    /// The file of the scene, and its reader.
    pub scene: Option<(PathBuf, Reload)>,
    /// A note for when files that changed are loaded.
    pub reloads: Option<String>,
    /// The files with their stamps as loaded.
    files: BTreeMap<PathBuf, Stamp>,
    /// Files with other stamps, as they were at the last look: one that is still being written is not read.
    changing: BTreeMap<PathBuf, Stamp>,
    looked: Option<Instant>,
}

fn stamp(file: &Path) -> Stamp {
    let frames = Mesh::sequence_files(file);
    let every = frames.len().div_ceil(MOST_STAMPED).max(1);
    let some = frames.iter().rev().step_by(every).filter_map(|frame| stamp_of_one(frame));
    let all = some.reduce(|(one, length), (other, own)| (one.max(other), length + own));
    all.map(|(time, length)| (time, length + frames.len() as u64)).or_else(|| stamp_of_one(file))
}

fn stamp_of_one(file: &Path) -> Stamp {
    let metadata = std::fs::metadata(file).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

impl Watch {
    /// Takes the file of the scene with its reader.
    pub fn scene_file(&mut self, file: &Path, reload: Reload) {
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        self.scene = Some((file, reload));
    }

    /// Takes the files of a scene as they are now.
    pub fn note(&mut self, scene: &Scene) {
        let mut named = scene.clone();
        let files = named.paths_mut().map(|path| scene.folder.join(path));
        let files = files.chain(self.scene.iter().map(|(file, _)| file.clone()));
        self.files = files.map(|file| (stamp(&file), file)).map(|(stamp, file)| (file, stamp)).collect();
        self.changing.clear();
    }

    /// Files that have changed since they were loaded, and are complete: none changed between two looks.
    pub fn changed(&mut self) -> Vec<PathBuf> {
        let now = self.files.iter().map(|(file, loaded)| (file, loaded, stamp(file)));
        let other: BTreeMap<PathBuf, Stamp> = now
            .filter(|(_, loaded, now)| now.is_some() && now != *loaded)
            .map(|(file, _, now)| (file.clone(), now))
            .collect();
        let is_settled = other == self.changing;
        self.changing = other;
        if !is_settled {
            return Vec::new();
        }
        let settled = std::mem::take(&mut self.changing);
        self.files.extend(settled.iter().map(|(file, stamp)| (file.clone(), *stamp)));
        settled.into_keys().collect()
    }

    /// True where it is time to look at the files.
    pub fn is_due(&mut self) -> bool {
        let is_due = self.on && self.looked.is_none_or(|looked| looked.elapsed() >= INTERVAL);
        if is_due {
            self.looked = Some(Instant::now());
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_changed_once_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let (groom, body) = (folder.path().join("a.hair"), folder.path().join("b.obj"));
        std::fs::write(&groom, b"one").unwrap();
        let mut scene = Scene::demo();
        (scene.groom.file, scene.body.file) = (Some(groom.clone()), Some(body.clone()));
        let mut watch = Watch::default();
        watch.note(&scene);
        assert!(watch.changed().is_empty());
        std::fs::write(&groom, b"two, longer").unwrap();
        assert!(watch.changed().is_empty(), "it may still be written");
        std::fs::write(&groom, b"two, and longer yet").unwrap();
        assert!(watch.changed().is_empty(), "it was");
        assert_eq!(watch.changed(), std::slice::from_ref(&groom));
        assert!(watch.changed().is_empty(), "once");
        // A file that comes counts, one that goes is waited for.
        std::fs::remove_file(&groom).unwrap();
        std::fs::write(&body, b"v 0 0 0").unwrap();
        watch.changed();
        assert_eq!(watch.changed(), [body]);
    }

    #[test]
    fn the_frames_of_a_sequence_are_watched() {
        let folder = tempfile::tempdir().unwrap();
        let frame = |number: usize| folder.path().join(format!("walk{number:02}.obj"));
        (1..4).for_each(|number| std::fs::write(frame(number), b"v 0 0 0").unwrap());
        for path in [folder.path().join("walk%02d.obj"), folder.path().to_owned()] {
            let mut scene = Scene::demo();
            scene.body.file = Some(path.clone());
            let mut watch = Watch::default();
            watch.note(&scene);
            assert!(watch.changed().is_empty() && watch.changed().is_empty());
            let text = std::fs::read(frame(2)).unwrap();
            std::fs::write(frame(2), [&text[..], b"\nv 1 1 1"].concat()).unwrap();
            watch.changed();
            assert_eq!(watch.changed(), std::slice::from_ref(&path), "a frame");
            let last = Mesh::sequence_files(&path).len() + 1;
            std::fs::write(frame(last), b"v 0 0 0").unwrap();
            watch.changed();
            assert_eq!(watch.changed(), [path], "a further frame");
        }
    }
}
