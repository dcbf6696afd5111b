//! Files that were opened lately, kept between two runs.

use std::path::{Path, PathBuf};

/// Files that are kept.
const MOST: usize = 12;

/// Files that were opened lately, the last first.
#[derive(Default)]
pub struct Recent {
    /// The file that has their paths, a line each; `None` keeps them for this run.
    place: Option<PathBuf>,
    files: Vec<PathBuf>,
}

impl Recent {
    /// Files of earlier runs of this user.
    pub fn of_user() -> Self {
        let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let folder = folder("XDG_STATE_HOME")
            .or_else(|| folder("LOCALAPPDATA"))
            .or_else(|| folder("HOME").map(|home| home.join(".local/state")));
        folder.map_or_else(Self::default, |folder| Self::load(&folder.join("strandline/recent.txt")))
    }

    /// Those that a file has; none where it cannot be read.
    pub fn load(place: &Path) -> Self {
        let text = std::fs::read_to_string(place).unwrap_or_default();
        let files = text.lines().filter(|line| !line.is_empty()).take(MOST).map(PathBuf::from).collect();
        Self { place: Some(place.to_owned()), files }
    }

    /// Puts a file first. A list that cannot be written is kept for this run.
    pub fn add(&mut self, file: &Path) {
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        self.files.retain(|other| *other != file);
        self.files.insert(0, file);
        self.files.truncate(MOST);
        let Some(place) = &self.place else { return };
        let lines: Vec<String> = self.files.iter().map(|file| format!("{}\n", file.display())).collect();
        let _ = place.parent().map(std::fs::create_dir_all);
        let _ = std::fs::write(place, lines.concat());
    }

    /// The files, the last first.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_files_come_first_and_are_there_in_the_next_run() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("state/recent.txt");
        let mut recent = Recent::load(&place);
        assert!(recent.files().is_empty());
        for number in 0..20 {
            recent.add(Path::new(&format!("/hair/{number}.hair")));
        }
        recent.add(Path::new("/hair/15.hair"));
        let again = Recent::load(&place);
        assert_eq!(again.files(), recent.files());
        assert_eq!((again.files().len(), again.files()[0].as_path()), (MOST, Path::new("/hair/15.hair")));
        assert_eq!(again.files().iter().filter(|file| file.ends_with("15.hair")).count(), 1);
    }
}
