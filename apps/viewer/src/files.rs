//! The system's own dialogs for files. Each waits on a thread of its own, so that the window stays awake.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use eframe::egui;
use strandline::format::FORMATS;

/// Purpose of a file dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// To be loaded.
    Open,
    /// To save the picture to.
    Picture,
    /// To save the scene to.
    Scene,
    /// To write moving hair to.
    Moving,
    /// The folder of a project to be loaded, and to save one to.
    OpenProject,
    /// See [`Wanted::OpenProject`].
    Project,
    /// A look to be loaded, and to save one to.
    OpenLook,
    /// See [`Wanted::OpenLook`].
    SaveLook,
}

/// A dialog that is open.
pub struct Dialog {
    wanted: Wanted,
    answer: Receiver<Option<PathBuf>>,
    since: Instant,
}

/// A user cannot close a dialog as fast as this: there was none.
const AT_ONCE: Duration = Duration::from_millis(300);

/// Answer of a dialog.
pub struct Answer {
    /// Purpose of the dialog.
    pub wanted: Wanted,
    /// The file, if one was chosen.
    pub file: Option<PathBuf>,
    /// True if it came sooner than a person can answer.
    pub at_once: bool,
}

impl Dialog {
    /// Opens a dialog.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn open(wanted: Wanted, context: &egui::Context) -> std::io::Result<Self> {
        let (answer_to, answer) = channel();
        let (question, context) = (question(wanted), context.clone());
        let wait = move || {
            let file = pollster::block_on(question).map(|file| file.path().to_owned());
            // The window may be gone.
            let _ = answer_to.send(file);
            context.request_repaint();
        };
        std::thread::Builder::new().name("dialog".to_owned()).spawn(wait)?;
        Ok(Self { wanted, answer, since: Instant::now() })
    }

    /// The answer, once there is one.
    pub fn answer(&self) -> Option<Answer> {
        let file = match self.answer.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => None,
            Ok(file) => file,
        };
        Some(Answer { wanted: self.wanted, file, at_once: self.since.elapsed() < AT_ONCE })
    }
}

type Question = std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

fn question(wanted: Wanted) -> Question {
    let dialog = rfd::AsyncFileDialog::new();
    match wanted {
        Wanted::Open => Box::pin(
            dialog
                .set_title("Open a scene, groom or body")
                .add_filter(
                    "scenes, grooms, bodies",
                    &["toml", "hair", "tfx", "obj", "gltf", "glb", "vrm", "ply", "stl"],
                )
                .pick_file(),
        ),
        Wanted::OpenProject => Box::pin(dialog.set_title("Open a project").pick_folder()),
        Wanted::Project => Box::pin(dialog.set_title("Save the project in a folder").pick_folder()),
        Wanted::Picture => {
            let dialog = dialog.set_title("Save the picture").add_filter("PNG", &["png"]);
            Box::pin(dialog.set_file_name("view.png").save_file())
        }
        Wanted::OpenLook => {
            Box::pin(dialog.set_title("Load a look").add_filter("look", &["toml"]).pick_file())
        }
        Wanted::SaveLook => {
            let dialog = dialog.set_title("Save the look").add_filter("look", &["toml"]);
            Box::pin(dialog.set_file_name("look.toml").save_file())
        }
        Wanted::Scene => {
            let dialog = dialog.set_title("Save the scene").add_filter("scene", &["toml"]);
            Box::pin(dialog.set_file_name("view.toml").save_file())
        }
        Wanted::Moving => {
            let dialog = dialog.set_title("Write moving hair").add_filter("moving hair", &["npz", "usda"]);
            let grooms: Vec<&str> = FORMATS.iter().map(|format| format.ending).collect();
            let dialog = dialog.add_filter("a groom file a frame", &grooms);
            Box::pin(dialog.set_file_name("hair.npz").save_file())
        }
    }
}
