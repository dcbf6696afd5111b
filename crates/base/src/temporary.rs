//! Files under a temporary name: the pattern of such names, the list of those that this process writes, and the removal
//! of those that a killed run left.

use std::collections::HashSet;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Result};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The end of every temporary name.
const SUFFIX: &str = ".strandline-part";
/// The end of the temporary name of a file that another program writes.
const FOREIGN_SUFFIX: &str = ".strandline-foreign-part";
/// Bytes of the file's own name in its temporary one: most systems allow 255 in all.
const NAME_BYTES: usize = 160;
/// Folders that are remembered as cleared.
const FOLDERS: usize = 1024;

/// Files to remove when the process ends at once, and the folders that were cleared. There is one list per
/// process, because a thread that handles signals sees nothing else of the writers.
static TEMPORARY: Mutex<Option<Temporary>> = Mutex::new(None);

#[derive(Debug, Default)]
pub(crate) struct Temporary {
    written: Vec<PathBuf>,
    cleared: HashSet<PathBuf>,
    count: u64,
}

/// Access to the list of temporary files, which no other thread has meanwhile.
pub(crate) struct ListGuard(MutexGuard<'static, Option<Temporary>>);

pub(crate) fn hold() -> ListGuard {
    ListGuard(TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner))
}

impl ListGuard {
    fn list(&mut self) -> &mut Temporary {
        self.0.get_or_insert_default()
    }

    /// Lets a file be removed when the process ends at once.
    pub fn add(&mut self, path: &Path) {
        self.list().written.push(path.to_owned());
    }

    /// A file has its own name, or is gone.
    pub fn forget(&mut self, path: &Path) {
        self.list().written.retain(|temporary| temporary != path);
    }

    /// A number that no other temporary file of this process has.
    fn number(&mut self) -> u64 {
        let list = self.list();
        list.count += 1;
        list.count
    }
}

/// Keeps this process from writing files, as long as it lives.
pub struct Abandoned {
    _held: ListGuard,
}

/// Removes every unfinished file of this process, and lets none begin or get its name
/// until the value is dropped: for a process that is about to end at once.
pub fn abandon_unfinished() -> Abandoned {
    let mut held = hold();
    for temporary in std::mem::take(&mut held.list().written) {
        // A temporary file that is gone already needs no removal.
        let _ = fs::remove_file(temporary);
    }
    Abandoned { _held: held }
}

/// Writer of a temporary file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Writer {
    /// This process, which holds a lock on it.
    Here,
    /// Another program, whom a lock would keep out on some systems.
    Foreign,
}

/// Creates a temporary file of `path` beside it, under a unique name.
pub(crate) fn create(path: &Path, writer: Writer) -> Result<(PathBuf, File)> {
    let name = path.file_name().ok_or(ErrorKind::InvalidFilename)?;
    clear_once(folder_of(path));
    loop {
        let mut held = hold();
        let temporary = path.with_file_name(temporary_name(name, std::process::id(), held.number(), writer));
        let file = match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            // Another process of the same number, in a container of its own.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            created => created?,
        };
        held.add(&temporary);
        drop(held);
        if writer == Writer::Here {
            // On a file system without locks the temporary files stay.
            let _ = file.lock();
        }
        // A run that clears may have taken it for a temporary file of an ended run before it was locked.
        if fs::symlink_metadata(&temporary).is_ok() {
            return Ok((temporary, file));
        }
        hold().forget(&temporary);
    }
}

/// The folder in which a file lies.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Clears a folder the first time that this process writes into it.
fn clear_once(folder: &Path) {
    let mut held = hold();
    let cleared = &mut held.list().cleared;
    if cleared.len() >= FOLDERS {
        cleared.clear();
    }
    if cleared.insert(folder.to_owned()) {
        drop(held);
        clear(folder, Writer::Here);
    }
}

/// Removes the temporary files that ended runs left in a folder. While its writer lives a temporary file is locked; the
/// system frees the lock of an ended process. Temporary files that another program writes have no lock:
/// `Writer::Foreign` needs the lock of the folder.
pub(crate) fn clear(folder: &Path, writer: Writer) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if !is_temporary(&entry.file_name(), writer) || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let temporary = entry.path();
        // A temporary file that cannot be opened or locked may be in use.
        let Ok(file) = OpenOptions::new().write(true).open(&temporary) else { continue };
        if file.try_lock().is_ok() {
            // Removed before the lock is given back.
            let _ = fs::remove_file(&temporary);
        }
    }
}

fn suffix(writer: Writer) -> &'static str {
    match writer {
        Writer::Here => SUFFIX,
        Writer::Foreign => FOREIGN_SUFFIX,
    }
}

/// `wavy.hair` becomes `wavy.hair.1234-1.strandline-part`; a long name is cut.
fn temporary_name(name: &OsStr, process: u32, number: u64, writer: Writer) -> OsString {
    let name = name.to_string_lossy();
    let stem = &name[..name.floor_char_boundary(NAME_BYTES)];
    format!("{stem}.{process}-{number}{}", suffix(writer)).into()
}

fn is_temporary(name: &OsStr, writer: Writer) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    name.to_str()
        .and_then(|name| name.strip_suffix(suffix(writer))?.rsplit_once('.')?.1.split_once('-'))
        .is_some_and(|(process, number)| is_number(process) && is_number(number))
}

/// The names in a folder, in order.
#[cfg(test)]
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_the_pattern_are_parts() {
        for name in ["a", "wavy.hair", &"ä".repeat(200)] {
            for writer in [Writer::Here, Writer::Foreign] {
                let temporary = temporary_name(OsStr::new(name), 12, 3, writer);
                assert!(is_temporary(&temporary, writer) && temporary.len() < 255, "{temporary:?}");
            }
            assert!(!is_temporary(&temporary_name(OsStr::new(name), 12, 3, Writer::Foreign), Writer::Here));
        }
        for name in
            ["z.part", "a.1-2.part", ".strandline-part", "a.1.strandline-part", "a.x-1.strandline-part"]
        {
            assert!(!is_temporary(OsStr::new(name), Writer::Here), "{name}");
        }
    }

    #[test]
    fn a_part_is_cleared_when_its_writer_is_gone_and_not_before() {
        let folder = tempfile::tempdir().unwrap();
        let (alive, lock) = create(&folder.path().join("a"), Writer::Here).unwrap();
        let (gone, ended) = create(&folder.path().join("a"), Writer::Here).unwrap();
        let foreign = folder.path().join("a.1-1.strandline-foreign-part");
        let own = folder.path().join("a.part");
        fs::write(&foreign, b"").unwrap();
        fs::write(&own, b"notes").unwrap();
        drop(ended);
        clear(folder.path(), Writer::Here);
        assert!(alive.exists() && !gone.exists() && own.exists() && foreign.exists());
        clear(folder.path(), Writer::Foreign);
        assert!(alive.exists() && own.exists() && !foreign.exists());
        drop(lock);
        clear(folder.path(), Writer::Here);
        assert!(!alive.exists() && own.exists());
    }

    #[test]
    fn a_folder_is_cleared_by_the_first_file_that_is_written_there() {
        let folder = tempfile::tempdir().unwrap();
        let left = folder.path().join("other.1-1.strandline-part");
        fs::write(&left, b"half").unwrap();
        create(&folder.path().join("a"), Writer::Here).unwrap();
        assert!(!left.exists());
    }
}
