//! The strip at the foot of the window: what runs where, how fast and how well.

use eframe::egui;

use crate::App;

pub fn show(app: &mut App, ui: &mut egui::Ui) {
    if let Some(error) = app.error.clone() {
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(egui::Color32::LIGHT_RED, error);
            if ui.small_button("x").on_hover_text("put the message away").clicked() {
                app.error = None;
            }
        });
    }
    ui.horizontal_wrapped(|ui| {
        if app.loading {
            ui.spinner();
            ui.label("loading");
        }
        let Some(shown) = &app.shown else { return };
        ui.label(format!("{:.1} pictures/s", app.rate)).on_hover_text("pictures a second, smoothed");
        let [simulated, drawn] = &shown.places;
        ui.label(format!("simulated on {simulated}, drawn on {drawn}"));
        if app.draft {
            ui.label("simpler while it moves").on_hover_text("see Detail; full when it stands still");
        }
        let drawing: f64 = shown.drawing.seconds.iter().map(|(_, seconds)| seconds).sum();
        ui.label(format!("{} segments in {:.1} ms", shown.drawing.segments, 1e3 * drawing))
            .on_hover_text(stages(&shown.drawing.seconds));
        if let Some(step) = &shown.step {
            let seconds: f64 = step.seconds.iter().map(|(_, seconds)| seconds).sum();
            ui.label(format!("step {:.2} ms", 1e3 * seconds)).on_hover_text(stages(&step.seconds));
            ui.label(format!("{} iterations", step.pressure.iterations))
                .on_hover_text("of the pressure solve");
            ui.label(format!("stretch {:.2} %", 100.0 * step.stretch_max))
                .on_hover_text("the largest, over rest");
            ui.label(format!("depth {:.1} mm", 1e3 * step.penetration_max))
                .on_hover_text("deepest point inside a solid");
        }
    });
    for note in &app.notes {
        ui.small(note);
    }
}

fn stages(seconds: &[(&'static str, f64)]) -> String {
    let line = |(name, seconds): &(&str, f64)| format!("{name}: {:.2} ms", 1e3 * seconds);
    seconds.iter().map(line).collect::<Vec<_>>().join("\n")
}
