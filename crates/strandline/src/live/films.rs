//! Videos and kept frames that are written while hair plays.

use std::path::Path;

use super::drawing_thread::{DrawingThread, Message};
use super::messages::LiveEvent;
use super::playing::Playing;
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
}
