//! Files that another file names: those in its folder or below it.

use std::path::{Component, Path, PathBuf};

/// The file of a relative name below a folder, also where links lead.
///
/// `None` for a path from the root, a way up, a drive, a share, and for links that lead out of the folder. A file that is
/// not there is refused where it is read.
pub(crate) fn file_below(folder: &Path, name: &str) -> Option<PathBuf> {
    // The folder of a bare name is that of the process.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // A separator of folders or drives on one system counts on all: a file means the same everywhere.
    let is_below = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
    if name.is_empty() || name.contains(['\0', ':', '\\']) || !is_below {
        return None;
    }
    let path = folder.join(name);
    match path.canonicalize() {
        Ok(real) => real.starts_with(folder.canonicalize().ok()?).then_some(path),
        Err(_) => Some(path),
    }
}
