//! Another scene, or other frames of this one, beside the shown one: at the same time, with the same camera.

use eframe::egui::{self, Color32, DragValue, Rect, Slider, Stroke, Ui, pos2};
use strandline::{Live, Scene, live::Command};

use crate::{
    App,
    compared::{Compare, Split},
    controls::button,
};

impl App {
    /// Keeps the scene as it is, to compare the shown one with; or ends that.
    pub fn compare(&mut self) {
        if self.compare.take().is_some() {
            return;
        }
        let mut scene = Scene { folder: self.scene.folder.clone(), ..self.seen() };
        scene.begin_at_rest();
        let context = self.context.clone();
        let wake = move || context.get().into_iter().for_each(egui::Context::request_repaint);
        match Live::new(scene, wake) {
            Ok(live) => {
                live.send(Command::Play(false));
                live.send(Command::Adapt(self.adapts));
                self.compare = Some(Compare::new(live));
            }
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// The scene that the shown one is compared with.
    pub fn compared(&self) -> Option<&Compare> {
        self.compare.as_ref()
    }

    pub(crate) fn follow_compared(&mut self, context: &egui::Context) {
        let (playhead, camera, picture) = (self.timeline().playhead, self.camera, self.scene.picture);
        if let Some(compare) = &mut self.compare {
            compare.take(context);
            compare.follow(playhead, camera, picture);
        }
    }
}

/// The controls.
pub fn controls(app: &mut App, ui: &mut Ui) {
    let name = if app.compare.is_some() { "End comparison" } else { "Compare" };
    if button(ui, name, "keeps the scene as it is now, to see it beside what is changed from now on") {
        app.compare();
    }
    let Some(compare) = &mut app.compare else { return };
    ui.horizontal(|ui| {
        ui.radio_value(&mut compare.split, Split::Wipe, "wipe");
        ui.radio_value(&mut compare.split, Split::Beside, "side by side");
    });
    if compare.split == Split::Wipe {
        ui.add(Slider::new(&mut compare.at, 0.0..=1.0).text("wipe at"))
            .on_hover_text("left of it the kept scene\ndefault 0.5");
    }
    ui.horizontal(|ui| {
        ui.label("frames later");
        ui.add(DragValue::new(&mut compare.later).range(-100_000..=100_000).speed(0.1))
            .on_hover_text("the kept scene shows a frame so many later: two parts of one film\ndefault 0");
    });
}

/// Draws the kept scene over the picture, left of a line or in the left half.
pub fn show(app: &App, ui: &Ui, room: Rect, own: egui::TextureId) {
    let Some(compare) = &app.compare else { return };
    let Some(texture) = &compare.texture else { return };
    let at = if compare.split == Split::Wipe { compare.at } else { 0.5 };
    let x = room.left() + at * room.width();
    let painter = ui.painter();
    let part = |from: f32, to: f32| Rect::from_min_max(pos2(from, room.top()), pos2(to, room.bottom()));
    let share = |from: f32, to: f32| Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
    let left = part(room.left(), x);
    match compare.split {
        Split::Wipe => {
            painter.image(texture.id(), left, share(0.0, at), Color32::WHITE);
        }
        Split::Beside => {
            painter.image(texture.id(), left, share(0.25, 0.75), Color32::WHITE);
            painter.image(own, part(x, room.right()), share(0.25, 0.75), Color32::WHITE);
        }
    }
    let line = [pos2(x, room.top()), pos2(x, room.bottom())];
    painter.line_segment(line, Stroke::new(1.5, Color32::from_white_alpha(180)));
}
