//! Folders of the page's build.

use std::path::PathBuf;

use crate::cargo::root;

/// Everything that the build of the page needs.
pub fn work() -> PathBuf {
    root().join("target/web")
}

/// The finished page.
pub fn site() -> PathBuf {
    root().join("out/web")
}
