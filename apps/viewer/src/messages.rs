//! Messages for the user, over the foot of the picture: the layout does not change for them.

use std::time::{Duration, Instant};

use eframe::egui::{self, Align2, Rect, Ui};
use strandline::{
    Scene,
    edit::{Mend, changes, mends},
};

use crate::{App, controls::button};

/// Time for which a note is shown.
const READING: Duration = Duration::from_secs(8);
/// Notes that are shown at once.
const MOST: usize = 5;

/// Time for which a note with a mend is shown.
const MENDING: Duration = Duration::from_secs(40);

/// Something to read, since when, and the mends that it names.
struct Note {
    text: String,
    since: Instant,
    mends: Vec<Mend>,
}

impl Note {
    fn is_read(&self) -> bool {
        self.since.elapsed() >= if self.mends.is_empty() { READING } else { MENDING }
    }
}

/// The notes that are shown, oldest first.
#[derive(Default)]
pub struct Notes(Vec<Note>);

impl Notes {
    /// Shows a line for a while, with the mends that it names.
    pub fn add(&mut self, text: String, mends: Vec<Mend>) {
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(Note { text, since: Instant::now(), mends });
    }

    /// Puts all of them away.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// The mends that the last error names, and its text.
#[derive(Default)]
pub struct Mended {
    text: String,
    mends: Vec<Mend>,
}

impl App {
    /// The scene that the last error is about: the one that was not loaded, or the shown one.
    fn faulty(&self) -> Scene {
        self.failed.as_ref().map_or_else(|| self.own_scene(), |failed| (**failed).clone())
    }

    /// Mends the scene as a message says: it is a step, as any change.
    pub(crate) fn mend(&mut self, mend: &Mend, is_error: bool) {
        let scene = if is_error { self.faulty() } else { self.own_scene() };
        match mend.apply(&scene) {
            Ok(mended) => {
                self.notes.clear();
                let failed = self.failed.take().filter(|_| is_error);
                self.error = None;
                self.keeps_view = failed.is_none();
                match changes(&self.scene, &mended).filter(|_| failed.is_none()) {
                    Some(_) => self.restore(mended),
                    None => self.load(mended),
                }
            }
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Finds the mends of the last error, once for each.
    fn find_mends(&mut self) {
        let text = self.error.clone().unwrap_or_default();
        if text != self.mended.text {
            let mends = if text.is_empty() { Vec::new() } else { mends(&text, &self.faulty()) };
            self.mended = Mended { text, mends };
        }
    }
}

/// Shows the notes for a while, and the last error until it is put away, with their mends as buttons.
pub fn show(app: &mut App, ui: &egui::Ui, room: Rect) {
    app.find_mends();
    app.notes.0.retain(|note| !note.is_read());
    if app.notes.0.is_empty() && app.error.is_none() {
        return;
    }
    ui.ctx().request_repaint_after(READING);
    let corner = room.left_bottom() + egui::vec2(10.0, -10.0);
    let width = (room.width() - 150.0).max(200.0);
    let area = egui::Area::new(ui.scope_id().with("messages")).fixed_pos(corner).pivot(Align2::LEFT_BOTTOM);
    let (mut wanted, mut is_put_away) = (None, false);
    area.show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(width);
            for note in &app.notes.0 {
                ui.label(&note.text);
                wanted = buttons(ui, &note.mends).map(|mend| (mend, false)).or(wanted.take());
            }
            let Some(error) = app.error.clone() else { return };
            ui.horizontal_wrapped(|ui| {
                ui.colored_label(ui.visuals().error_fg_color, error);
                is_put_away = ui.small_button("x").on_hover_text("puts the message away").clicked();
            });
            wanted = buttons(ui, &app.mended.mends).map(|mend| (mend, true)).or(wanted.take());
        });
    });
    if is_put_away {
        (app.error, app.failed) = (None, None);
    }
    if let Some((mend, is_error)) = wanted {
        app.mend(&mend, is_error);
    }
}

/// A button for each mend; the one that was pressed.
fn buttons(ui: &mut Ui, mends: &[Mend]) -> Option<Mend> {
    let mut pressed = None;
    ui.horizontal_wrapped(|ui| {
        for mend in mends {
            if button(ui, &mend.name, "sets this and loads what it concerns; ctrl Z takes it back") {
                pressed = Some(mend.clone());
            }
        }
    });
    pressed
}
