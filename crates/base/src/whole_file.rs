use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};

use crate::plain_file::HAS_FILES;
use crate::temporary::{self, Writer};

/// A file that is whole or not there: it is written under a temporary name in the same folder and gets its own
/// when it is kept. Otherwise it is removed.
///
/// * A file of that name is replaced in one move and lends its mode bits; a read-only file is refused.
/// * A symbolic link is replaced itself; its target stays as it is.
/// * A folder, a device, a pipe, or a link to one, is refused.
/// * The content is on the disk before the file gets its name. The name itself may be lost with the power;
///   then the former file is there, whole.
/// * The temporary name, `NAME.PROCESS-NUMBER.strandline-part`, is new and locked. Temporary files of killed runs have
///   no lock any more; the next run that writes into the folder removes them.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    temporary: PathBuf,
    /// `None` while another program writes it.
    file: Option<BufWriter<File>>,
}

impl WholeFile {
    /// Begins a file; an existing file of its name stays until this one is kept.
    ///
    /// # Errors
    /// Errors of the system; a name under which no file may be put.
    pub fn create(path: &Path) -> Result<Self> {
        let mut file = Self::begin(path, Writer::Here)?;
        // Before it has content: a private file is never readable by others.
        if let (Some(permissions), Some(temporary)) = (permissions(path)?, &mut file.file) {
            temporary.get_ref().set_permissions(permissions)?;
        }
        Ok(file)
    }

    /// Begins a file that another program writes under [`WholeFile::temporary`].
    ///
    /// # Errors
    /// As [`WholeFile::create`].
    pub fn for_program(path: &Path) -> Result<Self> {
        let mut file = Self::begin(path, Writer::Foreign)?;
        if let Some(permissions) = permissions(path)? {
            fs::set_permissions(&file.temporary, permissions)?;
        }
        file.file = None;
        Ok(file)
    }

    fn begin(path: &Path, writer: Writer) -> Result<Self> {
        if !HAS_FILES {
            return Err(ErrorKind::Unsupported.into());
        }
        permissions(path)?;
        let (temporary, file) = temporary::create(path, writer)?;
        Ok(Self { path: path.to_owned(), temporary, file: Some(BufWriter::new(file)) })
    }

    /// Writes all of it, to be kept.
    ///
    /// # Errors
    /// Errors of the system or of `write`.
    pub fn write(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> Result<()>) -> Result<Self> {
        let mut file = Self::create(path)?;
        if let Some(temporary) = &mut file.file {
            write(temporary)?;
        }
        file.store()?;
        Ok(file)
    }

    /// Writes these bytes and gives the file its name.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn save(path: &Path, bytes: &[u8]) -> Result<()> {
        Self::write(path, |file| file.write_all(bytes))?.keep()
    }

    /// The temporary name.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// The name that it will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives it its name.
    ///
    /// # Errors
    /// Errors of the system; the file is then removed.
    pub fn keep(mut self) -> Result<()> {
        self.store()?;
        permissions(&self.path)?;
        // With the list of temporary files in hand: a process that ends at once removes it before or not at all.
        let mut list = temporary::hold();
        fs::rename(&self.temporary, &self.path)?;
        list.forget(&self.temporary);
        Ok(())
    }

    /// Waits until the content is on the disk.
    fn store(&mut self) -> Result<()> {
        match &mut self.file {
            Some(file) => {
                file.flush()?;
                file.get_ref().sync_all()
            }
            None => OpenOptions::new().write(true).open(&self.temporary)?.sync_all(),
        }
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.file.as_mut().ok_or(ErrorKind::Unsupported)?.write(bytes)
    }

    fn flush(&mut self) -> Result<()> {
        self.file.as_mut().map_or(Ok(()), io::Write::flush)
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        let mut list = temporary::hold();
        // A kept file is gone from its temporary name, and the first error is reported.
        let _ = fs::remove_file(&self.temporary);
        list.forget(&self.temporary);
    }
}

/// The permissions of the file that would be replaced; `None` without one.
pub(crate) fn permissions(path: &Path) -> Result<Option<fs::Permissions>> {
    let found = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        found => found?,
    };
    if found.is_symlink() {
        // A dangling link may be replaced too.
        return match fs::metadata(path) {
            Ok(target) if !target.is_file() => Err(no_file("a link to a folder or device")),
            _ => Ok(None),
        };
    }
    if !found.is_file() {
        return Err(no_file(if found.is_dir() { "a folder" } else { "a device or a pipe" }));
    }
    if found.permissions().readonly() {
        return Err(Error::new(ErrorKind::PermissionDenied, "the file there is read-only"));
    }
    Ok(Some(found.permissions()))
}

fn no_file(found: &str) -> Error {
    Error::new(ErrorKind::InvalidInput, format!("{found} has that name: choose another"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::temporary::names;

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
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn files_beside_the_target_stay_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["z.part", "z.hair.part", "z"] {
            fs::write(folder.path().join(name), b"notes").unwrap();
        }
        WholeFile::save(&folder.path().join("z.hair"), b"HAIR").unwrap();
        WholeFile::save(&folder.path().join("z.tfx"), b"TFX").unwrap();
        for name in ["z.part", "z.hair.part", "z"] {
            assert_eq!(fs::read(folder.path().join(name)).unwrap(), b"notes");
        }
        assert_eq!(names(folder.path()), ["z", "z.hair", "z.hair.part", "z.part", "z.tfx"]);
    }

    #[test]
    fn another_program_writes_a_part_that_gets_its_name_when_it_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("video");
        let file = WholeFile::for_program(&path).unwrap();
        fs::write(file.temporary(), b"whole").unwrap();
        assert!(!path.exists() && file.temporary().exists());
        file.keep().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        drop(WholeFile::for_program(&path).unwrap());
        assert_eq!(names(folder.path()), ["video"]);
    }

    #[test]
    fn what_is_no_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("folder")).unwrap();
        fs::write(at("fixed"), b"old").unwrap();
        let mut fixed = fs::metadata(at("fixed")).unwrap().permissions();
        fixed.set_readonly(true);
        fs::set_permissions(at("fixed"), fixed).unwrap();
        for (name, words) in [("folder", "a folder has that name"), ("fixed", "read-only")] {
            let error = WholeFile::save(&at(name), b"new").unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        assert!(
            WholeFile::save(Path::new(""), b"new").is_err() && WholeFile::save(&at(".."), b"new").is_err()
        );
        assert_eq!(fs::read(at("fixed")).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["fixed", "folder"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_replaced_and_modes_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("target"), b"old").unwrap();
        symlink("target", at("link")).unwrap();
        symlink("nowhere", at("dangling")).unwrap();
        // A pipe, not a device of the machine: a fault here would put a file in its place.
        assert!(std::process::Command::new("mkfifo").arg(at("pipe")).status().unwrap().success());
        symlink("pipe", at("to a pipe")).unwrap();
        WholeFile::save(&at("link"), b"new").unwrap();
        WholeFile::save(&at("dangling"), b"new").unwrap();
        assert!(fs::symlink_metadata(at("link")).unwrap().is_file());
        assert_eq!(
            (fs::read(at("target")).unwrap(), fs::read(at("link")).unwrap()),
            (b"old".into(), b"new".into())
        );
        assert!(!at("nowhere").exists());
        for refused in [at("pipe"), at("to a pipe")] {
            assert!(WholeFile::save(&refused, b"new").unwrap_err().to_string().contains("has that name"));
        }
        for mode in [0o600, 0o640, 0o755] {
            fs::set_permissions(at("target"), fs::Permissions::from_mode(mode)).unwrap();
            let file = WholeFile::create(&at("target")).unwrap();
            let temporary = fs::metadata(file.temporary()).unwrap().permissions().mode();
            assert_eq!(temporary & 0o777, mode, "before anything is written");
            file.keep().unwrap();
            assert_eq!(fs::metadata(at("target")).unwrap().permissions().mode() & 0o777, mode);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_an_error() {
        let file = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut full = WholeFile {
            path: "/nowhere/a".into(),
            temporary: "/nowhere/a.part".into(),
            file: Some(BufWriter::new(file)),
        };
        full.write_all(b"x").unwrap();
        assert_eq!(full.keep().unwrap_err().kind(), ErrorKind::StorageFull);
    }
}
