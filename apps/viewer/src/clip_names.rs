//! Names of the clips of a body's file.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use strandline::{Mesh, mesh::MeshFormat};

/// Clips of the file that was looked into last.
#[derive(Default)]
pub struct Clips {
    file: PathBuf,
    changed: Option<SystemTime>,
    names: Vec<String>,
}

impl Clips {
    /// The clips of a file; none of one that has none or cannot be read, which a load of it tells.
    pub fn of(&mut self, file: &Path) -> &[String] {
        let changed = file.metadata().and_then(|about| about.modified()).ok();
        if self.file != file || self.changed != changed {
            (self.file, self.changed) = (file.to_owned(), changed);
            let has_clips = MeshFormat::is_of(file);
            self.names = if has_clips { Mesh::clip_names(file).unwrap_or_default() } else { Vec::new() };
        }
        &self.names
    }
}
