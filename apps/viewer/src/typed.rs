//! The typed path of a file, with names that complete it.

use std::path::{Path, PathBuf};

use strandline::{format::Format, mesh::MeshFormat};

/// Entries of a folder that are looked at, and names that are offered.
const LOOKED_AT: usize = 4000;
const MOST: usize = 8;

/// Paths that begin with a text: folders, which end with a slash, and files that the window opens, in the order of their
/// names.
pub fn completions(text: &str) -> Vec<String> {
    let (folder, start) = text.rsplit_once('/').map_or(("", text), |(folder, start)| (folder, start));
    let shown = if text.contains('/') { format!("{folder}/") } else { String::new() };
    if text.is_empty() {
        return Vec::new();
    }
    let place = if shown.is_empty() { PathBuf::from(".") } else { PathBuf::from(&shown) };
    let Ok(entries) = std::fs::read_dir(place) else { return Vec::new() };
    let start = start.to_lowercase();
    let mut found: Vec<String> = entries
        .take(LOOKED_AT)
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let fits =
                name.to_lowercase().starts_with(&start) && (!name.starts_with('.') || start.starts_with('.'));
            let path = entry.path();
            let is_folder = path.is_dir();
            (fits && (is_folder || opens(&path)))
                .then(|| format!("{shown}{name}{}", if is_folder { "/" } else { "" }))
        })
        .collect();
    found.sort();
    found.truncate(MOST);
    found.retain(|path| path != text);
    found
}

/// True for files that the window opens, by their endings.
fn opens(file: &Path) -> bool {
    strandline::scene::is_file(file) || Format::is_of(file) || MeshFormat::is_of(file)
}

/// The longest beginning that all of the completions have.
fn common(completions: &[String]) -> Option<String> {
    let first = completions.first()?;
    let ends = first.char_indices().map(|(at, character)| at + character.len_utf8());
    let shared = ends.rev().find(|end| completions.iter().all(|other| other.starts_with(&first[..*end])))?;
    Some(first[..shared].to_owned())
}

/// The path that is typed, and what completes it.
#[derive(Default)]
pub struct Typed {
    pub path: String,
    /// The text that completions were looked up for, those, and true while they are shown.
    asked: String,
    pub offered: Vec<String>,
    pub is_open: bool,
}

impl Typed {
    /// Looks completions up where the text has changed.
    pub fn look_up(&mut self) {
        if self.asked != self.path {
            self.asked.clone_from(&self.path);
            self.offered = completions(self.path.trim());
        }
    }

    /// Completes the path by what all completions have in common, else by the first of them.
    pub fn complete(&mut self) {
        let longer = common(&self.offered).filter(|common| common.len() > self.path.len());
        if let Some(path) = longer.or_else(|| self.offered.first().cloned()) {
            self.path = path;
            self.look_up();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_completed_by_folders_and_files_that_open() {
        let folder = tempfile::tempdir().unwrap();
        let base = folder.path().to_str().unwrap();
        std::fs::create_dir(folder.path().join("grooms")).unwrap();
        for name in ["wavy.hair", "wax.obj", "notes.txt", ".hidden.hair", "Waves.toml"] {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        let names = |text: &str| completions(&format!("{base}/{text}"));
        assert_eq!(names("wa"), ["Waves.toml", "wavy.hair", "wax.obj"].map(|name| format!("{base}/{name}")));
        assert_eq!(names("gr"), [format!("{base}/grooms/")]);
        assert_eq!(names(".h"), [format!("{base}/.hidden.hair")]);
        assert!(names("notes").is_empty() && names("wavy.hair").is_empty() && completions("").is_empty());
        assert_eq!(common(&["a/wavy".to_owned(), "a/wax".to_owned()]).as_deref(), Some("a/wa"));
        assert_eq!(common(&["ä".to_owned(), "ö".to_owned()]), None);
        assert!(completions("/nowhere/at/all").is_empty());
    }
}
