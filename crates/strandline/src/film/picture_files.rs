//! Writes the frames of a film as files that are named: .png, or .exr.

use std::path::{Path, PathBuf};

use strandline_base::FolderLock;

use super::{claim_name, still_there, unlocked};
use crate::{
    Error,
    render::{Layers, Picture},
};

/// Receives the pictures of a film in order, or their layers, and writes a file for each, .png or .exr.
///
/// A film of one picture is the file that is named; of more, each has its number before the ending:
/// `hair_0000.png`. Every file is whole once it has its name. One film at a time is written under a name: those of
/// other names may be written into the same folder meanwhile.
pub struct PictureFiles {
    path: PathBuf,
    frames: u32,
    files: Vec<PathBuf>,
    lock: FolderLock,
}

impl PictureFiles {
    /// A film of `frames` pictures; the folder of the file is made when it is not there.
    ///
    /// # Errors
    /// The folder cannot be made or written, or another film is being written there under that name.
    pub fn new(path: &Path, frames: u32) -> Result<Self, Error> {
        let lock = claim_name(path)?;
        Ok(Self { path: path.to_owned(), frames, files: Vec::new(), lock })
    }

    /// Number of files so far.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// True before the first file.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// The file cannot be written; earlier ones stay.
    pub fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let file = self.next("png");
        picture.save(&file)?;
        self.files.push(file);
        Ok(())
    }

    /// Writes the next picture's layers.
    ///
    /// # Errors
    /// As [`PictureFiles::add`].
    pub fn add_layers(&mut self, layers: &Layers) -> Result<(), Error> {
        let file = self.next("exr");
        layers.save(&file)?;
        self.files.push(file);
        Ok(())
    }

    fn next(&self, ending: &str) -> PathBuf {
        if self.frames == 1 {
            return self.path.clone();
        }
        self.path.with_file_name(format!("{}_{:04}.{ending}", self.stem(), self.files.len()))
    }

    /// The files, in order, and notes for a person: of locks that the file system has not, and of files that an
    /// earlier, longer film left.
    pub fn finish(self) -> (Vec<PathBuf>, Vec<String>) {
        let notes = unlocked(&self.lock).into_iter().chain(self.leftovers()).collect();
        (self.files, notes)
    }

    fn stem(&self) -> String {
        self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn leftovers(&self) -> Option<String> {
        let stem = format!("{}_", self.stem());
        let ending = format!(".{}", self.path.extension().unwrap_or_default().to_string_lossy());
        let number = |name: &String| {
            let digits = name.strip_prefix(&stem)?.strip_suffix(&ending)?;
            let is_ours = digits.len() >= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
            digits.parse::<usize>().ok().filter(|_| is_ours)
        };
        let written = if self.frames == 1 { 0 } else { self.files.len() };
        let entries = std::fs::read_dir(folder(&self.path)).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut old: Vec<String> =
            names.filter(|name| number(name).is_some_and(|number| number >= written)).collect();
        old.sort_by_key(number);
        still_there(&old)
    }
}

/// The folder that a file lies in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_made_and_held_and_older_frames_are_noted() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("new/hair.exr");
        let film = PictureFiles::new(&path, 3).unwrap();
        let busy = PictureFiles::new(&path, 3).err().expect("a folder that is taken").to_string();
        assert!(busy.contains("new"), "{busy}");
        assert!(PictureFiles::new(&path.with_file_name("other.exr"), 3).is_ok(), "another name is free");
        for name in ["hair_0000.exr", "hair_0002.exr", "hair_00x2.exr", "other_0009.exr", "hair_0001.png"] {
            std::fs::write(path.with_file_name(name), b"old").unwrap();
        }
        let (files, notes) = film.finish();
        assert!(files.is_empty());
        assert_eq!(
            notes,
            ["of an earlier film there are still hair_0000.exr and hair_0002.exr in the folder"]
        );
        assert!(PictureFiles::new(&path, 1).is_ok(), "it is free again");
    }

    #[test]
    fn a_file_without_a_folder_lies_here() {
        assert_eq!(folder(Path::new("hair.exr")), Path::new("."));
        assert_eq!(folder(Path::new("a/hair.exr")), Path::new("a"));
    }
}
