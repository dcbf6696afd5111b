use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind, Read, Result, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use crate::temporary::{self, Writer};

/// The file that is locked.
const NAME: &str = ".strandline-lock";
/// Bytes of a file's name in that of its lock: most systems allow 255 in all.
const NAME_BYTES: usize = 160;
/// Bytes of a lock's mark that are read.
const MARK: u64 = 256;

/// A folder, or a name in it, that one run writes at a time.
///
/// The lock is the system's, on a file in the folder: it ends with the process. The file is
/// removed with the lock; a file left by an ended run is taken over.
#[derive(Debug)]
pub struct FolderLock {
    path: PathBuf,
    /// Holds the lock while it is open; `None` on a file system without locks.
    file: Option<File>,
}

impl FolderLock {
    /// Locks an existing folder, and removes unfinished files of ended runs.
    ///
    /// # Errors
    /// `ResourceBusy`: another run holds it. Otherwise an error of the system: the folder cannot be written.
    pub fn take(folder: &Path) -> Result<Self> {
        let lock = Self::at(folder.join(NAME))?;
        if lock.is_held() {
            temporary::clear(folder, Writer::Here);
            temporary::clear(folder, Writer::Foreign);
        }
        Ok(lock)
    }

    /// Locks the name of a file, or of numbered files, in an existing folder: other names stay free.
    ///
    /// # Errors
    /// As [`FolderLock::take`].
    pub fn take_name(file: &Path) -> Result<Self> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let short = &name[..name.floor_char_boundary(NAME_BYTES)];
        let lock = Self::at(file.with_file_name(format!(".{short}{NAME}")))?;
        temporary::clear(file.parent().unwrap_or(Path::new("")), Writer::Here);
        Ok(lock)
    }

    fn at(path: PathBuf) -> Result<Self> {
        loop {
            let Some(mut file) = open(&path)? else { continue };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(ErrorKind::ResourceBusy.into()),
                Err(TryLockError::Error(_)) => {
                    fs::remove_file(&path)?;
                    return Ok(Self { path, file: None });
                }
            }
            // The holder before may have removed it after it was opened here, and a third may have made
            // another: then this lock excludes no other run.
            if is_there(&mut file, &path) {
                temporary::hold().add(&path);
                mark(&mut file)?;
                return Ok(Self { path, file: Some(file) });
            }
        }
    }

    /// True if the lock excludes other processes: some file systems have no locks.
    pub fn is_held(&self) -> bool {
        self.file.is_some()
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if self.file.is_some() {
            // Removed before it is given back.
            let _ = fs::remove_file(&self.path);
            temporary::hold().forget(&self.path);
        }
    }
}

/// The file of a lock, made if it is missing; `None` if it was removed meanwhile.
fn open(path: &Path) -> Result<Option<File>> {
    let mut options = OpenOptions::new();
    options.read(true).write(true);
    match options.clone().create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
        made => return made.map(Some),
    }
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_file() => {}
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        // A link is not followed: its target is not ours to lock.
        _ => return Err(Error::other(format!("{NAME} in the folder is not a plain file: remove it"))),
    }
    match options.open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        opened => opened.map(Some),
    }
}

/// Writes a mark that no other lock has.
fn mark(file: &mut File) -> Result<()> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos());
    file.rewind()?;
    file.set_len(0)?;
    write!(file, "strandline, process {}, {now}", std::process::id())
}

/// True if the open file is still the file of that name: both have the same mark.
fn is_there(file: &mut File, path: &Path) -> bool {
    let read = |file: &mut File| {
        let mut bytes = Vec::new();
        file.take(MARK).read_to_end(&mut bytes).map(|_| bytes)
    };
    let here = read(file);
    match File::open(path).map(|mut named| read(&mut named)) {
        Err(_) => false,
        Ok(Ok(there)) => here.is_ok_and(|here| here == there),
        // Systems on which a locked file cannot be read do not let an open file be removed either.
        Ok(Err(_)) => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_locked_once_and_free_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let first = FolderLock::take(folder.path()).unwrap();
        assert!(first.is_held());
        assert_eq!(FolderLock::take(folder.path()).unwrap_err().kind(), ErrorKind::ResourceBusy);
        assert!(FolderLock::take(&folder.path().join("absent")).is_err());
        drop(first);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let names = ["a.png", "b.png"].map(|name| FolderLock::take_name(&folder.path().join(name)).unwrap());
        assert_eq!(
            FolderLock::take_name(&folder.path().join("a.png")).unwrap_err().kind(),
            ErrorKind::ResourceBusy
        );
        drop(names);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        // A lock left by an ended run is taken over, with its unfinished files.
        fs::write(folder.path().join(NAME), b"of another").unwrap();
        fs::write(folder.path().join("video.1-1.strandline-foreign-part"), b"half").unwrap();
        fs::write(folder.path().join("frame.1-1.strandline-part"), b"half").unwrap();
        drop(FolderLock::take(folder.path()).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn of_many_at_once_one_has_it() {
        let folder = tempfile::tempdir().unwrap();
        let inside = std::sync::atomic::AtomicU32::new(0);
        let run = || {
            let mut taken = 0;
            while taken < 50 {
                let Ok(lock) = FolderLock::take(folder.path()) else { continue };
                assert_eq!(inside.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0);
                std::thread::yield_now();
                assert_eq!(inside.fetch_sub(1, std::sync::atomic::Ordering::SeqCst), 1);
                drop(lock);
                taken += 1;
            }
        };
        std::thread::scope(|scope| (0..3).for_each(|_| drop(scope.spawn(run))));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_place_of_the_lock_is_refused_and_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("target");
        fs::write(&target, b"mine").unwrap();
        std::os::unix::fs::symlink(&target, folder.path().join(NAME)).unwrap();
        let error = FolderLock::take(folder.path()).unwrap_err().to_string();
        assert!(error.contains("not a plain file: remove it"), "{error}");
        assert_eq!(fs::read(&target).unwrap(), b"mine");
    }
}
