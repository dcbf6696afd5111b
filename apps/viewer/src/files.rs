//! The system's own dialogs for files. Each waits on a thread of its own, so that the window goes on.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use eframe::egui;
use strandline::groom::format::FORMATS;

use crate::App;

/// What a file is asked for.
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
}

/// A dialog that is open.
pub struct Dialog {
    wanted: Wanted,
    answer: Receiver<Option<PathBuf>>,
    since: Instant,
}

/// No person puts a dialog away as fast as this: there was none.
const AT_ONCE: Duration = Duration::from_millis(300);

/// Opens a dialog, unless one is open.
pub fn ask(app: &mut App, wanted: Wanted, context: &egui::Context) {
    if app.dialog.is_some() {
        return;
    }
    let (answer_to, answer) = channel();
    let (question, context) = (question(wanted), context.clone());
    let wait = move || {
        let file = pollster::block_on(question).map(|file| file.path().to_owned());
        // The window may be gone.
        let _ = answer_to.send(file);
        context.request_repaint();
    };
    match std::thread::Builder::new().name("dialog".to_owned()).spawn(wait) {
        Ok(_) => app.dialog = Some(Dialog { wanted, answer, since: Instant::now() }),
        Err(error) => app.error = Some(format!("cannot open a dialog: {error}")),
    }
}

type Question = std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

fn question(wanted: Wanted) -> Question {
    let dialog = rfd::AsyncFileDialog::new();
    match wanted {
        Wanted::Open => Box::pin(
            dialog
                .set_title("Open a scene, groom or body")
                .add_filter("scenes, grooms, bodies", &["toml", "hair", "tfx", "obj", "gltf", "glb"])
                .pick_file(),
        ),
        Wanted::Picture => {
            let dialog = dialog.set_title("Save the picture").add_filter("PNG", &["png"]);
            Box::pin(dialog.set_file_name("view.png").save_file())
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

/// Takes the answer of a dialog, if it is there.
pub fn take_answer(app: &mut App) {
    let Some(dialog) = &app.dialog else { return };
    let (wanted, since) = (dialog.wanted, dialog.since);
    let answer = match dialog.answer.try_recv() {
        Err(TryRecvError::Empty) => return,
        Err(TryRecvError::Disconnected) => None,
        Ok(answer) => answer,
    };
    app.dialog = None;
    match (answer, wanted) {
        (Some(file), Wanted::Open) => app.open_file(&file),
        (Some(file), Wanted::Picture) => app.save_picture(Some(file)),
        (Some(file), Wanted::Scene) => app.save_scene(Some(&file)),
        (Some(file), Wanted::Moving) => app.export(Some(&file)),
        (None, Wanted::Open) if since.elapsed() < AT_ONCE => {
            app.note("this system has no file dialog: type a path, or drop a file on the window".to_owned());
        }
        (None, _) if since.elapsed() < AT_ONCE => {
            app.note("this system has no file dialog: save into out/ instead".to_owned());
        }
        (None, _) => {}
    }
}
