//! A copy of the working tree to plant faults in.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// A copy of the files that git knows or would know.
pub struct Tree {
    /// Folder of the copy.
    pub folder: PathBuf,
    /// Tells one state of the files from another.
    pub hash: String,
}

impl Tree {
    /// Brings a copy up to date; files that are the same are left alone, so that little is built again.
    pub fn copy(from: &Path, to: &Path) -> Result<Self> {
        let files = listed(from)?;
        let mut hasher = DefaultHasher::new();
        let known: BTreeSet<&PathBuf> = files.iter().collect();
        if to.exists() {
            for old in present(to, to)? {
                if !known.contains(&old) {
                    std::fs::remove_file(to.join(&old))?;
                }
            }
        }
        for file in &files {
            let bytes = std::fs::read(from.join(file)).with_context(|| file.display().to_string())?;
            // A document does not change what tests see.
            if file.extension().is_none_or(|ending| ending != "md") {
                (file, &bytes).hash(&mut hasher);
            }
            let place = to.join(file);
            if std::fs::read(&place).ok().as_ref() != Some(&bytes) {
                std::fs::create_dir_all(place.parent().unwrap_or(to))?;
                std::fs::write(&place, &bytes)?;
            }
        }
        Ok(Self { folder: to.to_owned(), hash: format!("{:016x}", hasher.finish()) })
    }
}

/// The files of a working tree, without what git ignores.
fn listed(folder: &Path) -> Result<Vec<PathBuf>> {
    let list = ["ls-files", "--cached", "--others", "--exclude-standard", "-z"];
    let output = Command::new("git").args(list).current_dir(folder).output().context("git ls-files")?;
    ensure!(output.status.success(), "git ls-files: {}", String::from_utf8_lossy(&output.stderr));
    let names = String::from_utf8(output.stdout)?;
    let mut files: Vec<PathBuf> = names.split_terminator('\0').map(PathBuf::from).collect();
    // A file that was deleted, but not yet in git.
    files.retain(|file| folder.join(file).is_file());
    files.sort();
    files.dedup();
    Ok(files)
}

/// All files under a folder, relative to it.
fn present(folder: &Path, top: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(present(&path, top)?);
        } else {
            files.push(path.strip_prefix(top)?.to_owned());
        }
    }
    Ok(files)
}
