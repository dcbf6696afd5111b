//! Messages for the user, over the foot of the picture: the layout does not change for them.

use eframe::egui::{self, Align2, Rect, Ui};
use strandline::{
    Scene,
    edit::{Mend, changes, mends},
};

use crate::{
    App,
    controls::button,
    notes::{Mended, READING},
};

impl App {
    /// The scene that the last error is about: the one that was not loaded, or the shown one.
    fn faulty(&self) -> Scene {
        self.mended.failed.as_ref().map_or_else(|| self.own_scene(), |failed| (**failed).clone())
    }

    /// Mends the scene as a message says: it is a step, as any change.
    pub(crate) fn mend(&mut self, mend: &Mend, is_error: bool) {
        let scene = if is_error { self.faulty() } else { self.own_scene() };
        match mend.apply(&scene) {
            Ok(mended) => {
                self.notes.clear();
                let failed = self.mended.failed.take().filter(|_| is_error);
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
            let failed = self.mended.failed.take();
            self.mended = Mended { text, mends, failed };
        }
    }
}

/// Shows the notes for a while, and the last error until it is put away, with their mends as buttons.
pub fn show(app: &mut App, ui: &egui::Ui, room: Rect) {
    app.find_mends();
    if app.notes.unread().is_empty() && app.error.is_none() {
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
            for note in app.notes.unread() {
                ui.label(&note.text);
                wanted = buttons(ui, &note.mends).map(|mend| (mend, false)).or(wanted.take());
            }
            let Some(error) = app.error.clone() else { return };
            ui.horizontal_wrapped(|ui| {
                let dark = ui.visuals().dark_mode;
                let color = if dark { egui::Color32::LIGHT_RED } else { ui.visuals().error_fg_color };
                ui.colored_label(color, error);
                is_put_away = ui.small_button("x").on_hover_text("puts the message away").clicked();
            });
            wanted = buttons(ui, &app.mended.mends).map(|mend| (mend, true)).or(wanted.take());
        });
    });
    if is_put_away {
        (app.error, app.mended.failed) = (None, None);
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
