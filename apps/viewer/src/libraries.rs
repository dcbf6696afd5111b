//! The system's libraries that a window on X needs, and which of them is not there.

use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A library and the package that has it in Debian and Ubuntu.
const LIBRARIES: [[&str; 2]; 7] = [
    ["libX11.so.6", "libx11-6"],
    ["libX11-xcb.so.1", "libx11-xcb1"],
    ["libXcursor.so.1", "libxcursor1"],
    ["libXi.so.6", "libxi6"],
    ["libxkbcommon.so.0", "libxkbcommon0"],
    ["libxkbcommon-x11.so.0", "libxkbcommon-x11-0"],
    ["libvulkan.so.1", "libvulkan1"],
];
/// Cache of the loader: paths that end with 0.
const CACHE: &str = "/etc/ld.so.cache";
/// The first bytes of a library.
const MAGIC: &[u8] = b"\x7fELF";

/// The first library that the loader would not find, with its package; `None` if all are there, or if
/// the system keeps no list of them.
pub fn missing() -> Option<String> {
    let cache = std::fs::read(CACHE).ok()?;
    let folders = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    missing_of(&cache, &folders)
}

fn missing_of(cache: &[u8], folders: &OsStr) -> Option<String> {
    let [library, package] = LIBRARIES.into_iter().find(|[library, _]| !is_there(library, cache, folders))?;
    Some(format!("the library {library} is missing or damaged: install it (Debian and Ubuntu: {package})"))
}

/// True if the loader finds a library: in the folders named by the environment first, then by its cache.
fn is_there(library: &str, cache: &[u8], folders: &OsStr) -> bool {
    let named = std::env::split_paths(folders).map(|folder| folder.join(library)).find(|path| path.exists());
    if let Some(path) = named {
        return is_library(&path);
    }
    let ending = format!("/{library}");
    let paths = cache.split(|byte| *byte == 0).filter_map(|text| std::str::from_utf8(text).ok());
    paths.filter(|path| path.ends_with(&ending)).any(|path| is_library(&PathBuf::from(path)))
}

fn is_library(path: &Path) -> bool {
    let mut bytes = [0; MAGIC.len()];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut bytes)).is_ok() && bytes == MAGIC
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_that_is_not_there_is_named_with_its_package() {
        let folder = tempfile::tempdir().unwrap();
        let mut cache = b"glibc-ld.so.cache1.1\0".to_vec();
        for [library, _] in LIBRARIES {
            let path = folder.path().join(library);
            std::fs::write(&path, b"\x7fELF and more").unwrap();
            cache.extend(path.to_str().unwrap().bytes().chain([0]));
        }
        let named = folder.path().join("named");
        assert_eq!(missing_of(&cache, named.as_os_str()), None);
        // A damaged library in a folder that comes first.
        std::fs::create_dir(&named).unwrap();
        std::fs::write(named.join("libXi.so.6"), b"").unwrap();
        assert!(missing_of(&cache, named.as_os_str()).unwrap().contains("libXi.so.6"));
        std::fs::remove_file(folder.path().join("libxkbcommon-x11.so.0")).unwrap();
        let words = missing_of(&cache, OsStr::new("")).unwrap();
        assert!(words.contains("libxkbcommon-x11.so.0") && words.contains("libxkbcommon-x11-0"), "{words}");
        assert!(missing_of(b"", OsStr::new("")).unwrap().contains("libx11-6"));
    }
}
