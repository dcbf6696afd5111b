//! Dialogs for files, and their results.

use eframe::egui;

use crate::App;
use crate::files::{Answer, Dialog, Wanted};

impl App {
    /// Opens a dialog, unless another is open.
    pub(crate) fn ask(&mut self, wanted: Wanted, context: &egui::Context) {
        if self.dialog.is_some() {
            return;
        }
        match Dialog::open(wanted, context) {
            Ok(dialog) => self.dialog = Some(dialog),
            Err(error) => self.error = Some(format!("cannot open a dialog: {error}")),
        }
    }

    /// Takes the answer of a dialog, if it is there.
    pub(crate) fn take_answer(&mut self) {
        let Some(Answer { wanted, file, at_once }) = self.dialog.as_ref().and_then(Dialog::answer) else {
            return;
        };
        self.dialog = None;
        match (file, wanted) {
            (Some(file), Wanted::Open | Wanted::OpenProject) => self.open_file(&file),
            (Some(file), Wanted::Picture) => self.save_picture(Some(file)),
            (Some(file), Wanted::Scene) => self.save_scene(Some(&file)),
            (Some(folder), Wanted::Project) => self.save_project(Some(&folder)),
            (Some(file), Wanted::Moving) => self.export(Some(&file)),
            (Some(file), Wanted::OpenLook) => self.load_look(&file),
            (Some(file), Wanted::SaveLook) => self.save_look(Some(&file)),
            (None, Wanted::Open | Wanted::OpenProject | Wanted::OpenLook) if at_once => {
                self.note(
                    "this system has no file dialog: type a path, or drop a file on the window".to_owned(),
                );
            }
            (None, _) if at_once => {
                self.note("this system has no file dialog: save into out/ instead".to_owned());
            }
            (None, _) => {}
        }
    }
}
