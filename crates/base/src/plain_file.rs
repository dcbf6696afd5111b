use std::fs::{self, File, Metadata};
use std::io::{Error, ErrorKind, Read, Result, Take};
use std::path::Path;

/// False in a browser page, whose module then leaves out what reads and writes files.
pub(crate) const HAS_FILES: bool = cfg!(not(target_family = "wasm"));

/// Opens a plain file of `limit` bytes at most, links followed. No more than `limit` + 1 bytes can be read.
///
/// The type of the file is checked before it is opened: opening a pipe waits for a writer, and opening a device can
/// have side effects. A pipe that replaces the file between the check and the opening makes this wait. Only a
/// process that may write the folder can do so, and the flag that would prevent it differs on every system.
///
/// # Errors
/// Errors of the system; anything but a plain file; a file that is too large.
pub fn open_plain(path: &Path, limit: u64) -> Result<Take<File>> {
    if !HAS_FILES {
        return Err(ErrorKind::Unsupported.into());
    }
    check(&fs::metadata(path)?, limit)?;
    let file = File::open(path)?;
    check(&file.metadata()?, limit)?;
    Ok(file.take(limit.saturating_add(1)))
}

/// Reads a plain file of `limit` bytes at most.
///
/// # Errors
/// As [`open_plain`]; no memory for it.
pub fn read_plain(path: &Path, limit: u64) -> Result<Vec<u8>> {
    if !HAS_FILES {
        return Err(ErrorKind::Unsupported.into());
    }
    let mut file = open_plain(path, limit)?;
    let length = usize::try_from(file.get_ref().metadata()?.len()).map_err(|_| ErrorKind::FileTooLarge)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length.saturating_add(1)).map_err(|_| ErrorKind::OutOfMemory)?;
    file.read_to_end(&mut bytes)?;
    // It may have grown meanwhile, and some say that they are empty.
    if bytes.len() as u64 > limit { Err(too_large("more", limit)) } else { Ok(bytes) }
}

fn check(found: &Metadata, limit: u64) -> Result<()> {
    if !found.is_file() {
        let kind = if found.is_dir() { "a folder" } else { "a device or a pipe" };
        return Err(Error::new(ErrorKind::InvalidInput, format!("it is {kind}, expected a plain file")));
    }
    if found.len() > limit {
        return Err(too_large(&format!("{} bytes", found.len()), limit));
    }
    Ok(())
}

fn too_large(found: &str, limit: u64) -> Error {
    let most = match limit {
        limit if limit >= 1 << 20 => format!("{} MiB", limit >> 20),
        limit => format!("{limit} bytes"),
    };
    Error::new(ErrorKind::FileTooLarge, format!("it holds {found}, expected {most} at most"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, b"four").unwrap();
        assert_eq!(read_plain(&path, 4).unwrap(), b"four");
        let error = read_plain(&path, 3).unwrap_err().to_string();
        assert!(error.contains("4 bytes, expected 3 bytes at most"), "{error}");
        let error = read_plain(folder.path(), 3).unwrap_err().to_string();
        assert!(error.contains("a folder, expected a plain file"), "{error}");
        assert_eq!(read_plain(&folder.path().join("b"), 3).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_and_pipes_are_refused_at_once_and_files_that_say_they_are_empty_are_cut() {
        let folder = tempfile::tempdir().unwrap();
        let (link, pipe) = (folder.path().join("zero"), folder.path().join("pipe"));
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for path in [&link, &pipe] {
            let error = read_plain(path, 1 << 20).unwrap_err().to_string();
            assert!(error.contains("a device or a pipe"), "{error}");
        }
        assert!(read_plain(Path::new("/proc/self/maps"), 10).unwrap_err().to_string().contains("more"));
    }
}
