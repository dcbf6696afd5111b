//! Moving hair as a file: a range of the film, simulated again from its beginning on a thread of its own.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;

use eframe::egui;
use strandline::{Error, OutSettings, Player, Scene, Target, What, Written, format::Format};

/// Request to write moving hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Time of the film at which it begins and ends \[s\].
    pub from: f32,
    pub to: f32,
    /// Every n-th frame of these.
    pub every: u32,
    pub what: What,
    pub target: Target,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { from: 0.0, to: 4.0, every: 1, what: What::default(), target: Target::default() }
    }
}

impl Wanted {
    /// Settings of a file.
    pub fn out(&self, path: &Path) -> OutSettings {
        let Self { every, what, target, .. } = *self;
        OutSettings { every, what, target, ..OutSettings::new(path) }
    }

    /// The first frame and the number of frames up to the last one.
    fn frames(&self, frames_per_second: f32) -> [u32; 2] {
        let frame = |seconds: f32| (seconds.max(0.0) * frames_per_second).round() as u32;
        let first = frame(self.from);
        [first, frame(self.to).max(first) + 1]
    }
}

/// A file under way.
pub struct Export {
    path: PathBuf,
    stop: Arc<AtomicBool>,
    /// Frames that are done, of how many.
    done: Arc<AtomicU32>,
    frames: u32,
    result: Receiver<Result<Option<Written>, String>>,
    thread: Option<JoinHandle<()>>,
}

impl Export {
    /// Begins to write.
    ///
    /// # Errors
    /// A setting outside its range; the system gives no thread.
    pub fn new(
        mut scene: Scene,
        wanted: &Wanted,
        path: &Path,
        context: Arc<OnceLock<egui::Context>>,
    ) -> Result<Self, Error> {
        let [first, frames] = wanted.frames(scene.film.frames_per_second);
        scene.film.frames = frames;
        let settings = OutSettings { first, ..wanted.out(path) };
        settings.check()?;
        let (stop, done) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU32::new(0)));
        let (tell, result) = channel();
        let (stopped, counted) = (stop.clone(), done.clone());
        let run = move || {
            let wake = || context.get().into_iter().for_each(egui::Context::request_repaint);
            let written = write(&scene, &settings, &stopped, &|frames| {
                counted.store(frames, Ordering::Relaxed);
                wake();
            });
            // The window may be gone.
            let _ = tell.send(written.map_err(|error| error.to_string()));
            wake();
        };
        let thread =
            std::thread::Builder::new().name("exporting".to_owned()).spawn(run).map_err(Error::Thread)?;
        Ok(Self { path: path.to_owned(), stop, done, frames, result, thread: Some(thread) })
    }

    /// Path of the export, and its result once it is finished.
    pub fn result(&self) -> Option<(&Path, Result<Option<Written>, String>)> {
        Some((&self.path, self.result.try_recv().ok()?))
    }

    /// Share of the frames that is done.
    pub fn share(&self) -> f32 {
        self.done.load(Ordering::Relaxed) as f32 / self.frames as f32
    }
}

impl Drop for Export {
    /// A window that is closed leaves the frames that are done.
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

fn write(
    scene: &Scene,
    settings: &OutSettings,
    stop: &AtomicBool,
    count: &dyn Fn(u32),
) -> Result<Option<Written>, Error> {
    let mut player = Player::new(scene, scene.devices, false)?;
    player.set_out(settings)?;
    let mut failed = None;
    while !stop.load(Ordering::Relaxed)
        && let Some(event) = player.next()
    {
        match event {
            Ok(_) => count(player.frames_done()),
            Err(error) => failed = Some(error),
        }
    }
    // Written frames stay.
    let written = player.close_out()?;
    failed.map_or(Ok(written), Err)
}

/// The name of a file a frame, where a path is that of a groom other than a cache.
pub fn numbered(path: &Path) -> Option<PathBuf> {
    // A .usda holds all frames; as a groom it is read alone.
    let ending = &Format::of(path).ok().filter(|format| format.write.is_some())?.ending;
    let stem = path.file_stem()?.to_string_lossy();
    let name = if stem.contains('%') { format!("{stem}.{ending}") } else { format!("{stem}.%04d.{ending}") };
    (*ending != "npz").then(|| path.with_file_name(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_one_of_frames_and_a_groom_a_file_for_each() {
        let wanted = |from, to| Wanted { from, to, ..Wanted::default() }.frames(30.0);
        assert_eq!(wanted(0.0, 4.0), [0, 121]);
        assert_eq!(wanted(1.0, 2.0), [30, 61]);
        let named = |name: &str| numbered(Path::new(name)).map(|path| path.display().to_string());
        assert_eq!(named("out/a.hair").as_deref(), Some("out/a.%04d.hair"));
        assert_eq!(named("out/a_%03d.PLY").as_deref(), Some("out/a_%03d.ply"));
        assert_eq!([named("a.npz"), named("a.usda"), named("a")], [None, None, None]);
        // Never less than one frame.
        assert_eq!(wanted(2.0, 1.0), [60, 61]);
    }
}
