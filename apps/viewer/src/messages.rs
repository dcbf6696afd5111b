//! Messages for the user, over the foot of the picture: the layout does not change for them.

use std::time::{Duration, Instant};

use eframe::egui::{self, Align2, Color32, Rect};

/// Time for which a note is shown.
const READING: Duration = Duration::from_secs(8);
/// Notes that are shown at once.
const MOST: usize = 5;

/// Something to read, and since when.
struct Note {
    text: String,
    since: Instant,
}

/// The notes that are shown, oldest first.
#[derive(Default)]
pub struct Notes(Vec<Note>);

impl Notes {
    /// Shows a line for a while.
    pub fn add(&mut self, text: String) {
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(Note { text, since: Instant::now() });
    }

    /// Puts all of them away.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// Shows the notes for a while, and the last error until it is put away.
pub fn show(notes: &mut Notes, last_error: &mut Option<String>, ui: &egui::Ui, room: Rect) {
    notes.0.retain(|note| note.since.elapsed() < READING);
    if notes.0.is_empty() && last_error.is_none() {
        return;
    }
    ui.ctx().request_repaint_after(READING);
    let corner = room.left_bottom() + egui::vec2(10.0, -10.0);
    let width = (room.width() - 150.0).max(200.0);
    let area = egui::Area::new(ui.scope_id().with("messages")).fixed_pos(corner).pivot(Align2::LEFT_BOTTOM);
    area.show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(width);
            for note in &notes.0 {
                ui.label(&note.text);
            }
            let Some(error) = last_error.clone() else { return };
            ui.horizontal_wrapped(|ui| {
                ui.colored_label(Color32::LIGHT_RED, error);
                if ui.small_button("x").on_hover_text("puts the message away").clicked() {
                    *last_error = None;
                }
            });
        });
    });
}
