//! Pictures, scenes and videos as files, written by threads of their own so that the window stays responsive.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use strandline::live::{Command, LiveEvent};

use crate::App;

/// Time for which a closing window waits for a picture in full.
const PATIENCE: Duration = Duration::from_secs(10);

impl Drop for App {
    /// Finishes the user's saves although the window is closed; after ten seconds, as shown.
    fn drop(&mut self) {
        let begin = Instant::now();
        while !self.saves.waiting.is_empty() && begin.elapsed() < PATIENCE {
            if let Some(shown) = self.live.take_shown() {
                self.shown = Some(shown);
                self.save_if_full();
            }
            let fails = |news: &LiveEvent| matches!(news, LiveEvent::Paused | LiveEvent::NotLoaded(..));
            if self.live.take_events().iter().any(fails) {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        self.write_pictures();
        self.saves.join();
    }
}

impl App {
    /// Saves the next picture that is drawn in full, or the shown one if it is; into a free file of
    /// the folder when no path is given.
    pub fn save_picture(&mut self, path: Option<PathBuf>) {
        if self.shown.is_none() && !self.is_loading() {
            self.error = Some("there is no picture yet".to_owned());
            return;
        }
        self.saves.waiting.push(path);
        self.send_adapt();
        self.save_if_full();
    }

    /// Tells that pictures are not saved, after the error that is the reason.
    pub(crate) fn give_up_pictures(&mut self) {
        if !self.saves.waiting.is_empty() {
            self.saves.waiting.clear();
            let reason = self.error.take().unwrap_or_default();
            self.error = Some(format!("no picture was saved: {reason}"));
            self.send_adapt();
        }
    }

    /// Allows simpler pictures, unless a picture is to be saved.
    pub(crate) fn send_adapt(&self) {
        self.live.send(Command::Adapt(self.adapts && self.saves.waiting.is_empty()));
    }

    /// Saves the pictures that are wanted, if they are there.
    pub(crate) fn save_if_full(&mut self) {
        if self.saves.waiting.is_empty() || self.shown.as_ref().is_none_or(|shown| shown.draft) {
            return;
        }
        self.write_pictures();
        self.send_adapt();
    }

    /// Writes the shown picture to all files that wait for it.
    fn write_pictures(&mut self) {
        for path in std::mem::take(&mut self.saves.waiting) {
            self.write_picture(path.as_deref());
        }
    }

    fn write_picture(&mut self, path: Option<&Path>) {
        let Some(path) = self.path_or_free(path, "view", "png") else { return };
        let Some(picture) = self.shown.as_ref().map(|shown| shown.picture.clone()) else { return };
        let context = self.context.clone();
        let wake = move || context.get().into_iter().for_each(eframe::egui::Context::request_repaint);
        if let Err(error) = self.saves.write(picture, path, wake) {
            self.error = Some(format!("cannot save the picture: {error}"));
        }
    }

    /// Saves the shown scene, or reports the error.
    pub fn save_scene(&mut self, path: Option<&Path>) {
        if let Some(path) = self.path_or_free(path, "view", "toml") {
            self.live.send(Command::Save(Box::new(self.seen()), self.loaded, path));
        }
    }

    /// Saves the scene and its kept frames as a folder: a free one of the folder when no path is given.
    pub fn save_project(&mut self, path: Option<&Path>) {
        let free = || self.saves.free_path(&self.folder, "project", "");
        match path.map_or_else(free, |path| Ok(path.to_owned())) {
            Ok(path) => {
                self.saves.project = Some(0.0);
                self.live.send(Command::SaveProject(Box::new(self.seen()), self.loaded, path));
            }
            Err(error) => self.error = Some(error),
        }
    }

    /// Tells of a scene or a project that is written.
    pub(crate) fn tell_saved(&mut self, path: &Path) {
        if path.is_dir() {
            self.saves.project = None;
            self.recent.add(path);
        }
        self.note(format!("wrote {}", path.display()));
    }

    /// Tells of the pictures that are written.
    pub(crate) fn take_saved(&mut self) {
        for saved in self.saves.written() {
            match saved {
                Ok(path) => self.note(format!("wrote {}", path.display())),
                Err(error) => self.error = Some(error),
            }
        }
    }

    /// Begins a video, or ends the recording.
    pub fn record(&mut self) {
        if self.recording {
            self.finishing += 1;
            self.recording = false;
            self.live.send(Command::StopRecording);
            return;
        }
        let folder = self.saves.free_path(&self.folder, "video", "").and_then(|folder| {
            // It is taken from now on.
            std::fs::create_dir(&folder).map_err(|error| format!("cannot make the folder: {error}"))?;
            Ok(folder)
        });
        match folder {
            Ok(folder) => {
                self.recording = true;
                self.live.send(Command::Record(folder));
                self.play(true);
            }
            Err(error) => self.error = Some(error),
        }
    }

    /// True while a video is recorded.
    pub fn is_recording(&self) -> bool {
        self.recording
    }

    /// The path with its ending, or a free one; `None` after an error that was shown.
    pub(crate) fn path_or_free(&mut self, path: Option<&Path>, stem: &str, ending: &str) -> Option<PathBuf> {
        let has_ending =
            |path: &Path| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
        let path = match path {
            Some(path) if has_ending(path) => Ok(path.to_owned()),
            Some(path) => Ok(path.with_added_extension(ending)),
            None => self.saves.free_path(&self.folder, stem, ending),
        };
        path.map_err(|error| self.error = Some(error)).ok()
    }
}
