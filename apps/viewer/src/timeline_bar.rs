//! The timeline under the picture: frames that are kept, stale ones, the playhead, and the part that is played.

use eframe::egui::{self, Color32, DragValue, Rect, Sense, Stroke, Ui, WidgetInfo, accesskit::Role};
use strandline::live::{Command, Pace, TimelineShown};

use crate::{
    App,
    controls::button,
    keys,
    playback::{Playback, frame_at, place},
};

/// Height of the bar \[point\].
const HEIGHT: f32 = 18.0;
/// Colours of frames that are kept, of stale ones, of the part that is played, and of the playhead.
const KEPT: Color32 = Color32::from_rgb(70, 120, 170);
const STALE: Color32 = Color32::from_rgb(95, 80, 60);
const PLAYED: Color32 = Color32::from_gray(58);
const HEAD: Color32 = Color32::from_rgb(255, 190, 70);

impl App {
    /// The timeline as it was last seen.
    pub fn timeline(&self) -> TimelineShown {
        self.shown.as_ref().map_or_else(TimelineShown::default, |shown| shown.timeline)
    }

    /// The frame that is shown, or that was asked for since.
    pub fn playhead(&self) -> u32 {
        let drawn = self.shown.as_ref().map_or(0, |shown| shown.drawn_after_command);
        let sought = self.playback.sought.filter(|(number, _)| *number > drawn);
        sought.map_or(self.timeline().playhead, |(_, frame)| frame)
    }

    /// Stands still and shows the kept frame nearest to this one.
    pub fn seek(&mut self, frame: u32) {
        let timeline = self.timeline();
        let frame = frame.clamp(timeline.first, timeline.last.max(timeline.first));
        if self.playing {
            self.play(false);
        }
        self.playback.sought = Some((self.live.send(Command::Seek(frame)), frame));
    }

    /// Moves by so many frames; the one after the last is simulated.
    pub(crate) fn move_by(&mut self, frames: i64) {
        let (playhead, last) = (self.playhead(), self.timeline().last);
        if frames == 1 && playhead >= last {
            self.play(false);
            self.live.send(Command::Step);
            return;
        }
        self.seek(u32::try_from(i64::from(playhead) + frames).unwrap_or(0));
    }

    /// Sets the first (0) or the last (1) frame of the played range to the playhead; clears it where it is there already.
    pub(crate) fn mark(&mut self, end: usize) {
        let playhead = self.playhead();
        let mark = &mut self.playback.marks[end];
        *mark = if *mark == Some(playhead) { None } else { Some(playhead) };
        self.send_playback();
    }

    pub(crate) fn send_playback(&self) {
        let Playback { marks, loops, every_frame, .. } = self.playback;
        self.live.send(Command::Range(marks, loops));
        self.live.send(Command::Pace(if every_frame { Pace::EveryFrame } else { Pace::OwnSpeed }));
    }
}

/// Draws the bar with its buttons.
pub fn show(app: &mut App, ui: &mut Ui) {
    let timeline = app.timeline();
    ui.horizontal(|ui| {
        if button(ui, "|<", "the first frame that is kept: Home") {
            app.seek(0);
        }
        if button(ui, "<", "a frame back: arrow left") {
            app.move_by(-1);
        }
        if button(ui, ">", "a frame on, simulated if it is not kept: arrow right") {
            app.move_by(1);
        }
        if button(ui, ">|", "the last frame that is kept: End") {
            app.seek(u32::MAX);
        }
        for (end, name, tip) in [(0, "in", "begins"), (1, "out", "ends")] {
            let tip =
                format!("the part that is played {tip} here; again takes the mark away: {}", ["I", "O"][end]);
            let has = app.playback.marks[end].is_some();
            if ui.selectable_label(has, name).on_hover_text(tip).clicked() {
                app.mark(end);
            }
        }
        let Playback { loops, every_frame, .. } = &mut app.playback;
        let tip = "the first frame follows the last\ndefault off";
        let mut changed = ui.checkbox(loops, "loop").on_hover_text(tip).changed();
        let tip = "each frame as soon as it is drawn, in place of the hair's own speed\ndefault off";
        changed |= ui.checkbox(every_frame, "every frame").on_hover_text(tip).changed();
        if changed {
            app.send_playback();
        }
        words(app, &timeline, ui);
    });
    let end = timeline.film_end.max(timeline.last).max(1);
    bar(app, &timeline, end, ui);
    keys::strips(app, &timeline, end, ui);
}

/// Frame, time and room of the timeline.
fn words(app: &mut App, timeline: &TimelineShown, ui: &mut Ui) {
    let playhead = app.playhead();
    let seconds = f64::from(playhead) / timeline.rate.max(1.0);
    let mut frame = playhead;
    ui.label("frame");
    let tip = "the shown frame; type one to go there\nframe n is picture n - 1 of `render`, which begins a frame after rest\ndefault 0";
    let field = DragValue::new(&mut frame).range(timeline.first..=timeline.last.max(timeline.first));
    let response = ui.add(field).on_hover_text(tip);
    response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, "frame"));
    if response.changed() && frame != playhead {
        app.seek(frame);
    }
    ui.label(format!("{seconds:.2} s"));
    if timeline.good < timeline.last {
        ui.label(format!("stale after {}", timeline.good))
            .on_hover_text("something was changed there: play on from it");
    }
    let [memory, disk] = timeline.used.map(|bytes| bytes / 1_000_000);
    let [most, most_on_disk] = timeline.most.map(|bytes| bytes / 1_000_000);
    let on_disk = if disk > 0 { format!(", {disk} MB on disk") } else { String::new() };
    ui.label(format!("{memory} MB{on_disk}")).on_hover_text(format!(
        "frames {} to {} are kept, in at most {most} MB of memory and {most_on_disk} MB on the disk: [timeline] of a scene",
        timeline.first, timeline.last,
    ));
}

fn bar(app: &mut App, timeline: &TimelineShown, end: u32, ui: &mut Ui) {
    let width = ui.available_width().max(1.0);
    let (rect, response) = ui.allocate_exact_size(egui::vec2(width, HEIGHT), Sense::click_and_drag());
    let playhead = app.playhead();
    response.widget_info(|| WidgetInfo::slider(true, f64::from(playhead), "timeline"));
    if let Some(pointer) =
        response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked())
    {
        let frame = frame_at(pointer.x, rect, end);
        if frame.clamp(timeline.first, timeline.last.max(timeline.first)) != playhead || app.playing {
            app.seek(frame);
        }
    }
    let painter = ui.painter();
    let span = |from: u32, to: u32, inset: f32, colour: Color32| {
        let [left, right] = [from, to].map(|frame| place(f64::from(frame), rect, end));
        let part = Rect::from_min_max(
            egui::pos2(left, rect.top() + inset),
            egui::pos2(right, rect.bottom() - inset),
        );
        painter.rect_filled(part, 2.0, colour);
    };
    painter.rect_filled(rect, 2.0, Color32::from_gray(38));
    let [first, last] = app.playback.marks;
    span(first.unwrap_or(0), last.unwrap_or(timeline.film_end).min(end), 0.0, PLAYED);
    span(timeline.good.max(timeline.first), timeline.last, 5.0, STALE);
    span(timeline.first, timeline.good, 5.0, KEPT);
    let x = place(f64::from(playhead), rect, end);
    painter.line_segment([egui::pos2(x, rect.top()), egui::pos2(x, rect.bottom())], Stroke::new(2.0, HEAD));
    response.on_hover_text("drag: shows a frame that is kept\nblue: kept; brown: stale, simulated again when it plays\ndefault 0");
}
