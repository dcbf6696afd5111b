//! What is seen, as files: written by threads of their own, so that the window goes on.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;

use strandline::Command;

use crate::{App, stage};

/// Pictures that are being written, and names that are given away.
#[derive(Default)]
pub struct Saves {
    threads: Vec<JoinHandle<Result<PathBuf, String>>>,
    taken: HashSet<PathBuf>,
}

impl Drop for Saves {
    /// What a person saved is written, though the window is closed.
    fn drop(&mut self) {
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

impl App {
    /// Saves the next picture that is drawn in full, which may need the hair to stand still; into a free
    /// file of the folder when no path is given.
    pub(crate) fn ask_for_picture(&mut self, path: Option<PathBuf>) {
        self.saving = Some(path);
        if self.shown.as_ref().is_some_and(|shown| shown.draft) {
            stage::play(self, false);
        }
        self.save_if_full();
    }

    /// Saves the picture that is wanted, if it is there.
    pub(crate) fn save_if_full(&mut self) {
        if self.shown.as_ref().is_none_or(|shown| !shown.draft)
            && let Some(path) = self.saving.take()
        {
            self.save_picture(path.as_deref());
        }
    }

    /// Saves the picture that is seen, or tells why not.
    pub fn save_picture(&mut self, path: Option<&Path>) {
        let Some(picture) = self.shown.as_ref().map(|shown| shown.picture.clone()) else {
            self.error = Some("there is no picture yet".to_owned());
            return;
        };
        let Some(path) = self.path_or_free(path, "view", "png") else { return };
        let context = self.context.clone();
        let write = move || {
            let saved = picture.save(&path).map(|()| path).map_err(|error| error.to_string());
            context.get().into_iter().for_each(eframe::egui::Context::request_repaint);
            saved
        };
        match std::thread::Builder::new().name("saving".to_owned()).spawn(write) {
            Ok(thread) => self.saves.threads.push(thread),
            Err(error) => self.error = Some(format!("cannot save the picture: {error}")),
        }
    }

    /// Saves what is seen as a scene, or tells why not.
    pub fn save_scene(&mut self, path: Option<&Path>) {
        if let Some(path) = self.path_or_free(path, "view", "toml") {
            self.live.tell(Command::Save(Box::new(self.seen()), path));
        }
    }

    /// Tells of the pictures that are written.
    pub(crate) fn take_saved(&mut self) {
        while let Some(index) = self.saves.threads.iter().position(JoinHandle::is_finished) {
            match self.saves.threads.swap_remove(index).join() {
                Ok(Ok(path)) => self.note(format!("wrote {}", path.display())),
                Ok(Err(error)) => self.error = Some(error),
                Err(_) => self.error = Some("cannot save the picture: a fault of the program".to_owned()),
            }
        }
    }

    /// Begins a video, or ends the one that is recorded.
    pub fn record(&mut self) {
        if self.recording {
            self.finishing += 1;
            self.recording = false;
            self.live.tell(Command::StopRecording);
            return;
        }
        let folder = self.free_path("video", "").and_then(|folder| {
            // It is taken from now on.
            std::fs::create_dir(&folder).map_err(|error| format!("cannot make the folder: {error}"))?;
            Ok(folder)
        });
        match folder {
            Ok(folder) => {
                self.recording = true;
                self.live.tell(Command::Record(folder));
                stage::play(self, true);
            }
            Err(error) => self.error = Some(error),
        }
    }

    /// Whether a video is recorded.
    pub fn is_recording(&self) -> bool {
        self.recording
    }

    /// The path with its ending, or a free one; none after an error that was told.
    fn path_or_free(&mut self, path: Option<&Path>, stem: &str, ending: &str) -> Option<PathBuf> {
        let has_ending =
            |path: &Path| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
        let path = match path {
            Some(path) if has_ending(path) => Ok(path.to_owned()),
            Some(path) => Ok(path.with_added_extension(ending)),
            None => self.free_path(stem, ending),
        };
        path.map_err(|error| self.error = Some(error)).ok()
    }

    /// A name that is not taken, of a file or, without an ending, of a folder.
    fn free_path(&mut self, stem: &str, ending: &str) -> Result<PathBuf, String> {
        std::fs::create_dir_all(&self.folder)
            .map_err(|error| format!("cannot make the folder: {error}: {}", self.folder.display()))?;
        let path = |number: usize| self.folder.join(format!("{stem}_{number:03}")).with_extension(ending);
        let free = (0..1000)
            .map(path)
            .find(|path| !path.exists() && !self.saves.taken.contains(path))
            .ok_or_else(|| format!("a thousand of them lie there already: {}", self.folder.display()))?;
        // It may be written only later.
        self.saves.taken.insert(free.clone());
        Ok(free)
    }
}
