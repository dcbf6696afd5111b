//! Brushes over hair at rest: each stroke is a step that can be undone, kept in the scene.

use std::path::Path;

use eframe::egui::{self, PointerButton, Ui};
use strandline::settings::{Group, Stroke, Tool as Brush};
use strandline::{Prepared, Touched, live::Command};

use crate::{
    App, Tool,
    controls::{button, slide, tick},
    sight::{points_of, ray},
};

impl App {
    /// Brushes at a place of the skin, as the answer to [`Command::Touch`] has it.
    pub(crate) fn brush(&mut self, touched: Option<Touched>) {
        let Some(Touched { position, motion }) = touched else {
            return self.note("the brush meets no skin: begin the stroke over the head".to_owned());
        };
        let mut scene = match &self.pending {
            Some((_, scene)) => (**scene).clone(),
            None => self.own_scene(),
        };
        scene.strokes.push(Stroke { position, motion: motion.clamp_length_max(1.0), ..self.stroke });
        scene.begin_at_rest();
        self.remember_now();
        self.history.record(&scene);
        self.restoring = true;
        self.keeps_view = true;
        self.load(scene);
    }

    /// Writes the hair at rest, after its strokes, as a groom file; into a free file of the folder when no path is given.
    pub fn save_groom(&mut self, path: Option<&Path>) {
        let Some(path) = self.path_or_free(path, "hair", "npz") else { return };
        let (scene, context) = (self.own_scene(), self.context.clone());
        let save = move || {
            let groom = Prepared::groom(&scene).map_err(|error| error.to_string())?;
            groom.save(&path).map_err(|error| error.to_string())?;
            Ok(path)
        };
        let wake = move || context.get().into_iter().for_each(egui::Context::request_repaint);
        if let Err(error) = self.saves.run(save, wake) {
            self.error = Some(format!("cannot save the groom: {error}"));
        }
    }
}

/// Name of a brush's button.
fn label(brush: Brush) -> &'static str {
    match brush {
        Brush::Comb => "Comb",
        Brush::Cut => "Cut",
        Brush::Lengthen => "Lengthen",
        Brush::Clump => "Clump",
        Brush::Curl => "Curl",
    }
}

fn tip(brush: Brush) -> &'static str {
    match brush {
        Brush::Comb => "drag over the head: hair whose roots lie under the brush is drawn that way",
        Brush::Cut => "click on the head: hair under the brush is cut to the length beside",
        Brush::Lengthen => "click on the head: hair under the brush grows by the length beside",
        Brush::Clump => "click on the head: hair under the brush leans together",
        Brush::Curl => "click on the head: hair under the brush winds about itself",
    }
}

/// The brushes, and the settings of the one in hand.
pub fn panel(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for brush in Brush::ALL {
            let is_held = app.tool == Tool::Brush && app.stroke.tool == brush;
            if ui.selectable_label(is_held, label(brush)).on_hover_text(tip(brush)).clicked() {
                app.tool = if is_held { Tool::Orbit } else { Tool::Brush };
                app.stroke.tool = brush;
            }
        }
    });
    let (rows, base) = (Stroke::ROWS, Stroke::default());
    let stroke = &mut app.stroke;
    slide(ui, (&mut stroke.radius, base.radius), &rows.radius, "brush");
    slide(ui, (&mut stroke.strength, base.strength), &rows.strength, "strength");
    match stroke.tool {
        Brush::Comb | Brush::Clump => {}
        Brush::Cut | Brush::Lengthen => {
            slide(ui, (&mut stroke.length, base.length), &rows.length, "to or by");
        }
        Brush::Curl => {
            slide(ui, (&mut stroke.curl, base.curl), &rows.curl, "curl");
            slide(ui, (&mut stroke.pitch, base.pitch), &rows.pitch, "turn of");
        }
    }
    tick(ui, (&mut stroke.symmetric, base.symmetric), &rows.symmetric, "both sides");
    ui.horizontal(|ui| {
        if button(ui, "Save groom", "the hair at rest with its strokes, as .npz into out/") {
            app.save_groom(None);
        }
        let strokes = app.scene.strokes.len();
        if strokes > 0
            && button(ui, "Clear strokes", "takes all strokes off the hair; ctrl Z brings them back")
        {
            let mut scene = app.own_scene();
            scene.strokes.clear();
            app.keeps_view = true;
            app.load(scene);
        }
        if strokes > 0 {
            ui.label(strandline::file::counted(strokes, "stroke", "strokes"));
        }
    });
}

/// Draws the brush's circle about the mouse, and brushes when the mouse lets go.
pub fn mouse(app: &mut App, ui: &Ui, response: &egui::Response) {
    if response.drag_started_by(PointerButton::Primary) {
        app.brushed_from = ui.input(|input| input.pointer.press_origin());
    }
    let pointer = response.interact_pointer_pos().or_else(|| response.hover_pos());
    if let Some(pointer) = pointer {
        let radius = points_of(app, response.rect, app.stroke.radius);
        let line = egui::Stroke::new(1.5, egui::Color32::WHITE);
        let painter = ui.painter();
        painter.circle_stroke(app.brushed_from.unwrap_or(pointer), radius, line);
        if let Some(from) = app.brushed_from.filter(|_| app.stroke.tool == Brush::Comb) {
            painter.line_segment([from, pointer], line);
        }
    }
    if response.drag_stopped_by(PointerButton::Primary)
        && let Some(from) = app.brushed_from.take()
    {
        let to = pointer.unwrap_or(from);
        let rays = [from, to].map(|place| ray(app, response.rect, place));
        app.live.send(Command::Touch(rays));
    }
}
