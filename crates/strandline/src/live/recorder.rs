//! A video of the playing hair, written on a thread of its own.

use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use crate::{
    Error,
    film::{Film, FilmFiles},
    render::Picture,
};

/// Most pictures that wait to be written; the drawing thread then waits for the disk.
const WAITING: usize = 4;

/// A film under way.
pub(super) struct Recorder {
    pictures: SyncSender<Picture>,
    thread: JoinHandle<()>,
    pub frames: u32,
}

impl Recorder {
    /// Begins a film. `done` is called on its thread when it is over.
    ///
    /// # Errors
    /// The folder cannot be made or written; the system gives no thread.
    pub fn new(
        folder: &Path,
        frames_per_second: f32,
        done: impl FnOnce(Result<FilmFiles, Error>) + Send + 'static,
    ) -> Result<Self, Error> {
        let film = Film::endless(folder, frames_per_second)?;
        let (pictures, waiting) = sync_channel(WAITING);
        let thread = std::thread::Builder::new()
            .name("recording".to_owned())
            .spawn(move || done(write(film, &waiting)))
            .map_err(Error::Thread)?;
        Ok(Self { pictures, thread, frames: 0 })
    }

    /// Adds a frame, unless the film has ended.
    pub fn add(&mut self, picture: &Picture) {
        self.frames += u32::from(self.pictures.send(picture.clone()).is_ok());
    }

    /// Lets the film end; its thread may still write.
    pub fn finish(self) -> JoinHandle<()> {
        self.thread
    }
}

fn write(mut film: Film, pictures: &Receiver<Picture>) -> Result<FilmFiles, Error> {
    for picture in pictures {
        if let Err(error) = film.add(&picture) {
            // The frames so far become a film all the same; the error is reported.
            let _ = film.finish();
            return Err(error);
        }
    }
    film.finish()
}
