//! A film that is written while it is drawn: frames, a contact sheet, and a video or an animated image.

mod animation;
mod picture_files;
mod sheet;
mod video;

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use image::RgbImage;
use strandline_base::{FolderLock, WholeFile};

use crate::{Error, render::Picture};
use animation::Animation;
pub use picture_files::PictureFiles;
use video::Video;

/// Names of the files beside the frames.
const SHEET: &str = "sheet.png";
const VIDEO: &str = "video.mp4";
const ANIMATION: &str = "animation.gif";

/// Receives the pictures of a film in order.
///
/// Every file is whole once it has its name, and replaces one of an earlier film only then; one that could not
/// be finished is removed. One film at a time is written into a folder. Frames of an earlier, longer film stay
/// there, and a note says so: a run removes only its own files.
pub struct Film {
    folder: PathBuf,
    /// Number of frames; `None` while it is not known.
    frames: Option<u32>,
    frames_per_second: f32,
    files: Vec<PathBuf>,
    thumbnails: Vec<RgbImage>,
    moving: Moving,
    notes: Vec<String>,
    /// The last to go: the folder is free when everything is closed.
    _lock: FolderLock,
}

/// The moving picture under way.
enum Moving {
    NotBegun,
    Video(Video),
    Animation(Animation),
}

/// Files and notes of a finished film.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilmFiles {
    /// Every file, in the order of writing.
    pub files: Vec<PathBuf>,
    /// Failures with their reasons, and other files in the folder; human-readable.
    pub notes: Vec<String>,
    /// True where ffmpeg began a video and made none.
    pub video_failed: bool,
}

impl Film {
    /// A film of `frames` pictures in a folder, which is made when it is not there.
    ///
    /// # Errors
    /// The folder cannot be made or written, or another film is being written there.
    pub fn new(folder: &Path, frames: u32, frames_per_second: f32) -> Result<Self, Error> {
        Self::open(folder, Some(frames), frames_per_second)
    }

    /// A film of any length, which `finish` ends; without a contact sheet.
    ///
    /// # Errors
    /// As [`Film::new`].
    pub fn endless(folder: &Path, frames_per_second: f32) -> Result<Self, Error> {
        Self::open(folder, None, frames_per_second)
    }

    fn open(folder: &Path, frames: Option<u32>, frames_per_second: f32) -> Result<Self, Error> {
        let lock = claim(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
            frames,
            frames_per_second,
            files: Vec::new(),
            thumbnails: Vec::new(),
            moving: Moving::NotBegun,
            notes: unlocked(&lock).into_iter().collect(),
            _lock: lock,
        })
    }

    /// Number of pictures so far.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// True before the first picture.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// The file cannot be written, for example on a full disk; earlier pictures stay.
    pub fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let index = self.files.len() as u32;
        let path = self.folder.join(format!("frame_{index:04}.png"));
        picture.save(&path)?;
        self.files.push(path);
        if self.frames.is_some_and(|frames| sheet::is_shown(index, frames)) {
            self.thumbnails.push(sheet::thumbnail(picture, sheet::WIDTH));
        }
        if self.frames != Some(1) {
            self.add_to_moving(picture)?;
        }
        Ok(())
    }

    /// Writes the contact sheet and closes the moving picture.
    ///
    /// # Errors
    /// A file cannot be written; the frames stay.
    pub fn finish(mut self) -> Result<FilmFiles, Error> {
        let mut video_failed = false;
        let frames = self.files.len();
        if self.thumbnails.len() > 1 {
            let path = self.folder.join(SHEET);
            sheet::save(&self.thumbnails, &path)?;
            self.files.push(path);
        }
        match self.close() {
            None => {}
            Some(Ok(file)) => self.keep(file)?,
            Some(Err(Unmade::Failed(reason))) => {
                self.notes.push(format!("no video: {reason}"));
                video_failed = true;
            }
            Some(Err(Unmade::Unwritten(error))) => return Err(error),
        }
        Ok(self.into_files(frames, video_failed))
    }

    /// Closes a film that was stopped early. It has no contact sheet. Its moving picture shows the frames so far, and is
    /// left out if it would replace that of an earlier film.
    ///
    /// # Errors
    /// As [`Film::finish`].
    pub fn stop_early(mut self) -> Result<FilmFiles, Error> {
        let frames = self.files.len();
        if let Some(Ok(file)) = self.close().filter(|_| frames > 1)
            && !file.path().exists()
        {
            self.keep(file)?;
        }
        Ok(self.into_files(frames, false))
    }

    /// Gives up a film that failed. Returns a note on files of an earlier film beside its frames.
    pub fn give_up(self) -> Vec<String> {
        leftovers(&self.folder, self.files.len(), &self.files).into_iter().collect()
    }

    fn keep(&mut self, file: WholeFile) -> Result<(), Error> {
        let path = file.path().to_owned();
        file.keep().map_err(Error::write("the moving picture", &path))?;
        self.files.push(path);
        Ok(())
    }

    /// Ends the moving picture, if it was begun.
    fn close(&mut self) -> Option<Result<WholeFile, Unmade>> {
        match std::mem::replace(&mut self.moving, Moving::NotBegun) {
            Moving::NotBegun => None,
            Moving::Video(video) => Some(video.finish().map_err(Unmade::Failed)),
            Moving::Animation(animation) => {
                let unwritten = Error::write("the animated image", &self.folder.join(ANIMATION));
                Some(animation.finish().map_err(|error| Unmade::Unwritten(unwritten(error))))
            }
        }
    }

    fn into_files(mut self, frames: usize, video_failed: bool) -> FilmFiles {
        self.notes.extend(leftovers(&self.folder, frames, &self.files));
        FilmFiles { files: self.files, notes: self.notes, video_failed }
    }

    fn add_to_moving(&mut self, picture: &Picture) -> Result<(), Error> {
        if matches!(self.moving, Moving::NotBegun) {
            self.moving = self.begin_moving(picture)?;
        }
        match &mut self.moving {
            Moving::NotBegun => Ok(()),
            Moving::Video(video) => {
                video.add(picture);
                Ok(())
            }
            Moving::Animation(animation) => animation
                .add(picture)
                .map_err(Error::write("the animated image", &self.folder.join(ANIMATION))),
        }
    }

    fn begin_moving(&mut self, picture: &Picture) -> Result<Moving, Error> {
        let (path, program) = (self.folder.join(VIDEO), Path::new("ffmpeg"));
        let begun = Video::begin(program, picture, self.frames_per_second, &path, video::PATIENCE);
        let error = match begun.map_err(Error::write("the video", &path))? {
            Ok(video) => return Ok(Moving::Video(video)),
            Err(error) => error,
        };
        let reason = match error.kind() {
            ErrorKind::NotFound => "no ffmpeg found".to_owned(),
            _ => format!("ffmpeg cannot be started ({error})"),
        };
        self.notes.push(format!("{reason}: wrote an animated image in place of a video"));
        let path = self.folder.join(ANIMATION);
        let animation = Animation::begin(&path, self.frames_per_second);
        animation.map(Moving::Animation).map_err(Error::write("the animated image", &path))
    }
}

/// Creates a folder unless it exists, and keeps other runs out of it.
pub(crate) fn claim(folder: &Path) -> Result<FolderLock, Error> {
    fs::create_dir_all(folder).map_err(Error::write("the output folder", folder))?;
    FolderLock::take(folder).map_err(|error| match error.kind() {
        ErrorKind::ResourceBusy => Error::Busy { path: folder.to_owned() },
        _ => Error::write("into the output folder", folder)(error),
    })
}

/// Makes the folder of a file where it is not there, and keeps other runs off its name.
pub(crate) fn claim_name(path: &Path) -> Result<FolderLock, Error> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(Error::write("the output folder", folder))?;
    FolderLock::take_name(path).map_err(|error| match error.kind() {
        ErrorKind::ResourceBusy => Error::BusyFile { path: path.to_owned() },
        _ => Error::write("into the output folder", folder)(error),
    })
}

/// A note where nothing keeps others out.
fn unlocked(lock: &FolderLock) -> Option<String> {
    let note = "the file system has no locks: nothing keeps a second run out of the folder";
    (!lock.is_held()).then(|| note.to_owned())
}

/// Why there is no moving picture.
enum Unmade {
    /// ffmpeg could not.
    Failed(String),
    /// Its file could not be written.
    Unwritten(Error),
}

/// A note on files of an earlier film in the folder.
fn leftovers(folder: &Path, frames: usize, files: &[PathBuf]) -> Option<String> {
    let number = |name: &str| name.strip_prefix("frame_")?.strip_suffix(".png")?.parse::<usize>().ok();
    let is_old = |name: &String| {
        let of_film = [SHEET, VIDEO, ANIMATION].contains(&name.as_str());
        let beyond = number(name).is_some_and(|number| number >= frames);
        beyond || of_film && !files.contains(&folder.join(name))
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut old: Vec<String> =
        entries.filter_map(|entry| entry.file_name().into_string().ok()).filter(is_old).collect();
    old.sort_by_key(|name| (number(name), name.clone()));
    still_there(&old)
}

/// A note on files of an earlier film, in order.
fn still_there(old: &[String]) -> Option<String> {
    let named = match old {
        [] => return None,
        [one] => one.clone(),
        [first, second] => format!("{first} and {second}"),
        [first, .., last] => format!("{} files, {first} to {last}", old.len()),
    };
    Some(format!("of an earlier film there are still {named} in the folder"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(width: u32, height: u32) -> Picture {
        Picture { width, height, pixels: vec![128; (width * height * 3) as usize], ..Picture::default() }
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn film(folder: &Path, frames: u32) -> FilmFiles {
        let mut film = Film::new(folder, frames, 30.0).unwrap();
        (0..frames).for_each(|_| film.add(&filled(16, 8)).unwrap());
        film.finish().unwrap()
    }

    #[test]
    fn a_film_that_is_dropped_leaves_only_whole_frames() {
        let folder = tempfile::tempdir().unwrap();
        let mut film = Film::new(folder.path(), 3, 30.0).unwrap();
        film.add(&filled(16, 8)).unwrap();
        drop(film);
        assert_eq!(names(folder.path()), ["frame_0000.png"]);
        assert!(image::open(folder.path().join("frame_0000.png")).is_ok());
    }

    #[test]
    fn a_film_that_fails_or_is_stopped_early_leaves_the_former_moving_picture() {
        let folder = tempfile::tempdir().unwrap();
        let moving = film(folder.path(), 4).files.pop().unwrap();
        let former = fs::read(&moving).unwrap();
        let mut dropped = Film::new(folder.path(), 4, 30.0).unwrap();
        (0..2).for_each(|_| dropped.add(&filled(32, 8)).unwrap());
        drop(dropped);
        assert_eq!(fs::read(&moving).unwrap(), former);
        let mut broken = Film::new(folder.path(), 4, 30.0).unwrap();
        (0..2).for_each(|_| broken.add(&filled(32, 8)).unwrap());
        let left = broken.stop_early().unwrap();
        assert_eq!((fs::read(&moving).unwrap(), left.files.len()), (former, 2));
        assert!(left.notes.iter().any(|note| note.contains("of an earlier film there are still 4 files")));
        // Without one the frames so far make one.
        fs::remove_file(&moving).unwrap();
        let mut broken = Film::new(folder.path(), 4, 30.0).unwrap();
        (0..2).for_each(|_| broken.add(&filled(32, 8)).unwrap());
        assert_eq!(broken.stop_early().unwrap().files.last(), Some(&moving));
        assert!(moving.is_file());
    }

    #[test]
    fn a_film_that_failed_tells_what_lies_beside_its_frames() {
        let folder = tempfile::tempdir().unwrap();
        film(folder.path(), 5);
        let mut failed = Film::new(folder.path(), 5, 30.0).unwrap();
        (0..3).for_each(|_| failed.add(&filled(16, 8)).unwrap());
        let notes = failed.give_up();
        assert!(notes.len() == 1 && notes[0].contains("earlier film there are still 4 files"), "{notes:?}");
        assert!(notes[0].contains("frame_0004.png"), "{notes:?}");
    }

    #[test]
    fn frames_of_an_earlier_longer_film_stay_and_are_noted() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(film(folder.path(), 5).notes.iter().filter(|note| note.contains("earlier")).count(), 0);
        let notes = film(folder.path(), 3).notes;
        assert!(notes.iter().any(|note| note.contains("frame_0003.png and frame_0004.png")), "{notes:?}");
        assert!(names(folder.path()).contains(&"frame_0004.png".to_owned()));
    }

    #[test]
    fn two_films_at_once_in_one_folder_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let first = Film::new(folder.path(), 3, 30.0).unwrap();
        let error = Film::new(folder.path(), 3, 30.0).err().unwrap().to_string();
        assert!(error.contains("another run is writing a film there"), "{error}");
        drop(first);
        assert!(Film::new(folder.path(), 3, 30.0).is_ok());
        assert_eq!(names(folder.path()).len(), 0);
    }

    #[test]
    fn a_folder_under_a_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"x").unwrap();
        let error = Film::new(&file.join("out"), 3, 30.0).err().unwrap().to_string();
        assert!(error.contains("cannot write the output folder"), "{error}");
    }
}
