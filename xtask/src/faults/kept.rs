//! Folders of results and of trees with planted faults.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::cargo::root;

/// Everything of planted faults that is kept from run to run.
pub fn kept() -> PathBuf {
    root().join("target/faults")
}

/// Makes the folder of a file.
pub fn make_room(path: &Path) -> Result<()> {
    let folder = path.parent().context("a file in a folder")?;
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())
}
