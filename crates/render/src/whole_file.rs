use std::fs::{self, File};
use std::io::{BufWriter, Result};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A file that is whole or not there: it is written under a temporary name and gets its own when it is kept.
/// One that is not kept is removed.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    part: PathBuf,
}

impl WholeFile {
    /// Writes all of it; whatever lies under its name stays as it is.
    ///
    /// # Errors
    /// Whatever the system or `write` reports.
    pub fn write(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> Result<()>) -> Result<Self> {
        // Of two that are written at once each has its own name.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".{}.{}.part", std::process::id(), COUNT.fetch_add(1, Relaxed)));
        let file = Self { path: path.to_owned(), part: path.with_file_name(name) };
        fill(&file.part, write)?;
        Ok(file)
    }

    /// Gives it its name.
    ///
    /// # Errors
    /// Whatever the system reports.
    pub fn keep(self) -> Result<()> {
        fs::rename(&self.part, &self.path)
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        // One that was kept is not there any more, and the first error is the one to tell.
        let _ = fs::remove_file(&self.part);
    }
}

fn fill(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> Result<()>) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    write(&mut file)?;
    file.into_inner()?.sync_all()
}

#[cfg(test)]
mod tests {
    use std::io::{ErrorKind, Write};

    use super::*;

    #[test]
    fn a_file_that_is_not_kept_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, b"old").unwrap();
        let broken = WholeFile::write(&path, |file| {
            file.write_all(b"half")?;
            Err(ErrorKind::StorageFull.into())
        });
        assert!(broken.is_err());
        let first = WholeFile::write(&path, |file| file.write_all(b"one")).unwrap();
        let second = WholeFile::write(&path, |file| file.write_all(b"two")).unwrap();
        drop(first);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        second.keep().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_full_disk_is_an_error() {
        let full = Path::new("/dev/full");
        if full.exists() {
            let error = fill(full, |file| file.write_all(b"x")).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::StorageFull);
        }
    }
}
