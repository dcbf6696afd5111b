//! What is seen, as files.

use std::path::{Path, PathBuf};

use eframe::egui::Ui;
use strandline::Command;

use crate::{App, controls::button, files, stage};

pub fn show(app: &mut App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if button(ui, "Picture", "as PNG into out/, in full: ctrl P") {
            app.ask_for_picture(None);
        }
        if button(ui, "as...", "as PNG, to a place of your choice") {
            files::ask(app, files::Wanted::Picture, ui.ctx());
        }
    });
    ui.horizontal(|ui| {
        if button(ui, "Scene", "the TOML that makes what is seen after a reset, into out/: ctrl S") {
            let saved = app.save_scene(None);
            app.tell_saved(saved);
        }
        if button(ui, "as...", "the same, to a place of your choice") {
            files::ask(app, files::Wanted::Scene, ui.ctx());
        }
    });
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
            let saved = self.save_picture(path.as_deref());
            self.tell_saved(saved);
        }
    }

    /// Saves the picture that is seen; returns its path.
    ///
    /// # Errors
    /// There is none yet, or it cannot be written.
    pub fn save_picture(&self, path: Option<&Path>) -> Result<PathBuf, String> {
        let shown = self.shown.as_ref().ok_or("there is no picture yet")?;
        let path = self.path_or_free(path, "view", "png")?;
        shown.picture.save(&path).map_err(|error| error.to_string())?;
        Ok(path)
    }

    /// Saves what is seen as a scene; returns its path.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn save_scene(&self, path: Option<&Path>) -> Result<PathBuf, String> {
        let path = self.path_or_free(path, "view", "toml")?;
        std::fs::write(&path, self.seen().to_toml())
            .map_err(|error| format!("cannot write the scene: {error}: {}", path.display()))?;
        Ok(path)
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

    pub(crate) fn tell_saved(&mut self, saved: Result<PathBuf, String>) {
        match saved {
            Ok(path) => self.note(format!("wrote {}", path.display())),
            Err(error) => self.error = Some(error),
        }
    }

    fn path_or_free(&self, path: Option<&Path>, stem: &str, ending: &str) -> Result<PathBuf, String> {
        match path {
            Some(path) if path.extension().is_none() => Ok(path.with_extension(ending)),
            Some(path) => Ok(path.to_owned()),
            None => self.free_path(stem, ending),
        }
    }

    /// A name that is not taken, of a file or, without an ending, of a folder.
    fn free_path(&self, stem: &str, ending: &str) -> Result<PathBuf, String> {
        std::fs::create_dir_all(&self.folder)
            .map_err(|error| format!("cannot make the folder: {error}: {}", self.folder.display()))?;
        let path = |number: usize| self.folder.join(format!("{stem}_{number:03}")).with_extension(ending);
        (0..1000)
            .map(path)
            .find(|path| !path.exists())
            .ok_or_else(|| format!("a thousand of them lie there already: {}", self.folder.display()))
    }
}
