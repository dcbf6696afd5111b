//! Pictures that are to be saved, and names that are given away.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use strandline::Picture;

/// Result of writing a picture: its path, or the error.
pub type Saved = Result<PathBuf, String>;

/// Pictures that are to be saved, and names that are given away.
pub struct Saves {
    /// Saves that wait for a picture in full: paths, or `None` for a free name in the folder.
    pub waiting: Vec<Option<PathBuf>>,
    /// Share of a project that is written, while one is.
    pub project: Option<f32>,
    threads: Vec<JoinHandle<()>>,
    finished: (Sender<Saved>, Receiver<Saved>),
    taken: HashSet<PathBuf>,
}

impl Default for Saves {
    fn default() -> Self {
        let (waiting, threads, taken) = Default::default();
        Self { waiting, project: None, threads, finished: channel(), taken }
    }
}

impl Saves {
    /// Writes a picture on a thread of its own.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn write(
        &mut self,
        picture: Picture,
        path: PathBuf,
        done: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<()> {
        self.run(move || picture.save(&path).map(|()| path).map_err(|error| error.to_string()), done)
    }

    /// Runs a save on a thread of its own.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn run(
        &mut self,
        save: impl FnOnce() -> Saved + Send + 'static,
        done: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<()> {
        let finished = self.finished.0.clone();
        let write = move || {
            // The window may be gone.
            let _ = finished.send(save());
            done();
        };
        self.threads.push(std::thread::Builder::new().name("saving".to_owned()).spawn(write)?);
        Ok(())
    }

    /// Results of pictures that were written since the last call.
    pub fn written(&mut self) -> Vec<Saved> {
        self.threads.retain(|thread| !thread.is_finished());
        self.finished.1.try_iter().collect()
    }

    /// Waits for all that is being written.
    pub fn join(&mut self) {
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }

    /// A name in a folder that is not taken, of a file or, without an ending, of a folder.
    ///
    /// # Errors
    /// The folder cannot be made or is full.
    pub fn free_path(&mut self, folder: &Path, stem: &str, ending: &str) -> Result<PathBuf, String> {
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("cannot make the folder: {error}: {}", folder.display()))?;
        let path = |number: usize| folder.join(format!("{stem}_{number:03}")).with_extension(ending);
        let free = (0..1000)
            .map(path)
            .find(|path| !path.exists() && !self.taken.contains(path))
            .ok_or_else(|| format!("a thousand of them lie there already: {}", folder.display()))?;
        // It may be written only later.
        self.taken.insert(free.clone());
        Ok(free)
    }
}
