use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind, Result, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::plain_file::HAS_FILES;
use crate::temporary::{self, Writer};
use crate::whole_file::permissions;

/// A file that a long run writes and that is sound all the while, so that it has a name before it is finished.
///
/// * It begins under a temporary name, as [`WholeFile`](crate::WholeFile) does, and is removed when it is
///   dropped before [`GrowingFile::publish`].
/// * From then on it lies under its own name, or, where a file of that name was there before, beside it with
///   `.unfinished` before its ending: the file of an earlier run is replaced by a finished file only.
/// * It stays if the run ends early. The writer has to keep it sound at every moment.
/// * It is locked: a second run on the same file is refused.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    /// Current path.
    place: PathBuf,
    published: bool,
    file: File,
    /// Every change, so that tests can end a run between any two of them.
    #[cfg(test)]
    pub(crate) changes: Vec<Change>,
}

#[cfg(test)]
#[derive(Clone, Debug)]
pub(crate) enum Change {
    Write(u64, Vec<u8>),
    Cut(u64),
    Publish,
}

impl GrowingFile {
    /// Begins a file; an existing file of its name stays until it is finished.
    ///
    /// # Errors
    /// `ResourceBusy`: another run writes it. Otherwise an error of the system; a name under which a file may
    /// not be put.
    pub fn create(path: &Path) -> Result<Self> {
        if !HAS_FILES {
            return Err(ErrorKind::Unsupported.into());
        }
        let former = permissions(path)?;
        for path in [path, &unfinished(path)] {
            refuse_busy(path)?;
        }
        let (temporary, file) = temporary::create(path, Writer::Here)?;
        let growing = Self {
            path: path.to_owned(),
            place: temporary,
            published: false,
            file,
            #[cfg(test)]
            changes: Vec::new(),
        };
        if let Some(former) = former {
            growing.file.set_permissions(former)?;
        }
        Ok(growing)
    }

    /// Current path.
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// Writes bytes at an offset; a gap behind the end is filled with 0.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn write_at(&mut self, offset: u64, bytes: &[u8]) -> Result<()> {
        #[cfg(test)]
        self.changes.push(Change::Write(offset, bytes.to_vec()));
        self.file.seek(SeekFrom::Start(offset))?;
        self.file.write_all(bytes)
    }

    /// Cuts the file off.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn cut(&mut self, length: u64) -> Result<()> {
        #[cfg(test)]
        self.changes.push(Change::Cut(length));
        self.file.set_len(length)
    }

    /// Publishes it: from now on it stays, even if the run ends early.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn publish(&mut self) -> Result<()> {
        if self.published {
            return Ok(());
        }
        #[cfg(test)]
        self.changes.push(Change::Publish);
        let place = if self.path.exists() { unfinished(&self.path) } else { self.path.clone() };
        permissions(&place)?;
        // With the list of temporary files in hand: a process that ends at once removes it before or not at all.
        let mut list = temporary::hold();
        fs::rename(&self.place, &place)?;
        list.forget(&self.place);
        (self.place, self.published) = (place, true);
        Ok(())
    }

    /// Waits until it is on the disk and gives it its name.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn finish(mut self) -> Result<()> {
        self.publish()?;
        self.file.sync_all()?;
        self.check_place()?;
        if self.place != self.path {
            permissions(&self.path)?;
            fs::rename(&self.place, &self.path)?;
        }
        Ok(())
    }

    /// Waits until it is on the disk and leaves it where it lies, which is returned.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn leave(mut self) -> Result<PathBuf> {
        self.publish()?;
        self.file.sync_all()?;
        self.check_place()?;
        Ok(self.place.clone())
    }

    /// Refuses to go on where somebody has removed or replaced the file meanwhile.
    fn check_place(&self) -> Result<()> {
        let there = fs::symlink_metadata(&self.place);
        #[cfg(unix)]
        let is_own = {
            use std::os::unix::fs::MetadataExt;
            let own = self.file.metadata()?;
            there.is_ok_and(|there| (there.dev(), there.ino()) == (own.dev(), own.ino()))
        };
        #[cfg(not(unix))]
        let is_own = there.is_ok();
        let lost =
            || Error::other("it was removed or replaced while it was written, and its frames are lost");
        if is_own { Ok(()) } else { Err(lost()) }
    }
}

impl Drop for GrowingFile {
    fn drop(&mut self) {
        if !self.published {
            let mut list = temporary::hold();
            // The first error is the one to report.
            let _ = fs::remove_file(&self.place);
            list.forget(&self.place);
        }
    }
}

/// `a.npz` becomes `a.unfinished.npz`.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = OsString::from(path.file_stem().unwrap_or_default());
    name.push(".unfinished");
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}

/// Refuses a file that another run has locked; without locks of the file system it refuses none.
///
/// # Errors
/// `ResourceBusy`: another run writes it.
pub fn refuse_busy(path: &Path) -> Result<()> {
    let Ok(found) = fs::symlink_metadata(path) else { return Ok(()) };
    if !found.is_file() {
        return Ok(());
    }
    match OpenOptions::new().write(true).open(path).map(|file| file.try_lock()) {
        Ok(Err(TryLockError::WouldBlock)) => Err(ErrorKind::ResourceBusy.into()),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::temporary::names;

    #[test]
    fn it_has_its_name_before_it_is_finished_and_keeps_it_when_the_run_ends() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        let mut file = GrowingFile::create(&path).unwrap();
        file.write_at(2, b"two").unwrap();
        assert!(!path.exists());
        drop(file);
        assert!(names(folder.path()).is_empty());
        let mut file = GrowingFile::create(&path).unwrap();
        file.write_at(2, b"two").unwrap();
        file.publish().unwrap();
        assert_eq!(GrowingFile::create(&path).unwrap_err().kind(), ErrorKind::ResourceBusy);
        file.write_at(0, b"12").unwrap();
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), b"12two");
        assert_eq!(names(folder.path()), ["a.npz"]);
    }

    #[test]
    fn an_earlier_file_is_replaced_by_a_finished_one_only() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        fs::write(&path, b"old").unwrap();
        let mut file = GrowingFile::create(&path).unwrap();
        file.write_at(0, b"new").unwrap();
        file.publish().unwrap();
        assert_eq!(file.place(), folder.path().join("a.unfinished.npz"));
        assert_eq!(GrowingFile::create(&path).unwrap_err().kind(), ErrorKind::ResourceBusy);
        let place = file.leave().unwrap();
        assert_eq!((fs::read(&path).unwrap(), fs::read(&place).unwrap()), (b"old".into(), b"new".into()));
        let mut file = GrowingFile::create(&path).unwrap();
        file.write_at(0, b"newer").unwrap();
        file.cut(4).unwrap();
        file.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"newe");
        assert_eq!(names(folder.path()), ["a.npz"]);
    }

    #[test]
    fn a_file_that_somebody_removed_or_replaced_is_not_called_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        for replaced in [false, true] {
            let mut file = GrowingFile::create(&path).unwrap();
            file.publish().unwrap();
            fs::remove_file(&path).unwrap();
            if replaced {
                fs::write(&path, b"of another").unwrap();
            }
            if cfg!(unix) || !replaced {
                let error = file.finish().unwrap_err().to_string();
                assert!(error.contains("removed or replaced"), "{error}");
            }
        }
    }

    #[test]
    fn what_is_no_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(GrowingFile::create(folder.path()).is_err());
        assert_eq!(unfinished(Path::new("x/a")), Path::new("x/a.unfinished"));
    }
}
