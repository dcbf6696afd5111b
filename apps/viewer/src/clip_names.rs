//! Names of the clips of a body's file.

use std::path::{Path, PathBuf};

use strandline::{Mesh, mesh::MeshFormat};

/// Clips of the file that was looked into last.
#[derive(Default)]
pub struct Clips {
    file: PathBuf,
    names: Vec<String>,
}

impl Clips {
    /// The clips of a file; none of one that has none or cannot be read, which a load of it tells.
    pub fn of(&mut self, file: &Path) -> &[String] {
        if self.file != file {
            self.file = file.to_owned();
            let has_clips = MeshFormat::is_of(file);
            self.names = if has_clips { Mesh::clip_names(file).unwrap_or_default() } else { Vec::new() };
        }
        &self.names
    }
}
