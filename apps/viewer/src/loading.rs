//! A scene that is on its way: its stage, and its hair before there is a picture.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, Align2, Color32, FontId, Rect, Ui, vec2};
use strandline::{
    Camera,
    live::{LoadStage, Overlaid},
};

use crate::{
    App, overlays,
    stages::{Loading, share, words},
};

/// Interval at which the seconds of a load are shown.
const TICK: Duration = Duration::from_millis(500);

impl App {
    /// Takes the stage of a load.
    pub(crate) fn take_stage(
        &mut self,
        number: u64,
        stage: LoadStage,
        hair: Option<(Arc<Overlaid>, Camera)>,
    ) {
        let before = self.loading.take().filter(|loading| loading.number == number);
        let since = before.as_ref().map_or_else(Instant::now, |before| before.since);
        let hair = hair.or(before.and_then(|before| before.hair));
        self.loading = Some(Loading { number, stage, since, hair });
    }

    /// The stage of the scene that is on its way, and true where its hair is seen already.
    pub fn load_stage(&self) -> Option<(LoadStage, bool)> {
        let loading = self.loading.as_ref().filter(|_| self.is_loading())?;
        Some((loading.stage, loading.hair.is_some()))
    }
}

/// The progress of a load that is under way, in a line.
pub fn progress(app: &App, ui: &mut Ui) {
    if !app.is_loading() {
        return;
    }
    ui.ctx().request_repaint_after(TICK);
    let loading = app.loading.as_ref();
    ui.add(egui::ProgressBar::new(share(loading)).desired_width(70.0).desired_height(8.0));
    ui.label(words(loading)).on_hover_text("the scene that is shown plays on meanwhile");
}

/// Shows the progress of loading in place of the picture, over the guides that are loaded by then.
pub fn show(app: &App, ui: &mut Ui, room: Rect) {
    if !app.is_loading() && app.error.is_some() {
        ui.centered_and_justified(|ui| ui.label("nothing to show: the scene was not loaded; open another"));
        return;
    }
    ui.ctx().request_repaint_after(TICK);
    let loading = app.loading.as_ref();
    let painter = ui.painter().with_clip_rect(room);
    if let Some((hair, camera)) = loading.and_then(|loading| loading.hair.as_ref()) {
        painter.rect_filled(room, 0.0, Color32::from_gray(45));
        overlays::lines(hair, camera, &painter, room);
    }
    let middle = room.center_bottom() - vec2(0.0, 60.0);
    let place = Rect::from_center_size(middle, vec2(260.0, 44.0));
    painter.rect_filled(place.expand(6.0), 4.0, ui.visuals().window_fill());
    let mut row = ui.new_child(egui::UiBuilder::new().max_rect(place));
    row.vertical_centered(|ui| {
        // The picture is drawn after the last stage.
        let text = if app.is_loading() { words(loading) } else { "drawing the first picture ...".to_owned() };
        ui.label(text);
        let done = if app.is_loading() { share(loading) } else { 1.0 };
        ui.add(egui::ProgressBar::new(done).desired_width(220.0).desired_height(8.0));
    });
    painter.text(
        room.left_top() + vec2(10.0, 10.0),
        Align2::LEFT_TOP,
        "guides of the hair at rest",
        FontId::proportional(11.5),
        if loading.is_some_and(|loading| loading.hair.is_some()) {
            Color32::LIGHT_GRAY
        } else {
            Color32::TRANSPARENT
        },
    );
}
