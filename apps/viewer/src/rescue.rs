//! Saves the scene to a file when the window stops with an internal error.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use strandline::Scene;

/// The scene as it was seen last.
#[derive(Clone, Default)]
pub struct Kept(Arc<Mutex<Option<Scene>>>);

impl Kept {
    /// Keeps the shown scene.
    pub fn keep(&self, scene: Scene) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(scene);
    }

    fn is_seen(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// Writes the scene into its own folder, or into that for temporary files if its own cannot be written.
    fn save(&self) -> Option<PathBuf> {
        let scene = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
        let text = scene.to_toml();
        [scene.folder, std::env::temp_dir()].into_iter().find_map(|folder| {
            (0..100).find_map(|number| {
                let path = folder.join(format!("strandline-rescued-{number}.toml"));
                let mut file = OpenOptions::new().write(true).create_new(true).open(&path).ok()?;
                file.write_all(text.as_bytes()).ok()?;
                Some(path)
            })
        })
    }
}

type Hook = Arc<dyn Fn(&PanicHookInfo) + Send + Sync>;

/// Runs a window. A panic before anything of the scene was seen is handed back as its words; one after that
/// saves the scene, says where, and continues as a panic.
pub fn run<T>(kept: &Kept, window: impl FnOnce() -> T) -> Result<T, String> {
    let former: Hook = panic::take_hook().into();
    // Message of a panic before the first picture.
    let early = Arc::new(Mutex::new(None));
    panic::set_hook(Box::new({
        let (own_thread, former) = (std::thread::current().id(), former.clone());
        let (kept, early) = (kept.clone(), early.clone());
        move |information: &PanicHookInfo| {
            let is_own = std::thread::current().id() == own_thread;
            if is_own && !kept.is_seen() {
                let words = information.payload_as_str().unwrap_or("an error of its own").to_owned();
                *early.lock().unwrap_or_else(PoisonError::into_inner) = Some(words);
                return;
            }
            former(information);
            if is_own {
                tell_where(kept.save());
            }
        }
    }));
    let outcome = panic::catch_unwind(AssertUnwindSafe(window));
    panic::set_hook(Box::new(move |information: &PanicHookInfo| former(information)));
    outcome.or_else(|payload| match early.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(words) => Err(words),
        None => panic::resume_unwind(payload),
    })
}

#[allow(clippy::print_stderr)] // the window is gone: nowhere else can it be read
fn tell_where(saved: Option<PathBuf>) {
    match saved {
        Some(path) => eprintln!(
            "strandline: the window stopped with an error of the program's own; the scene is saved, open it with \
             `strandline view {}`",
            path.display()
        ),
        None => eprintln!("strandline: the window stopped with an error of the program's own"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_reported_before_the_window_is_there_and_saves_the_scene_after_it() {
        let kept = Kept::default();
        assert_eq!(run(&kept, || 3), Ok(3));
        assert_eq!(run(&kept, || -> u8 { panic!("no {}", "library") }), Err("no library".to_owned()));
        let folder = tempfile::tempdir().unwrap();
        kept.keep(Scene { folder: folder.path().to_owned(), ..Scene::demo() });
        let stopped = panic::catch_unwind(AssertUnwindSafe(|| run(&kept, || -> u8 { panic!("late") })));
        assert!(stopped.is_err(), "it continues as a panic");
        let saved = folder.path().join("strandline-rescued-0.toml");
        assert_eq!(Scene::load(&saved).unwrap().style, Scene::demo().style);
    }
}
