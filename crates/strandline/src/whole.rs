//! Files that are whole or not there.

use std::fs;
use std::path::Path;

/// Writes a file under a temporary name, then renames it.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    fs::write(&part, bytes).and_then(|()| fs::rename(&part, path)).inspect_err(|_| {
        // The first error is the one to tell; a file that never came to be needs no removal.
        let _ = fs::remove_file(&part);
    })
}
