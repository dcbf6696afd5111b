//! Videos, kept frames and projects that are written while hair plays.

use std::path::Path;

use super::drawing_thread::{DrawingThread, Message};
use super::messages::LiveEvent;
use super::playing::Playing;
use super::project;
use super::recorder::Recorder;
use crate::{Error, OutSettings, Scene, film::FilmFiles};

impl DrawingThread {
    pub(super) fn record(&self, playing: &mut Playing, folder: &Path) {
        if playing.recorder.is_some() {
            return;
        }
        let own = self.own.clone();
        playing.film += 1;
        let film = playing.film;
        let done = move |files| {
            let _ = own.send(Message::Recorded(film, files));
        };
        let rate = playing.scene.as_ref().map_or(30.0, |loaded| loaded.rate());
        match Recorder::new(folder, rate as f32, done) {
            Ok(recorder) => playing.recorder = Some(recorder),
            Err(error) => {
                self.emit(error.into());
                self.emit(LiveEvent::Recorded);
            }
        }
    }

    pub(super) fn tell_film(&self, playing: &mut Playing, number: u64, film: Result<FilmFiles, Error>) {
        playing.finishing.retain(|thread| !thread.is_finished());
        match film {
            Ok(film) => {
                let files = film.files.last().map(|path| format!("wrote {}", path.display()));
                film.notes.into_iter().chain(files).for_each(|note| self.emit(LiveEvent::Note(note)));
            }
            Err(error) => {
                if number == playing.film {
                    // It may have ended by itself.
                    playing.finishing.extend(playing.recorder.take().map(Recorder::finish));
                }
                self.emit(error.into());
            }
        }
        self.emit(LiveEvent::Recorded);
    }

    /// Writes kept frames on a thread of its own.
    pub(super) fn export(
        &self,
        playing: &mut Playing,
        scene: Scene,
        settings: &OutSettings,
        frames: [u32; 2],
    ) {
        let Some(loaded) = &playing.scene else { return };
        let own = self.own.clone();
        // Nobody waits for it any more when the window is closed.
        let done = move |written| drop(own.send(Message::Exported(written)));
        match loaded.export(scene, settings, frames, done) {
            Ok(thread) => playing.finishing.push(thread),
            Err(error) => self.emit(error.into()),
        }
    }

    /// Saves a project on a thread of its own, after all that the simulation has begun.
    pub(super) fn save_project(&self, playing: &mut Playing, scene: Scene, load: u64, folder: &Path) {
        if let Err(error) = self.catch_up(playing).and_then(|()| self.make_steps(playing)) {
            // The last good state is still there.
            self.emit(error.into());
        }
        let Some(loaded) = self.loaded_of(playing, load) else { return };
        let (own, telling) = (self.own.clone(), self.own.clone());
        // Nobody waits for them any more when the window is closed.
        let done = move |saved| drop(own.send(Message::SavedProject(saved)));
        let tell = move |share| drop(telling.send(Message::Saving(share)));
        let saved = project::save((&mut loaded.session, &loaded.timeline), scene, folder, tell, done);
        match saved {
            Ok(thread) => playing.finishing.push(thread),
            Err(error) => self.emit(error.into()),
        }
    }
}
